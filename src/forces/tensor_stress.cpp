#include "ehdjet/forces/tensor_stress.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"

#include <cmath>

#include "link_strain.hpp"
#include "link_tension.hpp"

namespace ehdjet {

template <class Law>
TensorStress<Law>::TensorStress(const Law& law, const Options& options)
    : law_(law)
    , options_(options)
    , name_(options.mode == 0 ? "viscoelasticity"
                              : "viscoelasticity, mode " + std::to_string(options.mode)) {
  EHDJET_EXPECTS(law.fluid.typical_modulus() > 0 && options.nozzle_stretch > 0);
}

template <class Law>
std::string TensorStress<Law>::column_name(const char* component) const {
  const std::string name =
      std::string(Law::is_stress ? "tau_" : "conformation_") + component;
  return options_.mode == 0 ? name : name + '_' + std::to_string(options_.mode);
}

template <class Law>
std::vector<BeadColumn> TensorStress<Law>::columns() const {
  const AxialPair at_birth = law_.of_stretch(1, options_.nozzle_stretch);
  const double unit = Law::is_stress ? 1 : law_.fluid.typical_modulus(); // [Pa]
  const std::string what = Law::is_stress ? "polymer stress of that link, "
                                          : "conformation of the polymer in that link, ";
  const double at_rest = Law::is_stress ? 0 : 1;
  const auto column = [&](const char* component, const char* direction, double born) {
    return BeadColumn{.name = column_name(component),
                      .unit = Law::is_stress ? "Pa" : "1",
                      .description = what + direction,
                      .remap = ColumnRemap::conservative,
                      .weight = "volume",
                      .error_scale = 0.1 * law_.fluid.typical_modulus() / unit,
                      .at_birth = born,
                      .unless_given = at_rest,
                      .stress_of_one = unit};
  };
  return {column("zz", "along it", at_birth.zz), column("rr", "across it", at_birth.rr)};
}

template <class Law>
void TensorStress<Law>::bind(const BeadTable& table) {
  zz_ = table.find_integrated(column_name("zz")).value();
  rr_ = table.find_integrated(column_name("rr")).value();
  law_.fluid.bind(table);
}

template <class Law>
void TensorStress<Law>::add_force(const Stage& stage, Vec3View force) {
  if constexpr (Law::coupled) law_.fluid.look_at(stage); // only there N1 depends on G
  const Links& links = stage.links();
  const double *l = links.length.data(), *v = stage.volume.data(),
               *zz = stage.columns.column(zz_).data(),
               *rr = stage.columns.column(rr_).data();
  double* t = per_link(links, tension_per_length_);
  for_parts(links.first, links.last + 1,
            [=, law = law_](std::size_t begin, std::size_t end) {
#pragma omp simd
              for (std::size_t k = begin; k < end; ++k)
                t[k] = v[k] * law.stress_difference(k, {.zz = zz[k], .rr = rr[k]})
                       / (l[k] * l[k]);
            });
  add_link_tension(links, tension_per_length_, stage.targets, force);
}

template <class Law>
void TensorStress<Law>::set_column_rates(const Stage& stage, JetColumns<double> rates) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  const double *e = strain_rates(stage, strain_rate_),
               *zz = stage.columns.column(zz_).data(),
               *rr = stage.columns.column(rr_).data();
  double *zz_rate = rates.column(zz_).data(), *rr_rate = rates.column(rr_).data();
  for (std::size_t k = stage.targets.begin; k < links.head; ++k)
    zz_rate[k] = rr_rate[k] = 0;
  for_parts(links.beads.begin, links.beads.end,
            [=, law = law_](std::size_t begin, std::size_t end) {
#pragma omp simd
              for (std::size_t k = begin; k < end; ++k) {
                const AxialPair rate = law.rate(k, e[k], {.zz = zz[k], .rr = rr[k]});
                zz_rate[k] = rate.zz, rr_rate[k] = rate.rr;
              }
            });
  if (stage.feed == nullptr || links.beads.begin > 1 || links.beads.end <= 1) return;
  // New fluid is stretched at once and mixed in by volume (model 2.3).
  const double filling = stage.feed->flow_rate / stage.volume[1];
  const AxialPair entry = law_.of_stretch(1, entry_stretch(stage));
  zz_rate[1] += filling * (entry.zz - zz[1]), rr_rate[1] += filling * (entry.rr - rr[1]);
}

// Fluid that enters link 1 takes its section A_1 at once, from A0 on and from the stretch that it
// has in the nozzle.
template <class Law>
double TensorStress<Law>::entry_stretch(const Stage& stage) const {
  const double section = stage.volume[1] / stage.links().length[1];
  return options_.nozzle_stretch * stage.feed->section / section;
}

