#include "ehdjet/dynamics/jet_dynamics.hpp"
#include "ehdjet/events/insertion.hpp"
#include "ehdjet/events/pump.hpp"
#include "ehdjet/forces/feed_momentum.hpp"
#include "ehdjet/forces/hencky_elasticity.hpp"
#include "ehdjet/forces/herschel_bulkley.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/forces/surface_tension.hpp"
#include "ehdjet/forces/tensor_stress.hpp"
#include "ehdjet/forces/viscous_stress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "support/jacobian.hpp"
#include "support/term_chain.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// Fluids of order one.
constexpr UniformFluid fluid{.elastic_modulus = 3, .relaxation = 1.5};
using Terms = std::vector<std::shared_ptr<ForceTerm>>;
struct Model {
  std::string name;
  std::function<Terms()> terms;
};
std::ostream& operator<<(std::ostream& os, const Model& m) {
  return os << m.name;
}

template <class Law>
std::shared_ptr<ForceTerm> tensor(const Law& law, std::size_t mode = 0) {
  typename TensorStress<Law>::Options options;
  options.mode = mode, options.nozzle_stretch = 1.1;
  return std::make_shared<TensorStress<Law>>(law, options);
}
const Model models[] = {
    {"maxwell", [] { return Terms{std::make_shared<Maxwell>(3, 2)}; }},
    {"upper_convected", [] { return Terms{tensor(UpperConvected<>{fluid})}; }},
    {"giesekus", [] { return Terms{tensor(Giesekus<>{.fluid = fluid, .mobility = 0.3})}; }},
    {"fene_p", [] { return Terms{tensor(FeneP<>{.fluid = fluid, .extensibility = 12})}; }},
    {"modes_and_solvent",
     [] {
       const UniformFluid slow{.elastic_modulus = 1, .relaxation = 0.2};
       return Terms{tensor(FeneP<>{.fluid = fluid, .extensibility = 12}, 1),
                    tensor(FeneP<>{.fluid = slow, .extensibility = 12}, 2),
                    std::make_shared<ViscousStress>(0.7)};
     }},
    {"maxwell_and_tensor",
     [] {
       return Terms{std::make_shared<Maxwell>(3, 2), tensor(UpperConvected<>{fluid})};
     }},
    {"kelvin_voigt",
     [] {
       return Terms{
           std::make_shared<HenckyElasticity>(HenckyElasticity::Options{
               .elastic_modulus = 3, .length_at_birth = 0.8, .nozzle_stretch = 1.2}),
           std::make_shared<ViscousStress>(0.7)};
     }},
    {"herschel_bulkley",
     [] {
       return Terms{
           std::make_shared<HerschelBulkley>(3, 2,
                                             HerschelBulkleyCurve{.consistency = 2,
                                                                  .flow_index = 0.6,
                                                                  .yield_stress = 1,
                                                                  .regularization = 0.8})};
     }},
};
class RheologyJacobian : public testing::TestWithParam<Model> {
protected:
  RheologyJacobian()
      : terms_(GetParam().terms()) {
    std::vector<ForceTerm*> all;
    for (const auto& term : terms_) all.push_back(term.get()), dynamics_.add(term);
    table_ = table_of(all);
  }
  [[nodiscard]] JetState bent(std::size_t n) const { return BentJet(n, table_).jet; }

  Terms terms_;
  JetDynamics dynamics_;
  std::shared_ptr<const BeadTable> table_;
};
INSTANTIATE_TEST_SUITE_P(All, RheologyJacobian, testing::ValuesIn(models),
                         [](const auto& model) { return model.param.name; });

constexpr Nozzle turning{
    .fluid_velocity = 0.7, .amplitude = 0.5, .angular_frequency = 2, .phase = 0.4};

TEST_P(RheologyJacobian, is_what_the_forces_answer) {
  for (const std::size_t n : {2U, 3U, 7U}) expect_same(dynamics_, bent(n), {});
}

TEST_P(RheologyJacobian, knows_held_ends) {
  dynamics_.hold({.first = true, .last = true});
  expect_same(dynamics_, bent(6), {{0, 5}, {0}});
}

