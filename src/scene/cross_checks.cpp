#include "cross_checks.hpp"

#include "ehdjet/core/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>

#include "cross_check_parts.hpp"

namespace ehdjet {
namespace {

/// More rows than this are a mistyped interval: 1e8 rows of observables are 10 GB.
constexpr double most_rows = 1e8;

template <class Refuse>
void check_near_field(const SceneConfig& c, const Refuse& refuse) {
  const CoulombConfig& s = *c.coulomb;
  const bool is_point = s.near_field == NearFieldForm::point;
  if (is_point && s.softened_pairs.value_or(false))
    refuse(
        "softened_pairs",
        "coulomb.softened_pairs = true and coulomb.near_field = \"point\": only the near "
        "field of a thread knows what softened pairs leave out. Give coulomb.near_field = "
        "\"free-surface\"");
  if (s.softening_range && !softens_pairs(c))
    refuse("softening_range",
           fmt::format("coulomb.softening_range = {}: no pairs are softened. Give "
                       "coulomb.softened_pairs = true with a near field, or remove it",
                       *s.softening_range));
  if (s.near_field == NearFieldForm::fixed && c.output.budget)
    refuse(
        "near_field",
        "coulomb.near_field = \"fixed\" and output.budget: the push of a thread of fixed "
        "radius has no energy. Take \"free-surface\", or remove output.budget");
  constexpr double shortest = 6, round_off = 1e-12; // radii
  if (c.nozzle && c.nozzle->inflow == InflowKind::pump && !softens_pairs(c)
      && c.nozzle->link_length < (shortest - round_off) * c.nozzle->radius)
    refuse(
        "softened_pairs",
        fmt::format(
            "nozzle.inflow = \"pump\", nozzle.link_length = {} m and nozzle.radius = {} m: "
            "point charges this close collapse. Take links of at least {} radii, or "
            "coulomb.near_field = \"free-surface\" with softened pairs",
            c.nozzle->link_length, c.nozzle->radius, shortest));
}

void check_coulomb(const SceneConfig& c, const SceneText& text) {
  if (!c.coulomb) return;
  const CoulombConfig& s = *c.coulomb;
  const auto refuse = [&](const char* key, const std::string& why) {
    text.fail(fmt::format("coulomb.{}", key), why);
  };
  check_near_field(c, refuse);
  const bool expands = s.solver != "direct";
  const auto needs_expansions = [&](const char* key, bool given) {
    if (given && !expands)
      refuse(key, fmt::format(
                      "coulomb.{} and coulomb.solver = \"direct\": the direct sum has no "
                      "expansions. Remove one",
                      key));
  };
  needs_expansions("order", s.order.has_value());
  needs_expansions("opening", s.opening.has_value());
  needs_expansions("leaf", s.leaf.has_value());
  if (s.leaf && *s.leaf % 8 != 0)
    refuse("leaf", fmt::format("coulomb.leaf = {}: must be a multiple of 8", *s.leaf));
  if (s.calibration && s.solver != "auto")
    refuse("calibration",
           fmt::format(
               "coulomb.calibration and coulomb.solver = \"{}\": only \"auto\" chooses "
               "by costs. Remove one",
               s.solver));
}

void check_refinement(const SceneConfig& c, const SceneText& text) {
  if (!c.refinement) return;
  const RefinementConfig& r = *c.refinement;
  const auto refuse = [&](const char* key, const std::string& why) {
    text.fail(fmt::format("refinement.{}", key), why);
  };
  if (c.nozzle && r.length < 2 * c.nozzle->link_length)
    refuse(
        "length",
        fmt::format("refinement.length = {} m and nozzle.link_length = {} m: must be at "
                    "least twice that, the length of the link that is being fed. Lengths "
                    "are in metres",
                    r.length, c.nozzle->link_length));
  const bool cuts = r.mesh == RefinedMesh::cut;
  if (!r.interval && !cuts)
    text.fail("refinement",
              "refinement.interval is missing: it is needed with mesh = \"redistribute\"; "
              "mesh = \"cut\" does without");
  if (r.interval && *r.interval >= c.run.end_time * (1 + 1e-9))
    refuse("interval",
           fmt::format("refinement.interval = {} s and run.end_time = {} s: no refinement "
                       "would happen",
                       *r.interval, c.run.end_time));
  const RefinementConfig usual;
  const auto is_of_redistribution = [&](const char* key, bool given) {
    if (cuts && given)
      refuse(key,
             fmt::format("refinement.{} has no meaning with mesh = \"cut\": links that "
                         "are cut share out what they carry. Remove it",
                         key));
  };
  is_of_redistribution("remap", r.remap != usual.remap);
  is_of_redistribution("velocity", r.velocity != usual.velocity);
  is_of_redistribution("stress", r.stress.has_value());
  if (r.coarsen && *r.coarsen > r.length / 2)
    refuse(
        "coarsen",
        fmt::format("refinement.coarsen = {} m: must be at most {} m, half of "
                    "refinement.length, or links would be joined that have just been cut",
                    *r.coarsen, r.length / 2));
  if (cuts && r.shortest && c.nozzle && *r.shortest * c.nozzle->radius > r.length / 2)
    refuse("shortest",
           fmt::format("refinement.shortest = {}: must be at most {:.3g}, "
                       "refinement.length/(2 nozzle.radius), or links would be joined that "
                       "have just been cut",
                       *r.shortest, r.length / (2 * c.nozzle->radius)));
}

void check_output(const SceneConfig& c, const SceneText& text) {
  for (const auto& [name, interval] : {std::pair{"observables", c.output.observables},
                                       {"frames", c.output.frames},
                                       {"budget", c.output.budget},
                                       {"checkpoints", c.output.checkpoints},
                                       {"resolving_power", c.output.resolving_power}})
    if (interval && c.run.end_time / *interval > most_rows)
      text.fail(
          fmt::format("output.{}", name),
          fmt::format(
              "output.{} = {} s and run.end_time = {} s: {:.2g} rows, more than {:.0e}",
              name, *interval, c.run.end_time, c.run.end_time / *interval, most_rows));
  if (c.output.deposit && !c.collector)
    text.fail("output.deposit",
              "output.deposit = true needs [collector]: nothing is deposited "
              "without one");
  if (c.output.refinements != RefinementRecords::none && !c.refinement)
    text.fail("output.refinements",
              fmt::format("output.refinements = \"{}\" needs [refinement]",
                          name_of(c.output.refinements, refinement_records)));
  if (c.output.refinements == RefinementRecords::energies && !c.coulomb)
    text.fail("output.refinements",
              "output.refinements = \"energies\" needs [coulomb]: \"sums\" has all other "
              "energies");
  if (c.output.resolving_power && !c.nozzle)
    text.fail(
        "output.resolving_power",
        fmt::format("output.resolving_power = {} s needs [nozzle]: the resolving power "
                    "is relative to its link_length",
                    *c.output.resolving_power));
}

} // namespace

void settle(SceneConfig& config, const SceneText& text) {
  check_rheology(config, text);
  check_jet(config, text);
  check_field(config, text);
  check_waveform(config, text);
  check_collector(config, text);
  settle_step(config.integrator, text);
  check_adaptive_keys(config.integrator, text);
  check_two_rates(config, text);
  if (config.integrator.stress_scale && !config.viscoelasticity)
    text.fail(
        "integrator.stress_scale",
        fmt::format("integrator.stress_scale = {} Pa needs [viscoelasticity]: without it "
                    "there is no stress",
                    *config.integrator.stress_scale));
  check_coulomb(config, text);
  check_refinement(config, text);
  check_air(config, text);
  check_evaporation(config, text);
  check_varicosity(config, text);
  check_array(config, text);
  check_output(config, text);
}

namespace {

/// Springs of finite length: 0 < A_zz, A_rr and A_zz + 2 A_rr < L2 (model 2.3).
void check_conformations(const Scene& scene, const SceneText& text) {
  const auto& fluid = scene.config.viscoelasticity;
  if (!fluid || fluid->model != Rheology::fene_p) return;
  const std::size_t modes = fluid->relaxation_modes().size();
  for (std::size_t m = 1; m <= modes; ++m) {
    const std::string number = modes > 1 ? fmt::format("_{}", m) : "";
    const auto zz = scene.chain.others.find("conformation_zz" + number),
               rr = scene.chain.others.find("conformation_rr" + number);
    if (zz == scene.chain.others.end() || rr == scene.chain.others.end()) continue;
    const auto &along = zz->second.values, &across = rr->second.values;
    for (std::size_t k = 1; k < std::min(along.size(), across.size()); ++k)
      if (!(along[k] > 0 && across[k] > 0
            && along[k] + 2 * across[k] < *fluid->extensibility))
        text.fail(
            "chain.file",
            fmt::format("{} = {} and {} = {} of bead {} of {}: both must be positive, and "
                        "conformation_zz + 2 conformation_rr less than "
                        "viscoelasticity.extensibility = {}",
                        zz->first, along[k], rr->first, across[k], k,
                        scene.config.chain->file, *fluid->extensibility));
  }
}

} // namespace

void check_chain_fits(const Scene& scene, const SceneText& text) {
  check_conformations(scene, text);
  if (const auto lost = scene.chain.others.find(evaporated);
      lost != scene.chain.others.end()) {
    const auto& drying = scene.config.evaporation;
    constexpr double overshoot = 1e-3; // of the steps of an earlier run
    const double most =
        drying ? drying->solution().lost_at(drying->solid_fraction) + overshoot : 0.0;
    for (std::size_t k = 0; k < lost->second.values.size(); ++k)
      if (const double e = lost->second.values[k]; !(e >= 0 && e <= most))
        text.fail("chain.file",
                  fmt::format(
                      "{} = {} of bead {} of {}: must be {}", evaporated, e, k,
                      scene.config.chain->file,
                      drying
                          ? fmt::format("from 0 to {:.6g}, where the jet is solid", most)
                          : "0 in a scene without [evaporation]: the volumes and masses of "
                            "the file are those at the nozzle"));
  }
  if (!scene.config.collector) return;
  const double h = scene.config.collector->distance;
  const auto& x = scene.chain.x;
  const auto beyond = std::ranges::find_if(x, [h](double at) { return at > h; });
  if (beyond != x.end())
    text.fail("collector.distance",
              fmt::format(
                  "collector.distance = {} m, and bead {} of {} is at x = {} m, beyond it",
                  h, beyond - x.begin(), scene.config.chain->file, *beyond));
}

} // namespace ehdjet