// With F = V N1(s) d/l^2, s' = L(e, s), e = (w.d)/l^2:
//     dF/dd = V N1/l^2 (I - 2 t t^T),   dF/ds = V d/l^2 dN1/ds
//     ds'/dw = dL/de d/l^2,             ds'/dd = dL/de (w - 2 (w.t) t)/l^2
template <class Law>
void TensorStress<Law>::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  const auto [zz, rr] = [&] {
    const auto pair = out.add_pair(zz_, rr_, Law::coupled);
    return std::pair(&pair[0], &pair[1]);
  }();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const LinkMotion motion = motion_of(stage, k);
    const double l = links.length[k];
    const Vec3 d = links.vector(k), t = d / l, &w = motion.velocity;
    const AxialPair s = state(stage, k);
    const PairSlopes slopes = law_.slopes(k, motion.strain_rate, s);
    const double area_per_length = stage.volume[k] / (l * l);
    out.add_pull(k, area_per_length * law_.stress_difference(k, s)
                        * (Mat3::Identity() - 2 * t * t.transpose()));
    const Vec3 per_velocity = d / (l * l), per_place = (w - 2 * w.dot(t) * t) / (l * l);
    zz->tension[k] = area_per_length * slopes.pull.zz * d;
    rr->tension[k] = area_per_length * slopes.pull.rr * d;
    zz->stretching[k] = slopes.strain.zz * per_velocity;
    rr->stretching[k] = slopes.strain.rr * per_velocity;
    zz->turning[k] = slopes.strain.zz * per_place;
    rr->turning[k] = slopes.strain.rr * per_place;
    zz->relaxation[k] = slopes.relaxation.zz, rr->relaxation[k] = slopes.relaxation.rr;
    if constexpr (Law::coupled)
      zz->coupling[k] = slopes.coupling.zz, rr->coupling[k] = slopes.coupling.rr;
    if (!is_fed(stage, k)) continue;
    const double filling = stage.feed->flow_rate / stage.volume[k];
    const AxialPair entry = law_.stretch_slope(k, entry_stretch(stage)); // d/d ln l_1
    zz->relaxation[k] += filling, rr->relaxation[k] += filling;
    zz->turning[k] += filling * entry.zz / (l * l) * d;
    rr->turning[k] += filling * entry.rr / (l * l) * d;
  }
}

template <class Law>
TermAccount TensorStress<Law>::account() const {
  return {.energy = "elastic_energy",
          .energy_meaning = "of the springs of the polymer, sum V W (model 2.3)",
          .channel = {.name = "dissipation",
                      .energy = "dissipated_energy",
                      .energy_meaning = "lost so far to relaxation and viscosity",
                      .loss = true}};
}

template <class Law>
double TensorStress<Law>::energy(const Stage& stage) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  double energy = 0;
  for (std::size_t k = links.first; k <= links.last; ++k)
    energy += stage.volume[k] * law_.energy(k, state(stage, k));
  return energy;
}

// d/dt V W = T t.(v_k - v_(k-1)) - V (dissipation), with the velocity of the fluid, v_s included, at
// the nozzle. The link of a bead that has landed keeps its state, and so its energy.
template <class Law>
void TensorStress<Law>::add_power(const Stage& stage, Exchange& exchange) {
  law_.fluid.look_at(stage);
  const Links& links = stage.links();
  const auto v = stage.columns.velocity();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const std::size_t up = links.upstream(k);
    const AxialPair s = state(stage, k);
    const double volume = stage.volume[k], l = links.length[k],
                 stress = law_.stress_difference(k, s);
    const Vec3 pull = volume * stress / (l * l) * links.vector(k); // T t
    const bool up_moves = exchange.support(up) == Support::none;
    if (exchange.support(k) == Support::collector) {
      exchange.by_support_of(k).energy +=
          pull.dot((up_moves ? v[up] : exchange.led(up)) - exchange.led(k));
      continue;
    }
    exchange.own.energy -= volume * law_.dissipation(k, s);
    if (is_fed(stage, k)) {
      // Mixing changes W; that new fluid flows in against the tension costs Q N1.
      const AxialPair entry = law_.of_stretch(k, entry_stretch(stage)),
                      slope = law_.energy_slope(k, s);
      const double mixed = slope.zz * (entry.zz - s.zz) + slope.rr * (entry.rr - s.rr);
      exchange.by_support_of(up).energy += stage.feed->flow_rate * (mixed - stress);
      continue;
    }
    if (!up_moves && exchange.support(up) != Support::collector)
      exchange.by_support_of(up).energy -= pull.dot(v[up] - exchange.led(up));
  }
}

template <class Law>
double TensorStress<Law>::feeding_power(const Stage& stage, const LinkContent& rate) {
  law_.fluid.look_at(stage);
  return rate.volume * law_.energy(1, state(stage, 1));
}

template <class Law>
void TensorStress<Law>::add_tension(const Stage& stage, std::span<double> tension) {
  if constexpr (Law::coupled) law_.fluid.look_at(stage); // only there N1 depends on G
  const Links& links = stage.links();
  for (std::size_t k = links.first; k <= links.last; ++k)
    tension[k] +=
        stage.volume[k] * law_.stress_difference(k, state(stage, k)) / links.length[k];
}

// N1 grows with the stretch.
template <class Law>
double stretch_of_stress(std::span<const Law> laws, double stress_difference) {
  if (stress_difference == 0) return 1;
  double low = -40, high = 40; // ln stretch
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    double stress = 0;
    for (const Law& law : laws)
      stress += law.stress_difference(1, law.of_stretch(1, std::exp(middle)));
    const bool below = stress < stress_difference; // false beyond the range of a spring
    // Compressed springs reach their end, too.
    (below || (std::isnan(stress) && middle < 0) ? low : high) = middle;
  }
  return std::exp((low + high) / 2);
}

template class TensorStress<UpperConvected<DryingFluid>>;
template class TensorStress<Giesekus<DryingFluid>>;
template class TensorStress<FeneP<DryingFluid>>;
template class TensorStress<UpperConvected<>>;
template class TensorStress<Giesekus<>>;
template class TensorStress<FeneP<>>;
template double stretch_of_stress(std::span<const UpperConvected<DryingFluid>>, double);
template double stretch_of_stress(std::span<const Giesekus<DryingFluid>>, double);
template double stretch_of_stress(std::span<const FeneP<DryingFluid>>, double);
template double stretch_of_stress(std::span<const UpperConvected<>>, double);
template double stretch_of_stress(std::span<const Giesekus<>>, double);
template double stretch_of_stress(std::span<const FeneP<>>, double);

} // namespace ehdjet
