#include "ehdjet/forces/evaporation.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace ehdjet {

double Solution::density() const {
  return 1
         / (polymer_fraction / polymer_density + (1 - polymer_fraction) / solvent_density);
}

double Solution::polymer_volume() const {
  return polymer_fraction / polymer_density * density();
}

double Solution::fraction_after(double lost) const {
  const double polymer = polymer_density * polymer_volume(),
               solvent = solvent_density * (1 - polymer_volume() - lost);
  return polymer / (polymer + solvent);
}

double Solution::lost_at(double fraction) const {
  const double polymer = polymer_volume();
  return 1 - polymer - polymer * polymer_density / solvent_density * (1 / fraction - 1);
}

Evaporation::Evaporation(AirFlow air, const Solution& solution,
                         const Vaporisation& vaporisation)
    : air_(std::move(air))
    , solution_(solution)
    , still_(vaporisation.still_air_sherwood)
    , driven_(0.495 * std::sqrt(air_.kinematic_viscosity() / vaporisation.diffusivity))
    , conductance_(std::numbers::pi * vaporisation.diffusivity * vaporisation.saturation
                   * (1 - vaporisation.humidity) / solution.solvent_density)
    , end_(solution.lost_at(vaporisation.solid_fraction))
    , ending_(vaporisation.ending * end_) {
  EHDJET_EXPECTS(vaporisation.diffusivity > 0 && vaporisation.humidity <= 1);
  EHDJET_EXPECTS(end_ > 0 && ending_ > 0);
}

std::vector<BeadColumn> Evaporation::columns() const {
  return {
      {.name = std::string(column),
       .unit = "1",
       .description = "of that link's volume as it left the nozzle: what has evaporated",
       .remap = ColumnRemap::conservative,
       .weight = "volume",
       .error_scale = 0.1,
       .drying = Drying{.mass = solution_.solvent_density / solution_.density(),
                        .dry = solution_.polymer_volume()}}};
}

TermAccount Evaporation::account() const {
  return {.channel = {.name = "evaporation",
                      .energy = "evaporation_exchange",
                      .energy_meaning =
                          "brought in so far by evaporation: vapour leaves, and "
                          "energies change with the volume",
                      .momentum = "vapour_impulse",
                      .momentum_meaning =
                          "so far, of vapour that leaves with the velocity of its bead"}};
}

void Evaporation::bind(const BeadTable& table) {
  lost_ = table.find_integrated(column).value();
}

void Evaporation::set_column_rates(const Stage& stage, JetColumns<double> rates) {
  const Links& links = stage.links();
  const auto r = stage.columns.position(), v = stage.columns.velocity();
  const double *lost = stage.columns.column(lost_).data(), *l = links.length.data(),
               *volume = stage.volume.data();
  double* out = rates.column(lost_).data();
  const double nu = air_.kinematic_viscosity();
  const auto rate = [&](std::size_t k, std::size_t upstream, const Vec3& v_upstream) {
    const Vec3 w = (v[k] + v_upstream) / 2 - air_.velocity((r.x[k] + r.x[upstream]) / 2);
    const double radius = std::sqrt(volume[k] / (std::numbers::pi * l[k]));
    const double sherwood = still_ + driven_ * std::cbrt(2 * radius * w.norm() / nu);
    const double left = std::max((end_ - lost[k]) / ending_, -1.0);
    const double fresh_volume = volume[k] / (1 - lost[k]);
    return -std::expm1(-left) * conductance_ * l[k] * sherwood / fresh_volume;
  };
  for (std::size_t k = stage.targets.begin; k < links.head; ++k) out[k] = 0;
  for_parts(links.beads.begin, links.beads.end, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t upstream = links.upstream(k);
      out[k] = rate(k, upstream, v[upstream]);
    }
  });
  // A landed bead keeps the velocity of its impact as a record, but it rests on the plate.
  for (const LandedBead& b : stage.landed)
    if (const std::size_t k = b.bead + 1; k >= links.beads.begin && k < links.beads.end)
      out[k] = rate(k, b.bead, stage.plate_velocity);
  if (stage.feed != nullptr && links.beads.begin <= 1 && links.beads.end > 1) {
    const double fresh_volume = stage.volume[1] / (1 - lost[1]);
    out[1] -= stage.feed->flow_rate / fresh_volume * lost[1]; // fresh fluid is mixed in
  }
}

} // namespace ehdjet
