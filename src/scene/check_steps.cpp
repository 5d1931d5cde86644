#include "ehdjet/integrators/make_integrator.hpp"
#include "ehdjet/scene/stability.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <utility>

#include "cross_check_parts.hpp"
#include "cross_checks.hpp"

namespace ehdjet {
namespace {

constexpr double default_rtol = 1e-6;
/// So many steps would take weeks with 100 beads.
constexpr double too_many_steps = 1e8;
/// Fewer steps are refused, too, if stability needs steps that are so much shorter than accuracy's.
constexpr double many_steps = 1e6, far_below = 1e-3;

} // namespace

void settle_step(IntegratorConfig& i, const SceneText& text) {
  const IntegratorDescription& method = integration_method(i.method);
  const bool has_error_estimate = method.estimates_errors;
  const std::string method_is = fmt::format("integrator.method = \"{}\"", i.method);
  if (i.rtol && i.step)
    text.fail(
        "integrator.step",
        fmt::format("integrator.rtol = {} and integrator.step = {} s: the step is adaptive "
                    "or fixed. Remove one",
                    *i.rtol, *i.step));
  if (i.step && method.kind == MethodKind::chooses)
    text.fail("integrator.step",
              fmt::format(
                  "integrator.step = {} s and {}: it chooses the steps and methods that a "
                  "tolerance allows. Name another method, or give integrator.rtol instead",
                  *i.step, method_is));
  if (i.rtol && !has_error_estimate)
    text.fail(
        "integrator.rtol",
        fmt::format("integrator.rtol = {} and {}: this method has no error estimate. Give "
                    "integrator.step, or leave the method to \"auto\"",
                    *i.rtol, method_is));
  if (!i.rtol && !i.step) {
    if (!has_error_estimate)
      text.fail("integrator.method",
                fmt::format(
                    "{} needs integrator.step: this method has no error estimate to choose "
                    "its own steps by",
                    method_is));
    i.rtol = default_rtol;
  }
}

void check_adaptive_keys(const IntegratorConfig& i, const SceneText& text) {
  if (i.step) {
    for (const auto& [name, value] : {std::pair{"initial_step", i.initial_step},
                                      {"max_step", i.max_step},
                                      {"position_scale", i.position_scale},
                                      {"stress_scale", i.stress_scale}})
      if (value)
        text.fail(
            fmt::format("integrator.{}", name),
            fmt::format("integrator.{} = {} and integrator.step = {} s: with a fixed step "
                        "there is no error control. Remove one",
                        name, *value, *i.step));
    return;
  }
  for (const auto& [name, value] :
       {std::pair{"initial_step", i.initial_step}, {"max_step", i.max_step}})
    if (value && *value < i.min_step)
      text.fail(fmt::format("integrator.{}", name),
                fmt::format(
                    "integrator.{} = {} s and integrator.min_step = {} s: must be at least "
                    "the shortest step",
                    name, *value, i.min_step));
}

/// Two rates are for beads that are born at a nozzle and repel each other.
void check_two_rates(const SceneConfig& c, const SceneText& text) {
  const IntegratorConfig& i = c.integrator;
  const bool named = i.method == "two-rate";
  const auto refuse = [&](const char* key, const std::string& why) {
    text.fail(fmt::format("integrator.{}", key), why);
  };
  const char* missing = !c.nozzle    ? "[nozzle], where the fast beads are"
                        : !c.coulomb ? "[coulomb], whose sums it saves"
                        : has_images(c)
                            ? "collector.images = \"none\": images of near beads are far"
                            : nullptr;
  if (named && missing != nullptr)
    refuse("method",
           fmt::format("integrator.method = \"two-rate\" needs {}. Take \"auto\" (the "
                       "default)",
                       missing));
  if (named && i.events == EventPlacement::step_end)
    refuse("events",
           "integrator.events = \"step-end\" and integrator.method = \"two-rate\": "
           "beads are born within its steps. Take \"located\" (the default)");
  if (named && i.landings == LandingSteps::located)
    refuse("landings",
           "integrator.landings = \"located\" and integrator.method = \"two-rate\": "
           "beads land within its steps. Take \"auto\" (the default)");
  if (named && c.refinement && c.refinement->mesh == RefinedMesh::cut
      && !c.refinement->interval)
    refuse("method", "integrator.method = \"two-rate\" and refinement.mesh = \"cut\" need "
                     "refinement.interval: without it links are cut at the ends of steps, "
                     "and these steps are "
                     "long");
  for (const auto& [key, given] : {std::pair{"inner_beads", i.inner_beads.has_value()},
                                   {"downstream_rtol", i.downstream_rtol.has_value()}})
    if (given && !can_have_two_rates(c))
      refuse(key,
             fmt::format(
                 "integrator.{} is about two rates, which this scene cannot have: they "
                 "need [nozzle], [coulomb], rtol, no [array], no images, events = "
                 "\"located\", "
                 "landings = \"auto\", no cuts without refinement.interval, and "
                 "integrator.method = \"two-rate\" or \"auto\". Remove it",
                 key));
}

void check_stability(const Scene& scene, const SceneText& text) {
  const IntegratorConfig& i = scene.config.integrator;
  if (i.step || integration_method(i.method).kind != MethodKind::explicit_steps) return;
  const LinkState link = link_state(scene, stiffest_link(scene));
  const ChainRates rates = chain_rates(scene.config, link);
  const StabilityLimits limits = step_limits(rates, butcher_tableau(i.method));
  const double unlimited = std::numeric_limits<double>::infinity();
  const double viscoelastic = limits.viscoelastic.value_or(unlimited),
               damping = limits.damping.value_or(unlimited),
               tension = limits.surface_tension.value_or(unlimited),
               limit = std::min({viscoelastic, damping, tension});
  const double steps = scene.config.run.end_time / limit;
  const double motion = 1 / rates.coulomb.value_or(0); // infinite without charges
  const bool far_below_accuracy =
      std::isfinite(motion) && limit < far_below * motion && steps > many_steps;
  if (steps <= too_many_steps && !far_below_accuracy) return;

  std::string reason;
  if (damping < std::min(viscoelastic, tension))
    reason = fmt::format("viscosity damps links of {:.3g} m at {:.3g} 1/s", link.length,
                         *rates.damping);
  else if (tension < viscoelastic)
    reason = fmt::format("surface tension moves links of {:.3g} m at {:.3g} 1/s",
                         link.length, *rates.surface_tension);
  else if (rates.relaxation.value_or(0) > *rates.elastic)
    reason = fmt::format("stress relaxes at G/mu = {:.3g} 1/s", *rates.relaxation);
  else
    reason = fmt::format("elastic waves turn links of {:.3g} m around at {:.3g} 1/s",
                         link.length, *rates.elastic);
  text.fail("integrator.method",
            fmt::format("integrator.method = \"{}\": {}, so that explicit steps are stable "
                        "up to about {:.2g} s only and {:.4g} s take {:.1e} of them. Take "
                        "integrator.method = \"auto\" (the default) or \"ros34pw2\", whose "
                        "steps this does not limit",
                        i.method, reason, limit, scene.config.run.end_time, steps));
}

} // namespace ehdjet