TEST_P(RheologyJacobian, knows_embryos_and_landed_beads) {
  dynamics_.add(std::make_unique<LineSurfaceTension>(0.8));
  dynamics_.set_inflow(std::make_shared<EmbryoInflow>(
      turning, EmbryoInflow::Rule{.link_length = 0.1, .born = {}}));
  JetState jet = bent(8);
  jet.has_embryo = true;
  jet.landed = {{.bead = 4}, {.bead = 7}};
  dynamics_.bind(jet);
  dynamics_.prescribe(0.3, jet.y);
  expect_same(dynamics_, jet, {{0, 1, 4, 7}, {0, 1, 4, 7}});
}

TEST_P(RheologyJacobian, knows_the_link_that_a_pump_feeds) {
  dynamics_.add(std::make_unique<FeedMomentum>());
  dynamics_.set_inflow(std::make_shared<PumpInflow>(
      turning,
      PumpInflow::Rule{
          .link_length = 0.9,
          .feed = {.flow_rate = 0.8, .density = 1.3, .section = 0.6, .stress = 0.4},
          .charge_density = 1}));
  JetState jet = bent(5);
  dynamics_.bind(jet);
  dynamics_.prescribe(0.3, jet.y);
  expect_same(dynamics_, jet, {{0}, {0}});
}

// df/dt at constant y is the part of it that the nozzle's motion brings about.
TEST_P(RheologyJacobian, knows_how_the_nozzle_moves) {
  dynamics_.set_inflow(std::make_shared<EmbryoInflow>(
      turning, EmbryoInflow::Rule{.link_length = 0.1, .born = {}}));
  for (const bool embryo : {false, true}) {
    JetState jet = bent(5);
    jet.has_embryo = embryo;
    dynamics_.bind(jet);
    const double t = 0.3, h = 1e-5;
    std::vector<double> later(jet.y.size()), earlier(later), rate(later);
    dynamics_.prescribe(t + h, jet.y), dynamics_.evaluate(t + h, jet.y, later);
    dynamics_.prescribe(t - h, jet.y), dynamics_.evaluate(t - h, jet.y, earlier);
    dynamics_.prescribe(t, jet.y);
    dynamics_.stiff_part()->linearize(t, jet.y);
    dynamics_.stiff_part()->add_time_derivative(2, rate);
    double largest = 0;
    for (std::size_t i = 0; i < rate.size(); ++i) {
      EXPECT_NEAR(rate[i], (later[i] - earlier[i]) / h, 1e-7) << i;
      largest = std::max(largest, std::abs(rate[i]));
    }
    EXPECT_GT(largest, 0.3);
  }
}

TEST_P(RheologyJacobian, has_no_memory_of_an_earlier_chain) {
  for (const std::size_t n : {7U, 4U, 9U}) expect_same(dynamics_, bent(n), {});
}

// A uniform chain at rest: K = 3 G V/l^2 of a tensor, relaxation 1/lambda, damping 4 eta V/(m l^2).
TEST(RheologyModes, are_those_of_a_uniform_chain) {
  constexpr std::size_t n = 9;
  const double l = 0.2, volume = 0.01, mass = 0.03, modulus = 5, rate = 0.05, eta = 0.02;
  const UniformFluid slow{.elastic_modulus = modulus, .relaxation = rate};
  for (const auto& term :
       {tensor(UpperConvected<>{slow}), tensor(Giesekus<>{.fluid = slow, .mobility = 0.2}),
        tensor(FeneP<>{.fluid = slow, .extensibility = 1e9})})
    for (const bool solvent : {false, true}) {
      JetDynamics dynamics;
      dynamics.add(term);
      if (solvent) dynamics.add(std::make_shared<ViscousStress>(eta));
      ForceTerm* const all[]{term.get()};
      JetState jet = blank_jet(table_of(all), n);
      jet.mass.assign(n, mass), jet.volume.assign(n, volume);
      for (std::size_t k = 0; k < n; ++k) {
        jet.columns().position().set(k, {l * static_cast<double>(k), 0, 0});
        for (std::size_t c = 6; c < 8; ++c)
          jet.columns().column(c)[k] = term->columns()[0].unit == "1" ? 1 : 0;
      }
      dynamics.bind(jet);
      dynamics.stiff_part()->linearize(0, jet.y);
      const auto modes = dynamics.stiff_part()->fastest_modes();
      const double decay = solvent ? 4 * eta * volume / (mass * l * l) : rate;
      EXPECT_NEAR(modes[0].real(), -decay, 1e-6 * decay);
      EXPECT_NEAR(std::abs(modes[1])
                      / (2 * std::sqrt(3 * modulus * volume / (mass * l * l))),
                  1, 1e-7);
    }
}

} // namespace
} // namespace ehdjet
