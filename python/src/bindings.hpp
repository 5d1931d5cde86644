#pragma once

#include <pybind11/pybind11.h>

/// Each function defines a part of ehdjet._core, the compiled half of the package. Its names are private: the other half,
/// in Python, has the interface and its documentation.
namespace ehdjet::python {

void bind_scene(pybind11::module_& module);
void bind_coulomb(pybind11::module_& module);
void bind_jet(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_run_file(pybind11::module_& module);

} // namespace ehdjet::python
