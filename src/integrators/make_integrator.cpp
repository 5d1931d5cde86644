#include "ehdjet/integrators/make_integrator.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/integrators/auto_integrator.hpp"
#include "ehdjet/integrators/rosenbrock_w.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace ehdjet {
namespace {

std::vector<IntegratorDescription> list_methods() {
  std::vector<IntegratorDescription> methods{
      {"auto", "dormand-prince, or ros34pw2 while stability would limit its steps",
       MethodKind::chooses, true},
      {"two-rate",
       "macro steps and, for the beads near the nozzle, micro steps; both as \"auto\"",
       MethodKind::chooses, true}};
  for (const RosenbrockTableau& t : rosenbrock_tableaus())
    methods.push_back(
        {t.name, t.description, MethodKind::implicit_steps, t.error_order > 0});
  for (const ButcherTableau& t : butcher_tableaus())
    methods.push_back(
        {t.name, t.description, MethodKind::explicit_steps, t.error_order > 0});
  return methods;
}

} // namespace

std::span<const IntegratorDescription> integration_methods() {
  static const std::vector<IntegratorDescription> methods = list_methods();
  return methods;
}

const IntegratorDescription& integration_method(std::string_view name) {
  const auto methods = integration_methods();
  const auto found = std::ranges::find(methods, name, &IntegratorDescription::name);
  if (found != methods.end()) return *found;
  std::string known;
  for (const IntegratorDescription& m : methods)
    known.append(known.empty() ? "" : ", ").append(m.name);
  throw InputError("unknown integration method \"" + std::string(name)
                   + "\"; known: " + known);
}

std::unique_ptr<Integrator> make_integrator(std::string_view name,
                                            const ErrorScale& scale) {
  switch (integration_method(name).kind) {
  case MethodKind::chooses:
    return std::make_unique<AutoIntegrator>(scale);
  case MethodKind::implicit_steps: {
    const auto methods = rosenbrock_tableaus();
    return std::make_unique<RosenbrockW>(
        *std::ranges::find(methods, name, &RosenbrockTableau::name), scale);
  }
  case MethodKind::explicit_steps:
    break;
  }
  return std::make_unique<RungeKutta>(butcher_tableau(name), scale);
}

} // namespace ehdjet
