#include "ehdjet/core/error.hpp"
#include "ehdjet/runs/run_scene.hpp"

#include <exception>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "callables.hpp"

namespace py = pybind11;

namespace ehdjet::python {
namespace {

// The classes are in errors.py.
const char* class_of(const Error& error) {
  switch (error.exit_code()) {
  case 1:
    return "RunError";
  case 2:
    return "InputError";
  default:
    return "ContractViolation";
  }
}

void translate(std::exception_ptr thrown) {
  if (!thrown) return;
  try {
    std::rethrow_exception(thrown);
  } catch (const CallableFailed& e) {
    e.error().restore();
  } catch (const Error& e) {
    const py::object type = py::module_::import("ehdjet.errors").attr(class_of(e));
    PyErr_SetString(type.ptr(), e.what());
  }
}

} // namespace
} // namespace ehdjet::python

PYBIND11_MODULE(_core, module) {
  using namespace ehdjet::python;
  py::register_exception_translator(translate);
  bind_scene(module);
  bind_coulomb(module);
  bind_jet(module);
  bind_simulation(module);
  bind_run_file(module);
  module.def("build_environment", &ehdjet::build_environment);
}
