#include "ehdjet/run_files/run_reader.hpp"

#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>
#include <vector>

#include "bindings.hpp"

namespace py = pybind11;

namespace ehdjet::python {
namespace {

/// An array that takes over the values.
py::array owning(std::vector<double>&& values) {
  auto owner = std::make_unique<std::vector<double>>(std::move(values));
  const auto& v = *owner;
  const py::capsule base(owner.get(),
                         [](void* p) { delete static_cast<std::vector<double>*>(p); });
  owner.release(); // NOLINT(bugprone-unused-return-value): the capsule has it
  return py::array_t<double>(static_cast<py::ssize_t>(v.size()), v.data(), base);
}

/// name -> (values, unit)
py::dict to_dict(RunTable&& table) {
  py::dict columns;
  for (RunTable::Column& c : table.columns)
    columns[py::str(c.name)] = py::make_tuple(owning(std::move(c.values)), c.unit);
  return columns;
}

template <class Read>
auto unlocked(const Read& read) {
  const py::gil_scoped_release release;
  return read();
}

} // namespace

void bind_run_file(py::module_& module) {
  namespace fs = std::filesystem;
  using Unlocked = py::call_guard<py::gil_scoped_release>;
  py::class_<RunReader>(module, "RunReader")
      .def(py::init<const fs::path&>(), py::arg("path"), Unlocked())
      .def("attribute", &RunReader::attribute, py::arg("name"), Unlocked())
      .def("scene", &RunReader::scene, py::arg("form"), Unlocked())
      .def("has", &RunReader::has, py::arg("part"), Unlocked())
      .def(
          "table",
          [](const RunReader& run, const std::string& part) {
            return to_dict(unlocked([&] { return run.table(part); }));
          },
          py::arg("part"))
      .def("frame_times",
           [](const RunReader& run) {
             return owning(unlocked([&] { return run.frame_times(); }));
           })
      .def("nearest_frame", &RunReader::nearest_frame, py::arg("time"), Unlocked())
      .def(
          "frame",
          [](const RunReader& run, std::size_t index) {
            Frame frame = unlocked([&] { return run.frame(index); });
            return py::make_tuple(frame.time, to_dict(std::move(frame)));
          },
          py::arg("index"))
      .def("resolving_power", [](const RunReader& run) {
        ResolvingPowerTable t = unlocked([&] { return run.resolving_power(); });
        return py::make_tuple(owning(std::move(t.time)), owning(std::move(t.lambda)),
                              owning(std::move(t.r)));
      });
}

} // namespace ehdjet::python
