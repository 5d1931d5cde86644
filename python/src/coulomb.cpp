#include "ehdjet/core/error.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/coulomb/error_estimate.hpp"
#include "ehdjet/coulomb/make_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"

namespace py = pybind11;

namespace ehdjet::python {
namespace {

// Vectors (n, 3) with x, y and z one after the other, as the solvers want them.
using Vectors = py::array_t<double, py::array::f_style | py::array::forcecast>;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Flags = py::array_t<bool, py::array::c_style | py::array::forcecast>;

std::string shape_of(const py::array& array) {
  std::string shape;
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    shape += fmt::format("{}{}", i > 0 ? ", " : "", array.shape(i));
  return '(' + shape + ')';
}

std::span<const double> all(const Numbers& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

ConstVec3View vectors(const Vectors& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InputError(
        fmt::format("{} has the shape {}; expected is (N, 3)", name, shape_of(array)));
  const auto n = static_cast<std::size_t>(array.shape(0));
  const std::span values(array.data(), 3 * n);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw InputError(
          fmt::format("{}[{}, {}] = {}: must be finite", name, i % n, i / n, values[i]));
  return {values.subspan(0, n), values.subspan(n, n), values.subspan(2 * n, n)};
}

/// Charges and what owns them.
struct Charges {
  Vectors x;
  Numbers q;
  std::vector<std::uint8_t> moves;

  [[nodiscard]] PointCharges points() const {
    const ConstVec3View r = vectors(x, "x");
    if (q.ndim() != 1 || static_cast<std::size_t>(q.shape(0)) != r.size())
      throw InputError(fmt::format("q has the shape {}; expected is ({},), one charge for "
                                   "each row of x",
                                   shape_of(q), r.size()));
    const auto charges = all(q);
    for (std::size_t i = 0; i < charges.size(); ++i)
      if (!std::isfinite(charges[i]))
        throw InputError(fmt::format("q[{}] = {}: must be finite", i, charges[i]));
    if (!moves.empty() && moves.size() != charges.size())
      throw InputError(fmt::format("moves has {} entries; expected are {}, one for each "
                                   "row of x",
                                   moves.size(), charges.size()));
    return {r, charges, moves};
  }
};

Charges charges(Vectors x, Numbers q, const std::optional<Flags>& moves) {
  Charges c{std::move(x), std::move(q), {}};
  if (moves) c.moves.assign(moves->data(), moves->data() + moves->size());
  return c;
}

ToleranceNorm norm_of(const std::string& name) {
  if (name == "moving") return ToleranceNorm::moving;
  if (name == "global") return ToleranceNorm::global;
  if (name == "per-bead") return ToleranceNorm::per_bead;
  throw InputError(
      fmt::format("norm = \"{}\": must be \"moving\", \"global\" or \"per-bead\"", name));
}

py::array forces(Vectors x, Numbers q, const std::string& solver, double tolerance,
                 const std::string& norm, const std::optional<Flags>& moves,
                 std::optional<std::size_t> threads) {
  const Charges given = charges(std::move(x), std::move(q), moves);
  const PointCharges points = given.points();
  const std::size_t n = points.size();
  Vectors result({static_cast<py::ssize_t>(n), py::ssize_t{3}});
  const std::span values(result.mutable_data(), 3 * n);
  const auto sum = make_coulomb_solver(
      {.solver = solver, .tolerance = tolerance, .norm = norm_of(norm)});
  {
    const py::gil_scoped_release unlocked;
    const ThreadCount count(threads);
    std::ranges::fill(values, 0.0);
    if (n > 0)
      sum->add_force(
          points, {values.subspan(0, n), values.subspan(n, n), values.subspan(2 * n, n)});
  }
  return result;
}

double force_error(Vectors x, Numbers q, const Vectors& force, const std::string& norm,
                   std::size_t targets, const std::optional<Flags>& moves) {
  const Charges given = charges(std::move(x), std::move(q), moves);
  const PointCharges points = given.points();
  const ConstVec3View f = vectors(force, "force");
  if (f.size() != points.size())
    throw InputError(fmt::format("force has {} rows; expected are {}, as of x", f.size(),
                                 points.size()));
  if (targets == 0) throw InputError("targets = 0: must be 1 or more");
  if (points.size() == 0) return 0;
  const ToleranceNorm of = norm_of(norm);
  const py::gil_scoped_release unlocked;
  return sampled_error(points, f, of, targets).in(of);
}

} // namespace

void bind_coulomb(py::module_& module) {
  module.def("forces", &forces, py::arg("x"), py::arg("q"), py::arg("solver"),
             py::arg("tolerance"), py::arg("norm"), py::arg("moves"), py::arg("threads"));
  module.def("force_error", &force_error, py::arg("x"), py::arg("q"), py::arg("force"),
             py::arg("norm"), py::arg("targets"), py::arg("moves"));
  module.def("solvers", [] {
    py::dict solvers;
    for (const SolverDescription& s : coulomb_solvers())
      solvers[py::str(std::string(s.name))] = std::string(s.description);
    return solvers;
  });
}

} // namespace ehdjet::python
