#include "ehdjet/core/error.hpp"
#include "ehdjet/forces/hencky_elasticity.hpp"
#include "ehdjet/forces/herschel_bulkley.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/forces/tensor_stress.hpp"
#include "ehdjet/forces/viscous_stress.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "support/chain.hpp"
#include "support/march.hpp"
#include "support/term_chain.hpp"

namespace ehdjet {
namespace {

using namespace test;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double G = 5e3, lambda = 4e-4, l0 = 2e-4; // [Pa], [s], [m]
constexpr UniformFluid fluid{.elastic_modulus = G, .relaxation = 1 / lambda};
const Vec3 direction{1. / 3, 2. / 3, -2. / 3};

using Terms = std::vector<std::unique_ptr<ForceTerm>>;
template <class Law>
Terms one(const Law& law) {
  Terms terms;
  terms.push_back(std::make_unique<TensorStress<Law>>(law));
  return terms;
}
Terms maxwell() {
  Terms terms;
  terms.push_back(std::make_unique<Maxwell>(G, G * lambda));
  return terms;
}
Terms upper_convected() {
  return one(UpperConvected<>{fluid});
}
Terms giesekus(double mobility) {
  return one(Giesekus<>{.fluid = fluid, .mobility = mobility});
}
Terms fene_p(double extensibility) {
  return one(FeneP<>{.fluid = fluid, .extensibility = extensibility});
}

std::vector<ForceTerm*> pointers(const Terms& terms) {
  std::vector<ForceTerm*> all;
  for (const auto& term : terms) all.push_back(term.get());
  return all;
}

/// One link that grows as l0 exp(e t) while its upstream end moves along.
class StretchedLink {
public:
  StretchedLink(const Terms& terms, double strain_rate)
      : chain_(2, pointers(terms))
      , e_(strain_rate) {}

