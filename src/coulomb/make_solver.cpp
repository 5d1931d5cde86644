#include "ehdjet/coulomb/make_solver.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/direct_sum.hpp"

#include <array>
#include <iterator>
#include <string>

namespace ehdjet {
namespace {

struct KnownSolver {
  SolverDescription about;
  std::unique_ptr<CoulombSolver> (*make)();
};

constexpr KnownSolver known[] = {
    {{"direct", "every pair, O(n^2): exact to round-off"},
     [] { return make_direct_sum(); }},
};

} // namespace

std::span<const SolverDescription> coulomb_solvers() {
  static constexpr auto descriptions = [] {
    std::array<SolverDescription, std::size(known)> about;
    for (std::size_t k = 0; k < about.size(); ++k) about[k] = known[k].about;
    return about;
  }();
  return descriptions;
}

std::unique_ptr<CoulombSolver> make_coulomb_solver(std::string_view name) {
  std::string names;
  for (const KnownSolver& solver : known) {
    if (solver.about.name == name) return solver.make();
    names.append(names.empty() ? "" : ", ").append(solver.about.name);
  }
  throw InputError("unknown Coulomb solver '" + std::string(name) + "' (known: " + names
                   + ")");
}

} // namespace ehdjet
