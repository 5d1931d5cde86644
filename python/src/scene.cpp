#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/scene_report.hpp"
#include "ehdjet/simulation/build.hpp"

#include <filesystem>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <string>
#include <vector>

#include "bindings.hpp"

namespace py = pybind11;

namespace ehdjet::python {
namespace {

// Finds errors that only appear when the objects are built.
void build(const Scene& scene) {
  if (scene.config.array)
    build_array_simulation(scene);
  else
    build_simulation(scene);
}

} // namespace

void bind_scene(py::module_& module) {
  using Unlocked = py::call_guard<py::gil_scoped_release>;
  py::class_<Scene>(module, "Scene")
      .def_property_readonly("given", [](const Scene& s) { return s.given; })
      .def_property_readonly("title", [](const Scene& s) { return s.config.title; })
      .def_property_readonly("end_time",
                             [](const Scene& s) { return s.config.run.end_time; })
      .def_property_readonly("has_array",
                             [](const Scene& s) { return s.config.array.has_value(); })
      .def_property_readonly("resolved",
                             [](const Scene& s) { return resolved_toml(s.config); })
      .def(
          "report",
          [](const Scene& s) {
            build(s);
            return scene_report(s);
          },
          Unlocked());
  using Assignments = std::vector<std::string>;
  module.def(
      "read_scene",
      [](const std::filesystem::path& file, const Assignments& overrides) {
        return read_scene(file, overrides);
      },
      py::arg("file"), py::arg("overrides"), Unlocked());
  module.def(
      "read_scene_text",
      [](const std::string& text, const std::string& name,
         const std::filesystem::path& folder, const Assignments& overrides) {
        return read_scene_text(text, name, folder, overrides);
      },
      py::arg("text"), py::arg("name"), py::arg("folder"), py::arg("overrides"),
      Unlocked());
  module.def("key_reference", &key_reference);
}

} // namespace ehdjet::python
