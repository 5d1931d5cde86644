#include "jet.hpp"

#include "ehdjet/jet/link_radii.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

#include "bindings.hpp"

namespace py = pybind11;

namespace ehdjet::python {
namespace {

std::shared_ptr<const BeadTable> unowned(const BeadTable& table) {
  return {std::shared_ptr<void>(), &table};
}

void make_read_only(py::array& array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
}

} // namespace

Jet::Jet(const JetState& jet, std::shared_ptr<const JetOwner> owner)
    : time_(jet.time)
    , state_(jet.columns())
    , table_(jet.table)
    , first_(jet.first())
    , landed_(jet.landed)
    , owner_(std::move(owner)) {
  for (std::size_t c = 0; c < table_->carried().size(); ++c)
    carried_.emplace_back(jet.carried(c));
}

Jet::Jet(const JetSnapshot& snapshot)
    : Jet(snapshot.jet, nullptr) {
  time_ = snapshot.time, state_ = snapshot.columns;
}

Jet::Jet(const Stage& stage, const BeadTable& table)
    : time_(stage.time)
    , state_(stage.columns)
    , table_(unowned(table))
    , first_(stage.first)
    , landed_(stage.landed)
    , acting_(true) {
  for (std::size_t c = 0; c < table_->carried().size(); ++c)
    carried_.push_back(stage.carried(c));
}

void Jet::check() const {
  if (over_)
    throw std::runtime_error(
        "this jet was there only during the call of a force or observer: "
        "keep its arrays, which are copies, and not the jet itself");
}

py::dict Jet::units() const {
  check();
  py::dict units;
  for (const auto columns : {table_->integrated(), table_->carried()})
    for (const BeadColumn& c : columns) units[py::str(c.name)] = c.unit;
  units["radius"] = "m", units["landed"] = "1", units["embryo"] = "1";
  return units;
}

py::array Jet::column(const std::string& name) const {
  check();
  if (const auto c = table_->find_integrated(name)) return values(state_.column(*c));
  if (const auto c = table_->find_carried(name)) return values(carried_[*c]);
  if (name == "radius") return radius();
  if (name == "landed") return landed();
  if (name == "embryo") return embryo();
  std::string known;
  for (const auto& [key, unit] : units())
    known += (known.empty() ? "" : ", ") + key.cast<std::string>();
  throw py::key_error(fmt::format("this jet has no column {}; it has {}", name, known));
}

py::array Jet::position() const {
  return vectors(0);
}

py::array Jet::velocity() const {
  return vectors(3);
}

py::array Jet::radius() const {
  check();
  std::vector<double> volume(carried_[0].begin(), carried_[0].end());
  if (const auto& drying = table_->drying(); drying && !acting_) {
    const auto lost = state_.column(drying->column);
    for (std::size_t k = 1; k < volume.size(); ++k) volume[k] *= 1 - lost[k];
  }
  py::array_t<double> radius(static_cast<py::ssize_t>(beads()));
  link_radii(state_.position(), first_, volume, {radius.mutable_data(), beads()});
  return radius;
}

py::array Jet::landed() const {
  check();
  py::array_t<bool> landed(static_cast<py::ssize_t>(beads()));
  const std::span all(landed.mutable_data(), beads());
  std::ranges::fill(all, false);
  for (const LandedBead& b : landed_) all[b.bead] = true;
  return landed;
}

py::array Jet::embryo() const {
  check();
  py::array_t<bool> embryo(static_cast<py::ssize_t>(beads()));
  const std::span all(embryo.mutable_data(), beads());
  std::ranges::fill(all, false);
  if (first_ == 2) all[1] = true;
  return embryo;
}

// x, y and z stand one after the other: an array (3, beads), of which Python sees the transpose.
py::array Jet::vectors(std::size_t first_column) const {
  check();
  const auto n = static_cast<py::ssize_t>(beads());
  return show(state_.column(first_column).data(), {n, 3});
}

py::array Jet::values(std::span<const double> column) const {
  return show(column.data(), {static_cast<py::ssize_t>(column.size())});
}

py::array Jet::show(const double* data, std::vector<py::ssize_t> shape) const {
  std::vector<py::ssize_t> strides{sizeof(double)};
  if (shape.size() == 2)
    strides.push_back(shape[0] * static_cast<py::ssize_t>(sizeof(double)));
  const auto type = py::dtype::of<double>();
  if (!owner_) return {type, std::move(shape), std::move(strides), data}; // a copy
  using Owner = std::shared_ptr<const JetOwner>;
  const py::capsule base(new Owner(owner_), [](void* p) { delete static_cast<Owner*>(p); });
  py::array view(type, std::move(shape), std::move(strides), data, base);
  make_read_only(view);
  return view;
}

void bind_jet(py::module_& module) {
  py::class_<Jet>(module, "Jet",
                  R"(A jet at one instant: a chain of beads, the nozzle first.

N = len(jet) counts the nozzle (row 0), which is no bead of the fluid: there are N - 1 links, and row k > 0
owns the link to row k - 1. SI units. ``jet["stress"]`` gives any column by its name, ``jet.units`` all names.

Arrays of ``Simulation.jet`` are read-only views of the simulation's own columns. They show the jet as it was
when it was asked for, and stay valid when the simulation goes on or is deleted. Arrays of a jet that is passed
to a force or an observer are copies. The jet itself ends with the call.)")
      .def("__len__", &Jet::beads)
      .def("__getitem__", &Jet::column, py::arg("name"),
           "A column (N,) by its name, in jet.units[name].\n\nKeyError: the jet has no "
           "such column")
      .def(
          "__contains__",
          [](const Jet& jet, const py::object& name) { return jet.units().contains(name); })
      .def("__repr__",
           [](const Jet& jet) {
             return fmt::format("<ehdjet.Jet: {} links at t = {:.9g} s>", jet.beads() - 1,
                                jet.time());
           })
      .def_property_readonly("time", &Jet::time, "Simulated time [s].")
      .def_property_readonly("units", &Jet::units, "The unit of each column, by name.")
      .def_property_readonly("position", &Jet::position,
                             "(N, 3) [m]; x points from the nozzle to the collector.")
      .def_property_readonly("velocity", &Jet::velocity, "(N, 3) [m/s].")
      .def_property_readonly(
          "mass", [](const Jet& jet) { return jet.column("mass"); },
          "(N,) of each link [kg]. With evaporation: as it left the nozzle; for a force: "
          "as it is.")
      .def_property_readonly(
          "charge", [](const Jet& jet) { return jet.column("charge"); },
          "(N,) of each link [C]. For a force: as it acts, in part for an embryo.")
      .def_property_readonly(
          "volume", [](const Jet& jet) { return jet.column("volume"); },
          "(N,) of each link [m^3]. With evaporation: as it left the nozzle; for a force: "
          "as it is.")
      .def_property_readonly(
          "radius", &Jet::radius,
          "(N,) of each link, sqrt(V/(pi l)); row 0 has that of the first link [m].")
      .def_property_readonly("landed", &Jet::landed, "(N,) bool: rests on the collector.")
      .def_property_readonly(
          "embryo", &Jet::embryo,
          "(N,) bool: is still forming at the nozzle; only row 1 can be one.");
}

} // namespace ehdjet::python
