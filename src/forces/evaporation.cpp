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

/// de/dt of link k, whose ends move with these velocities, and -d(de/dt)/de.
Evaporation::Rate Evaporation::rate(const Stage& stage, std::size_t k, const Vec3& v,
                                    const Vec3& v_upstream) const {
  const Links& links = stage.links();
  const auto x = stage.columns.position().x;
  const double lost = stage.columns.column(lost_)[k], l = links.length[k],
               volume = stage.volume[k];
  const Vec3 w = (v + v_upstream) / 2 - air_.velocity((x[k] + x[links.upstream(k)]) / 2);
  const double radius = std::sqrt(volume / (std::numbers::pi * l));
  const double sherwood =
      still_ + driven_ * std::cbrt(2 * radius * w.norm() / air_.kinematic_viscosity());
  const double left = std::max((end_ - lost) / ending_, -1.0);
  const double fresh_volume = volume / (1 - lost);
  return {.value = -std::expm1(-left) * conductance_ * l * sherwood / fresh_volume,
          .decay = std::exp(-left) / ending_ * conductance_ * l * sherwood / fresh_volume};
}

void Evaporation::set_column_rates(const Stage& stage, JetColumns<double> rates) {
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  double* out = rates.column(lost_).data();
  for (std::size_t k = stage.targets.begin; k < links.head; ++k) out[k] = 0;
  for_parts(links.beads.begin, links.beads.end, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      out[k] = rate(stage, k, v[k], v[links.upstream(k)]).value;
  });
  // A landed bead keeps the velocity of its impact as a record, but it rests on the plate.
  for (const LandedBead& b : stage.landed)
    if (const std::size_t k = b.bead + 1; k >= links.beads.begin && k < links.beads.end)
      out[k] = rate(stage, k, v[k], stage.plate_velocity).value;
  if (stage.feed != nullptr && links.beads.begin <= 1 && links.beads.end > 1)
    out[1] -= mixing(stage) * stage.columns.column(lost_)[1];
}

/// Fresh fluid that is mixed into link 1, over the volume that it had without evaporation [1/s].
double Evaporation::mixing(const Stage& stage) const {
  const double fresh_volume = stage.volume[1] / (1 - stage.columns.column(lost_)[1]);
  return stage.feed->flow_rate / fresh_volume;
}

// The end of the evaporation is the stiff part: thin links are solid within a fraction of a step. How the
// rate depends on the radius and on the velocity is slow.
void Evaporation::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  LinkDerivatives::Column& own = out.add_column(lost_);
  for (std::size_t k = links.first; k <= links.last; ++k)
    own.relaxation[k] += rate(stage, k, v[k], v[links.upstream(k)]).decay;
  if (stage.feed != nullptr && links.first <= 1) own.relaxation[1] += mixing(stage);
}

} // namespace ehdjet