  /// Stress at time t after a start at rest [Pa].
  double stress(double t, int steps = 2000) {
    const std::size_t columns = chain_.added_columns();
    std::vector<double> y;
    for (std::size_t c = 0; c < columns; ++c) y.push_back(chain_.added(c)[1]);
    FunctionSystem system(
        [&](double time, std::span<const double> state, std::span<double> rate) {
          set(time, state);
          const auto all = chain_.rates();
          for (std::size_t c = 0; c < columns; ++c) {
            EXPECT_EQ(chain_.rate(all, c, 0), 0);
            rate[c] = chain_.rate(all, c, 1);
          }
        });
    if (columns > 0) y = march("dop853", system, y, 0, t, steps);
    set(t, y);
    return chain_.stress(1);
  }

private:
  void set(double time, std::span<const double> state) {
    const Vec3 drift(0.3, -0.2, 0.1);
    const double l = l0 * std::exp(e_ * time);
    chain_.place(0, l0 * drift * time, l0 * drift);
    chain_.place(1, l0 * drift * time + l * direction, l0 * drift + e_ * l * direction);
    for (std::size_t c = 0; c < state.size(); ++c) chain_.added(c)[1] = state[c];
  }
  TermChain chain_;
  double e_;
};

struct StartUp {
  double De, s;                                                       // e lambda, t/lambda
  double maxwell, upper_convected, giesekus_15, giesekus_100, fene_p; // N1/G
};

// Computed independently.
TEST(Rheology, start_up_at_a_constant_strain_rate_is_that_of_the_table) {
  const StartUp rows[] = {
      {0.3, 1, 0.1896361676, 0.6623972095, 0.6613182222, 0.6553465684, 0.6630860119},
      {1, 1, 0.6321205588, 3.868896015, 3.8136154567, 3.5354281783, 3.9380839461},
      {1, 3, 0.9502129316, 38.66983447, 27.0557490173, 10.7560961445, 39.4767640407},
      {2, 1, 1.264241118, 26.08085785, 23.8071876392, 16.1222492028, 31.5855880592}};
  double worst = 0;
  for (const StartUp& row : rows) {
    const auto expect = [&](const Terms& terms, double published, const char* name) {
      const double n1 = StretchedLink(terms, row.De / lambda).stress(row.s * lambda) / G;
      EXPECT_NEAR(n1 / published, 1, 5e-10) << name << " De " << row.De << " s " << row.s;
      worst = std::max(worst, std::abs(n1 / published - 1));
    };
    expect(maxwell(), row.maxwell, "Maxwell");
    expect(upper_convected(), row.upper_convected, "UCM");
    expect(giesekus(0.015), row.giesekus_15, "Giesekus 0.015");
    expect(giesekus(0.1), row.giesekus_100, "Giesekus 0.1");
    expect(fene_p(100), row.fene_p, "FENE-P");
  }
  RecordProperty("worst_relative", std::to_string(worst));
}

TEST(Rheology, upper_convected_start_up_has_a_closed_form) {
  for (const double De : {-3., -0.4, 0.2, 0.45, 1.5, 4.})
    for (const double s : {0.1, 1., 2.5}) {
      const double a = 1 - 2 * De, b = 1 + De;
      const double exact = -2 * De / a * std::expm1(-a * s) - De / b * std::expm1(-b * s);
      const double n1 =
          StretchedLink(upper_convected(), De / lambda).stress(s * lambda) / G;
      EXPECT_NEAR(n1 / exact, 1, 1e-11) << De << " " << s;
    }
}

TEST(Rheology, stretching_pulls_and_compression_pushes) {
  for (const auto& terms : {upper_convected(), giesekus(0.3), fene_p(20), fene_p(500)})
    for (const double De : {1e-3, 0.3, 0.5, 2., 10.})
      for (const double s : {1e-3, 0.5, 2.}) {
        if (De * s > 6) continue;
        EXPECT_GT(StretchedLink(terms, De / lambda).stress(s * lambda), 0)
            << De << " " << s;
        EXPECT_LT(StretchedLink(terms, -De / lambda).stress(s * lambda), 0)
            << De << " " << s;
      }
}

// Slow stretching: N1 = 3 mu e, Trouton's ratio, which the scalar law misses.
TEST(Rheology, slow_stretching_has_the_viscosity_of_trouton) {
  const double De = 1e-6;
  for (const auto& terms : {upper_convected(), giesekus(0.3), fene_p(100)})
    EXPECT_NEAR(StretchedLink(terms, De / lambda).stress(40 * lambda) / (3 * G * De), 1,
                1e-5);
  EXPECT_NEAR(StretchedLink(maxwell(), De / lambda).stress(40 * lambda) / (G * De), 1,
              1e-5);
}

TEST(Rheology, giesekus_without_mobility_is_upper_convected) {
  for (const double De : {-2., 0.3, 2.})
    EXPECT_EQ(StretchedLink(giesekus(0), De / lambda).stress(lambda, 50),
              StretchedLink(upper_convected(), De / lambda).stress(lambda, 50));
}

TEST(Rheology, springs_without_end_are_upper_convected) {
  for (const double De : {-2., 0.3, 2.})
    EXPECT_NEAR(StretchedLink(fene_p(1e9), De / lambda).stress(lambda, 200)
                    / StretchedLink(upper_convected(), De / lambda).stress(lambda, 200),
                1, 1e-6);
}

TEST(Rheology, modes_of_equal_times_are_one_mode) {
  Terms modes;
  for (const std::size_t i : {1U, 2U, 3U}) {
    const UniformFluid part{.elastic_modulus = i == 1 ? G / 2 : G / 4,
                            .relaxation = 1 / lambda};
    modes.push_back(
        std::make_unique<TensorStress<FeneP<>>>(FeneP<>{.fluid = part, .extensibility = 50},
                                                TensorStress<FeneP<>>::Options{.mode = i}));
  }
  for (const double De : {0.3, 2.})
    EXPECT_NEAR(StretchedLink(modes, De / lambda).stress(lambda, 100)
                    / StretchedLink(fene_p(50), De / lambda).stress(lambda, 100),
                1, 1e-13);
}

TEST(Rheology, a_solvent_adds_three_times_its_viscosity) {
  Terms terms = upper_convected();
  const double solvent = 0.7;
  terms.push_back(std::make_unique<ViscousStress>(3 * solvent));
  const double e = 0.8 / lambda;
  EXPECT_NEAR(StretchedLink(terms, e).stress(lambda)
                  - StretchedLink(upper_convected(), e).stress(lambda),
              3 * solvent * e, 1e-9 * 3 * solvent * e);
}

// ---- Herschel-Bulkley -------------------------------------------------------------------------

constexpr HerschelBulkleyCurve curve{
    .consistency = 20, .flow_index = 0.5, .yield_stress = 100, .regularization = 0.01};
Terms herschel_bulkley(const HerschelBulkleyCurve& c) {
  Terms terms;
  terms.push_back(std::make_unique<HerschelBulkley>(G, G * lambda, c));
  return terms;
}

TEST(HerschelBulkleyCurve, has_the_published_values_and_is_odd) {
  EXPECT_NEAR(curve.stress(1), 20.995017, 5e-7);
  EXPECT_NEAR(curve.stress(1e3), 732.45099, 5e-6);
  EXPECT_NEAR(curve.stress(1e5), 6424.5553, 5e-5);
  for (const double e : {1e-300, 1e-3, 1., 1e3, 1e9}) {
    EXPECT_EQ(curve.stress(-e), -curve.stress(e)) << e;
    EXPECT_EQ(curve.slope(-e, 0), curve.slope(e, 0)) << e;
  }
  EXPECT_EQ(curve.stress(0), 0);
  EXPECT_TRUE(std::isfinite(curve.slope(0, 1e-3)));
  for (const double e : {-1e4, -3., 0.1, 200.}) {
    const double h = 1e-4 * std::abs(e);
    EXPECT_NEAR((curve.stress(e + h) - curve.stress(e - h)) / (2 * h) / curve.slope(e, 0),
                1, 1e-7)
        << e;
  }
}

TEST(Rheology, a_herschel_bulkley_fluid_goes_to_its_curve) {
  for (const double e : {1., 1e3, 1e5, -1., -1e3}) {
    const double t = std::abs(e) > 1e4 ? 1e-5 : 30 * lambda;
    const double exact = curve.stress(e) * -std::expm1(-t / lambda);
    EXPECT_NEAR(StretchedLink(herschel_bulkley(curve), e).stress(t, 4000) / exact, 1, 1e-9)
        << e;
  }
}

TEST(Rheology, a_linear_flow_curve_is_a_maxwell_fluid) {
  const HerschelBulkleyCurve newton{.consistency = G * lambda};
  for (const double De : {-1., 0.2, 3.})
    EXPECT_NEAR(StretchedLink(herschel_bulkley(newton), De / lambda).stress(lambda)
                    / StretchedLink(maxwell(), De / lambda).stress(lambda),
                1, 1e-12);
}

// ---- all of them ------------------------------------------------------------------------------

struct Model {
  std::string name;
  std::function<Terms()> terms;
};
std::ostream& operator<<(std::ostream& os, const Model& m) {
  return os << m.name;
}
const Model models[] = {
    {"maxwell", maxwell},
    {"upper_convected", upper_convected},
    {"giesekus", [] { return giesekus(0.2); }},
    {"fene_p", [] { return fene_p(60); }},
    {"oldroyd_b",
     [] {
       Terms terms = upper_convected();
       terms.push_back(std::make_unique<ViscousStress>(2.0));
       return terms;
     }},
    {"kelvin_voigt",
     [] {
       Terms terms;
       terms.push_back(std::make_unique<HenckyElasticity>(
           HenckyElasticity::Options{.elastic_modulus = G, .length_at_birth = l0}));
       terms.push_back(std::make_unique<ViscousStress>(2.0));
       return terms;
     }},
    {"herschel_bulkley", [] { return herschel_bulkley(curve); }},
};
class EachModel : public testing::TestWithParam<Model> {};
INSTANTIATE_TEST_SUITE_P(Rheology, EachModel, testing::ValuesIn(models),
                         [](const auto& model) { return model.param.name; });

/// Six beads on a curve in motion, all links different.
TermChain curved(const Terms& terms) {
  TermChain chain(6, pointers(terms));
  for (std::size_t k = 0; k < 6; ++k) {
    const double s = static_cast<double>(k);
    chain.place(k, l0 * Vec3(s, std::sin(s), std::cos(2 * s)),
                Vec3(std::cos(s), std::sin(3 * s), s * s));
    chain.jet.volume[k] = 1e-12 * (1 + s);
    for (std::size_t c = 0; c < chain.added_columns(); ++c) {
      const double scale =
          chain.jet.table->integrated()[BeadTable::basic_integrated + c].error_scale;
      chain.added(c)[k] += scale * (0.7 * s - 0.5 * static_cast<double>(c));
    }
  }
  return chain;
}

TEST_P(EachModel, pulls_both_ends_of_a_link_with_its_section_times_the_stress) {
  const Terms terms = GetParam().terms();
  for (const bool embryo : {false, true}) {
    TermChain chain = curved(terms);
    chain.jet.has_embryo = embryo;
    const auto f = chain.force();
    EXPECT_GT(f[0].norm(), 0);
    EXPECT_LE(sum(f).norm(), 20 * epsilon * sum_of_norms(f));
    if (embryo) {
      EXPECT_EQ(f[1], Vec3::Zero());
    }
    const Links links = chain.stage().links();
    for (std::size_t k = links.first; k < 5; ++k) {
      const auto pull = [&](std::size_t j) -> Vec3 {
        const double l = links.length[j];
        return chain.jet.volume[j] / l * chain.stress(j) * links.vector(j) / l;
      };
      EXPECT_LE((f[k] - (pull(k + 1) - pull(k))).norm(), 1e-13 * sum_of_norms(f)) << k;
    }
  }
}

TEST_P(EachModel, at_rest_does_not_notice_a_rigid_motion) {
  const Terms terms = GetParam().terms();
  TermChain chain(6, pointers(terms));
  const Vec3 spin(40, -70, 90), drift(3, -2, 1);
  for (std::size_t k = 0; k < 6; ++k) {
    const double s = static_cast<double>(k);
    const Vec3 r = l0 * Vec3(s, std::sin(s), std::cos(2 * s));
    chain.place(k, r, drift + spin.cross(r));
    if (chain.jet.table->find_carried("reference_length") && k > 0)
      chain.jet.declared[0][k] = link_length(chain.jet, k);
  }
  const auto rates = chain.rates();
  for (std::size_t c = 0; c < chain.added_columns(); ++c)
    for (std::size_t k = 1; k < 6; ++k) {
      const double scale =
          chain.jet.table->integrated()[BeadTable::basic_integrated + c].error_scale;
      // The square root of round-off in the strain rate is what a power law of index 1/2 sees.
      const double bound = GetParam().name == "herschel_bulkley" ? 1e-3 : 1e-9;
      EXPECT_NEAR(chain.rate(rates, c, k), 0, bound * scale / lambda) << c << " " << k;
    }
}

TEST_P(EachModel, takes_a_landed_bead_as_at_rest) {
  const Terms terms = GetParam().terms();
  TermChain moving = curved(terms), landed = curved(terms), stopped = curved(terms);
  landed.jet.landed = {{.bead = 3, .time = 0, .radius = 0}};
  stopped.jet.columns().velocity().set(3, Vec3::Zero());
  const auto a = landed.rates(), b = stopped.rates(), c = moving.rates();
  double change = 0;
  for (std::size_t i = 0; i < landed.added_columns(); ++i) {
    EXPECT_NEAR(landed.rate(a, i, 4), stopped.rate(b, i, 4),
                1e-12 * std::abs(stopped.rate(b, i, 4)));
    EXPECT_EQ(landed.rate(a, i, 5), moving.rate(c, i, 5));
    change += std::abs(moving.rate(c, i, 4) / landed.rate(a, i, 4) - 1);
  }
  if (landed.added_columns() > 0) {
    EXPECT_GT(change, 0.01);
  }
  const auto f = landed.force(), g = stopped.force();
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_LE((f[k] - g[k]).norm(), 1e-13 * sum_of_norms(g)) << k;
}

TEST_P(EachModel, survives_compression) {
  const Terms terms = GetParam().terms();
  for (const double De : {-0.1, -2., -20.})
    EXPECT_TRUE(std::isfinite(StretchedLink(terms, De / lambda).stress(0.1 * lambda)));
}

// ---- the nozzle of a pump ---------------------------------------------------------------------

TEST(Rheology, a_nozzle_stress_is_a_stretch_of_all_modes) {
  const UpperConvected<> ucm[] = {{fluid}, {{.elastic_modulus = 2e3, .relaxation = 1}}};
  for (const double n1 : {-4e3, -10., 0., 1e-3, 50., 1e6}) {
    const double stretch = stretch_of_stress<UpperConvected<>>(ucm, n1);
    EXPECT_NEAR((G + 2e3) * (stretch * stretch - 1 / stretch), n1,
                1e-12 * (std::abs(n1) + G));
  }
  const FeneP<> fene[] = {{.fluid = fluid, .extensibility = 9}};
  for (const double n1 : {-4e4, 50., 1e6}) {
    const double stretch = stretch_of_stress<FeneP<>>(fene, n1);
    EXPECT_NEAR(fene[0].stress_difference(1, fene[0].of_stretch(1, stretch)) / n1, 1, 1e-9);
  }
  EXPECT_EQ(stretch_of_stress<FeneP<>>(fene, 0), 1);
}

TEST(Rheology, springs_beyond_their_length_are_no_number) {
  const FeneP<> law{.fluid = fluid, .extensibility = 9};
  EXPECT_TRUE(std::isnan(law.rate(1, 0, {.zz = 8, .rr = 0.6}).zz));
  EXPECT_TRUE(std::isnan(law.stress_difference(1, {.zz = 9.1, .rr = 0.6})));
}

TEST(Rheology, impossible_fluids_are_contract_violations) {
  EXPECT_THROW(one(UpperConvected<>{}), ContractViolation);
  EXPECT_THROW(ViscousStress(0), ContractViolation);
  EXPECT_THROW(HenckyElasticity({.elastic_modulus = 0}), ContractViolation);
  EXPECT_THROW(HerschelBulkley(G, 0, curve), ContractViolation);
  EXPECT_THROW(HerschelBulkley(G, 1, {.consistency = -1}), ContractViolation);
}

} // namespace
} // namespace ehdjet
