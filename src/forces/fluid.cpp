#include "ehdjet/forces/fluid.hpp"

#include "ehdjet/core/parallel.hpp"

#include <cmath>
#include <numbers>

namespace ehdjet {

double Thickening::viscosity_ratio(double fraction) const {
  const double fresh = std::pow(solution.polymer_fraction, power);
  return std::exp(std::numbers::ln10 * exponent * (std::pow(fraction, power) - fresh));
}

double Thickening::relaxation_ratio(double fraction) const {
  return fraction / solution.polymer_fraction;
}

DryingFluid::DryingFluid(double elastic_modulus, double relaxation,
                         const Thickening& thickening)
    : elastic_modulus_(elastic_modulus)
    , relaxation_(relaxation)
    , thickening_(thickening) {}

void DryingFluid::bind(const BeadTable& table) const {
  ratios_->lost = table.find_integrated(Evaporation::column).value();
}

void DryingFluid::look_at(const Stage& stage) const {
  const Links& links = stage.links();
  Ratios& ratios = *ratios_;
  ratios.modulus.resize(links.length.size(), 1.0);
  ratios.rate.resize(links.length.size(), 1.0);
  const double* lost = stage.columns.column(ratios.lost).data();
  for_parts(links.first, links.last + 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const double fraction = thickening_.solution.fraction_after(lost[k]);
      const double time = thickening_.relaxation_ratio(fraction);
      ratios.modulus[k] = thickening_.viscosity_ratio(fraction) / time;
      ratios.rate[k] = 1 / time;
    }
  });
}

} // namespace ehdjet
