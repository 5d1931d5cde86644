#include "ehdjet/coulomb/make_solver.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "solvers.hpp"

namespace ehdjet {
namespace {

using detail::ClusterParameters;

// Round-off limits the tolerance, also that of the direct sum, because forces on a smooth curve
// nearly cancel.
constexpr double tightest = 1e-13, loosest = 0.1;

void check(const SolverOptions& o) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("Coulomb solver \"{}\": {}", o.solver, what));
  };
  if (!(o.tolerance >= tightest && o.tolerance <= loosest))
    refuse(fmt::format("tolerance {:g}: must be from {:g} to {:g}", o.tolerance, tightest,
                       loosest));
  if (o.order && (*o.order < 2 || *o.order > detail::highest_order))
    refuse(fmt::format("order {}: must be from 2 to {}", *o.order, detail::highest_order));
  if (o.opening && !(*o.opening > 0 && *o.opening < 1))
    refuse(fmt::format("opening {}: must be greater than 0 and less than 1", *o.opening));
  if (o.leaf && (*o.leaf == 0 || *o.leaf % detail::padding != 0))
    refuse(fmt::format("leaf {}: must be a multiple of {}", *o.leaf, detail::padding));
}

/// `order` and the leaf sizes are those with the lowest cost (bench/coulomb_bench).
ClusterParameters parameters(const SolverOptions& o, int (*order)(double digits),
                             std::size_t coarse_leaf, std::size_t fine_leaf) {
  check(o);
  const double digits = -std::log10(o.tolerance);
  return {.tolerance = o.tolerance,
          .norm = o.norm,
          .order = o.order.value_or(std::clamp(order(digits), 3, detail::highest_order)),
          .leaf = o.leaf.value_or(digits < 7 ? coarse_leaf : fine_leaf),
          .opening = o.opening.value_or(ClusterParameters{}.opening)};
}
int order_of_treecode(double digits) {
  return static_cast<int>(std::lround(1.35 * digits + 0.3));
}
/// Even orders, for which errors add up less (cluster_solver.cpp).
int order_of_fast_multipole(double digits) {
  return 2 * static_cast<int>(std::lround(0.5 * digits + 1.1));
}

constexpr SolverDescription known[] = {
    {"direct", "every pair, O(n^2): exact to round-off",
     [](const SolverOptions& o) { return make_direct_sum(o.simd); }},
    {"treecode", "Barnes-Hut with multipoles, O(n log n), within a tolerance",
     [](const SolverOptions& o) {
       return detail::make_cluster_solver(detail::kernels_of(o.simd),
                                          parameters(o, order_of_treecode, 64, 64),
                                          detail::make_treecode());
     }},
    {"fmm", "fast multipole method, O(n), within a tolerance",
     [](const SolverOptions& o) {
       return detail::make_cluster_solver(detail::kernels_of(o.simd),
                                          parameters(o, order_of_fast_multipole, 40, 48),
                                          detail::make_fast_multipole());
     }},
    {"auto", "direct or fmm, whichever is cheaper for the present charges",
     [](const SolverOptions& o) {
       check(o);
       return detail::make_auto_solver(o);
     }},
};

} // namespace

std::span<const SolverDescription> coulomb_solvers() {
  return known;
}

std::unique_ptr<CoulombSolver> make_coulomb_solver(const SolverOptions& options) {
  std::string names;
  for (const SolverDescription& solver : known) {
    if (solver.name == options.solver) {
      auto made = solver.make(options);
      return options.check_every
                 ? detail::make_checked_solver(std::move(made), *options.check_every)
                 : std::move(made);
    }
    names.append(names.empty() ? "" : ", ").append(solver.name);
  }
  throw InputError("unknown Coulomb solver '" + options.solver + "' (known: " + names
                   + ")");
}

} // namespace ehdjet
