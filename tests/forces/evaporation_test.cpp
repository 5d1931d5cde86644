#include "ehdjet/forces/evaporation.hpp"
#include "ehdjet/forces/fluid.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/forces/tensor_stress.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "support/march.hpp"
#include "support/term_chain.hpp"

namespace ehdjet {
namespace {

using namespace test;
using std::numbers::pi;

constexpr double nu = 1.511e-5, gas_constant = 8.314462618, room = 293.15;
constexpr double water_vapour = 2329.57 * 0.018015 / (gas_constant * room); // [kg/m^3]
constexpr double ethanol_vapour = 5870 * 0.04607 / (gas_constant * room);
constexpr double water_diffusivity = 2.42e-5, ethanol_diffusivity = 1.18e-5;

TEST(Solution, dries_to_a_radius_that_follows_from_the_densities) {
  struct Row {
    double fraction, polymer, solvent, dry_over_wet;
  };
  for (const auto& [c, p, s, expected] : {Row{0.10, 1200, 789, 0.26092}, // PVP in ethanol
                                          Row{0.06, 1130, 998, 0.23101}, // PEO in water
                                          Row{0.10, 1180, 944, 0.28571}}) { // PAN in DMF
    const Solution solution{p, s, c};
    EXPECT_NEAR(std::sqrt(solution.polymer_volume()), expected, 6e-6) << p;
    EXPECT_NEAR(solution.fraction_after(0), c, 1e-15);
    EXPECT_NEAR(solution.fraction_after(1 - solution.polymer_volume()), 1, 1e-14);
    EXPECT_NEAR(solution.fraction_after(solution.lost_at(0.9)), 0.9, 1e-14);
    // Masses add up: what is left of the solution has c_0/0.9 of its mass.
    const double lost = solution.lost_at(0.9);
    EXPECT_NEAR(1 - s * lost / solution.density(), c / 0.9, 1e-14);
  }
}

// mu/mu_0 with B = 7, m = 0.1, c_0 = 0.06, and tau/tau_0.
TEST(Thickening, has_its_published_values) {
  const Thickening law{.solution = {1200, 789, 0.06}};
  EXPECT_NEAR(law.viscosity_ratio(0.1), 1.891915, 5e-7);
  EXPECT_NEAR(law.viscosity_ratio(0.2), 4.742239, 5e-7);
  EXPECT_NEAR(law.viscosity_ratio(0.5), 17.694362, 5e-7);
  EXPECT_NEAR(law.viscosity_ratio(0.9), 43.978335, 5e-7);
  EXPECT_NEAR(law.relaxation_ratio(0.9), 15, 1e-14);
}

/// One straight link that moves across itself through still air, with a length that stays.
class Link {
public:
  Link(double radius, double speed, const Solution& solution,
       const Vaporisation& vaporisation)
      : radius_(radius)
      , speed_(speed)
      , term_({1.21, nu, Vec3::Zero()}, solution, vaporisation) {
    auto table = std::make_shared<BeadTable>();
    for (const BeadColumn& c : term_.columns()) table->declare(c);
    term_.bind(*table);
    table_ = std::move(table);
  }
  [[nodiscard]] double rate(double lost, std::optional<Feed> feed = {}) {
    return rate_and_decay(lost, feed).first;
  }
  /// de/dt, and what an implicit step takes for -d(de/dt)/de.
  [[nodiscard]] std::pair<double, double> rate_and_decay(double lost,
                                                         std::optional<Feed> feed = {}) {
    JetState jet = blank_jet(table_, 2);
    constexpr double l = 1e-3;
    jet.columns().position().set(1, {l, 0, 0});
    for (const std::size_t k : {0U, 1U}) jet.columns().velocity().set(k, {0, speed_, 0});
    jet.columns().column(6)[1] = lost;
    const std::vector<double> volume(2, pi * radius_ * radius_ * l * (1 - lost));
    Stage stage;
    stage.columns = jet.columns();
    stage.mass = jet.mass, stage.volume = volume;
    if (feed) stage.feed = &*feed;
    std::vector<double> rates(jet.y.size());
    term_.set_column_rates(stage, {rates, 2});
    EXPECT_EQ(rates[12], 0);
    LinkDerivatives derivatives;
    derivatives.reset(2);
    term_.add_derivatives(stage, derivatives);
    EXPECT_EQ(derivatives.columns().size(), 1U);
    EXPECT_EQ(derivatives.columns()[0].place, 6U);
    EXPECT_EQ(derivatives.columns()[0].relaxation[0], 0);
    return {rates[13], derivatives.columns()[0].relaxation[1]};
  }
  [[nodiscard]] double lost_after(double t) {
    FunctionSystem system([this](double, std::span<const double> y, std::span<double> r) {
      r[0] = rate(y[0]);
    });
    const ErrorScale scale{.rtol = 1e-12, .column_scale = {1}};
    return march_adaptively("dop853", system, {0}, 0, t, scale)[0];
  }
  /// When that share has evaporated.
  [[nodiscard]] double time_of(double lost) {
    FunctionSystem time([this](double e, std::span<const double>, std::span<double> r) {
      r[0] = 1 / rate(e);
    });
    const ErrorScale scale{.rtol = 1e-12, .column_scale = {1e-3}};
    return march_adaptively("dop853", time, {0}, 0, lost, scale)[0];
  }

private:
  double radius_, speed_;
  Evaporation term_;
  std::shared_ptr<const BeadTable> table_;
};

Vaporisation without_ending(double diffusivity, double saturation) {
  return {.diffusivity = diffusivity,
          .saturation = saturation,
          .solid_fraction = 1,
          .still_air_sherwood = 0,
          .ending = 1e-9};
}

// a^(5/3) = a0^(5/3) - (5/3) K t without polymer and without a rate in still air.
TEST(Evaporation, of_a_pure_solvent_follows_its_closed_form) {
  const double a0 = 4e-6, speed = 20, k = 6.42888279394e-8;
  const Solution solvent{1200, 789, 1e-12};
  Link link(a0, speed, solvent, without_ending(ethanol_diffusivity, ethanol_vapour));
  for (const double t : {1e-3, 4e-3, 9e-3}) {
    const double radius = std::pow(std::pow(a0, 5. / 3) - 5. / 3 * k * t, 0.6);
    EXPECT_NEAR(1 - link.lost_after(t), std::pow(radius / a0, 2), 1e-9) << t;
  }
  EXPECT_NEAR(link.time_of(1 - 1e-6), 9.406954884e-3, 1e-7);
}

// The end is stiff: the rate falls to zero over a hundredth of the volume. Before, it changes slowly.
TEST(Evaporation, has_the_derivative_of_its_end) {
  const Solution pvp{1200, 789, 0.1};
  Link link(1e-6, 1, pvp,
            {.diffusivity = ethanol_diffusivity, .saturation = ethanol_vapour});
  const double end = pvp.lost_at(0.9), step = 1e-7;
  for (const double lost : {0.99 * end, 0.995 * end, end}) {
    const double slope = (link.rate(lost - step) - link.rate(lost + step)) / (2 * step);
    EXPECT_NEAR(link.rate_and_decay(lost).second / slope, 1, 0.03) << lost;
  }
  const double start = link.rate_and_decay(0).second;
  EXPECT_LT(start, 1e-9 * link.rate_and_decay(end).second);
  const Feed feed{.flow_rate = 1e-9};
  EXPECT_NEAR(link.rate_and_decay(0, feed).second - start,
              feed.flow_rate / (pi * 1e-12 * 1e-3), 1e-3);
}

// Times apart from this program: 158.7 ms in humid air and 22.8 ms.
TEST(Evaporation, dries_jets_of_water_and_ethanol_in_the_known_times) {
  const double a0 = 4e-6, speed = 1;
  Vaporisation water = without_ending(water_diffusivity, water_vapour);
  water.humidity = 0.165;
  const Solution peo{1130, 998, 0.06}, pvp{1200, 789, 0.1};
  EXPECT_NEAR(Link(a0, speed, peo, water).time_of(0.999 * (1 - peo.polymer_volume())),
              158.7e-3, 0.06e-3);
  EXPECT_NEAR(Link(a0, speed, pvp, without_ending(ethanol_diffusivity, ethanol_vapour))
                  .time_of(0.999 * (1 - pvp.polymer_volume())),
              22.8e-3, 0.05e-3);
}

TEST(Evaporation, ends_smoothly_where_the_jet_is_solid) {
  const Solution pvp{1200, 789, 0.1};
  Link link(4e-6, 1, pvp,
            {.diffusivity = ethanol_diffusivity, .saturation = ethanol_vapour});
  const double end = pvp.lost_at(0.9);
  EXPECT_NEAR(link.lost_after(0.1), end, 1e-9);
  EXPECT_LE(link.rate(end), 0);
  EXPECT_LT(link.rate(end + 1e-3), 0); // an error of a step does not stay
  EXPECT_NEAR(link.rate(0.9 * end) / link.rate(0.9 * end - 1e-6), 1, 1e-4);
}

TEST(Evaporation, needs_no_wind_and_none_happens_in_saturated_air) {
  const Solution pvp{1200, 789, 0.1};
  Vaporisation v{.diffusivity = ethanol_diffusivity, .saturation = ethanol_vapour};
  const double a = 4e-6;
  // V_0 de/dt = pi l D 0.3 C/rho_s
  EXPECT_NEAR(Link(a, 0, pvp, v).rate(0) * a * a * 789
                  / (ethanol_diffusivity * 0.3 * ethanol_vapour),
              1, 1e-14);
  v.humidity = 1;
  EXPECT_EQ(Link(a, 3, pvp, v).rate(0.1), 0);
}

TEST(Evaporation, of_a_link_that_is_fed_is_thinned_by_fresh_fluid) {
  const Solution pvp{1200, 789, 0.1};
  Link link(4e-6, 1, pvp,
            {.diffusivity = ethanol_diffusivity, .saturation = ethanol_vapour});
  const double fresh = pi * 16e-12 * 1e-3, flow = 1e-9;
  EXPECT_NEAR((link.rate(0.2, Feed{.flow_rate = flow}) - link.rate(0.2)) * fresh / flow,
              -0.2, 1e-9);
}

/// A crooked chain whose links have lost half of their volume, with some state in all other columns.
template <class Term>
std::pair<std::vector<double>, double> rates_and_energy(Term& term, Evaporation& drying) {
  TermChain chain(6, {&drying, &term});
  for (std::size_t k = 0; k < 6; ++k) {
    const double i = static_cast<double>(k);
    chain.place(k, {1e-3 * i, 2e-4 * std::sin(i), 0}, {0.3 * i, 0.1 * std::cos(i), 0});
    chain.added(0)[k] = 0.5;
    for (std::size_t c = 1; c < chain.added_columns(); ++c)
      chain.added(c)[k] *= 1 + 0.1 * i; // conformations, which are 1
    for (std::size_t c = 1; c < chain.added_columns(); ++c)
      if (chain.added(c)[k] == 0) chain.added(c)[k] = 100 * i; // stresses
  }
  auto all = chain.rates();
  all.erase(all.begin(), all.begin() + 7 * 6); // what the fluid has added
  return {all, term.energy(chain.stage())};
}

template <template <class> class Law, template <class> class Term, class... Others>
void expect_thickened(const Others&... others) {
  const Thickening thickening{.solution = {1200, 789, 0.1}};
  const double g = 5e3, rate = 2500;
  const double fraction = thickening.solution.fraction_after(0.5);
  const double mu = thickening.viscosity_ratio(fraction),
               tau = thickening.relaxation_ratio(fraction);
  Evaporation evaporation(
      {1.21, nu, Vec3::Zero()}, thickening.solution,
      {.diffusivity = ethanol_diffusivity, .saturation = ethanol_vapour});
  Term<Law<DryingFluid>> drying(
      Law<DryingFluid>{DryingFluid(g, rate, thickening), others...});
  Term<Law<UniformFluid>> thick(Law<UniformFluid>{
      UniformFluid{.elastic_modulus = g * mu / tau, .relaxation = rate / tau}, others...});
  const auto [a, energy] = rates_and_energy(drying, evaporation);
  const auto [b, expected] = rates_and_energy(thick, evaporation);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a[i], b[i], 1e-12 * std::abs(b[i])) << i;
  EXPECT_NEAR(energy / expected, 1, 1e-12);
}

TEST(DryingFluid, is_a_fluid_with_the_viscosity_and_relaxation_time_of_its_fraction) {
  expect_thickened<MaxwellLaw, AxialStress>();
  expect_thickened<UpperConvected, TensorStress>();
  expect_thickened<Giesekus, TensorStress>(0.1);
  expect_thickened<FeneP, TensorStress>(100.0);
}

} // namespace
} // namespace ehdjet
