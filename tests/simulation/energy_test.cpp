#include "ehdjet/forces/surface_tension.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/chain.hpp"
#include "support/march.hpp"
#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// Everything the energy of a golden chain can be, and what has left or entered it [J].
struct Budget {
  double kinetic = 0, coulomb = 0, field = 0, elastic = 0, line_tension = 0;
  double dissipated = 0, work = 0; // of the fluid; of the paper's surface tension

  [[nodiscard]] double stored() const {
    return kinetic + coulomb + field + elastic + line_tension;
  }
};

/// The equations of motion, with two more unknowns behind them: the dissipated energy
/// sum V sigma^2/mu and the work sum f.v of the paper's surface tension.
class BudgetedChain final : public OdeSystem {
public:
  BudgetedChain(const GoldenChain& golden, SurfaceTensionForm form)
      : golden_(golden)
      , line_(form == SurfaceTensionForm::line)
      , chain_(golden.size())
      , paper_(pvp::surface_tension) {
    Scene scene = golden.scene;
    scene.config.surface_tension->form = form;
    dynamics_ = build_dynamics(scene);
    jet_ = initial_jet(scene);
    dynamics_->bind(jet_);
    chain_.mass = jet_.mass, chain_.charge = jet_.charge, chain_.volume = jet_.volume;
  }

  void evaluate(double t, std::span<double> y, std::span<double> rate) override {
    const std::size_t n = jet_.y.size();
    dynamics_->evaluate(t, y.first(n), rate.first(n));
    std::ranges::copy(y.first(n), chain_.flat.begin());
    double dissipation = 0, power = 0;
    for (std::size_t k = 1; k < jet_.beads(); ++k) {
      const double sigma = chain_.columns().stress()[k];
      dissipation += jet_.volume[k] * sigma * sigma / pvp::viscosity;
    }
    if (!line_) {
      const std::vector<Vec3> f = chain_.force(paper_);
      for (std::size_t k = 0; k < jet_.beads(); ++k)
        power += f[k].dot(chain_.columns().velocity()[k]);
    }
    rate[n] = dissipation, rate[n + 1] = power;
  }

  [[nodiscard]] Budget budget_at(double t) {
    std::vector<double> y = jet_.y;
    y.resize(y.size() + 2, 0.0);
    ErrorScale scale{.rtol = 1e-12, .column_scale = std::vector<double>(y.size(), 1e-4)};
    for (std::size_t i = 0; i < jet_.y.size(); ++i) { // metres, metres per second, pascals
      const std::size_t column = i / jet_.beads();
      scale.column_scale[i] = column < 3   ? pvp::link_length
                              : column < 6 ? 1
                                           : 0.1 * pvp::modulus;
    }
    scale.column_scale[jet_.y.size()] = scale.column_scale[jet_.y.size() + 1] = 0.1 * erg;
    if (t > 0) y = march_adaptively("dop853", *this, y, 0, t, scale);
    return measure(y);
  }

private:
  Budget measure(const std::vector<double>& y) {
    const JetColumns<const double> c{std::span(y).first(jet_.y.size()), jet_.beads()};
    const auto r = c.position(), v = c.velocity();
    const double field = *golden_.scene.config.field->strength;
    const bool held = golden_.scene.config.chain->fixed == FixedEnds::first;
    Budget b;
    for (std::size_t k = 0; k < jet_.beads(); ++k) {
      if (k > 0 || !held) {
        b.kinetic += jet_.mass[k] * v[k].squaredNorm() / 2;
        b.field -= jet_.charge[k] * field * r[k].x();
      }
      for (std::size_t j = 0; j < k; ++j)
        b.coulomb +=
            constants::coulomb * jet_.charge[k] * jet_.charge[j] / (r[k] - r[j]).norm();
      if (k == 0) continue;
      const double sigma = c.stress()[k], length = (r[k] - r[k - 1]).norm();
      b.elastic += jet_.volume[k] * sigma * sigma / (2 * pvp::modulus);
      if (line_) // the lateral surface 2 pi a l
        b.line_tension += 2 * pvp::surface_tension
                          * std::sqrt(std::numbers::pi * jet_.volume[k] * length);
    }
    b.dissipated = y[jet_.y.size()], b.work = y[jet_.y.size() + 1];
    return b;
  }

  const GoldenChain& golden_;
  bool line_;
  Chain chain_;
  BendingSurfaceTension paper_;
  std::unique_ptr<JetDynamics> dynamics_;
  JetState jet_;
};

// d/dt (stored energy) = - dissipation + power of the paper's surface tension
TEST(Energy, of_a_chain_is_stored_dissipated_or_the_work_of_surface_tension) {
  for (const std::string kind : {"free", "held"}) {
    for (const auto form : {SurfaceTensionForm::paper, SurfaceTensionForm::line}) {
      const GoldenChain golden(kind);
      BudgetedChain chain(golden, form);
      const Budget start = chain.budget_at(0);
      for (std::size_t i = 1; i < golden.times(); ++i) {
        const Budget b = chain.budget_at(golden.time(i));
        const double residual = b.stored() - start.stored() + b.dissipated - b.work;
        EXPECT_LE(std::abs(residual), 1e-12 * start.coulomb)
            << kind << " " << golden.time(i);
        EXPECT_GT(b.dissipated, 0) << kind;
      }
    }
  }
}

TEST(Energy, has_the_published_parts) {
  struct Row {
    std::string kind;
    double kinetic, coulomb, field, elastic, dissipated, work;
  };
  const Row rows[] = {
      {"free", 3.232986979964, 2.318300608448, -0.1742397315794, 0.3487755145694,
       0.1086085046340, -0.004041428718567},
      {"held", 2.976400047240, 2.547721046573, -0.2113627942731, 0.4106961113568,
       0.1068253076179, -0.008193586239860},
  };
  for (const Row& row : rows) {
    const GoldenChain golden(row.kind);
    BudgetedChain chain(golden, SurfaceTensionForm::paper);
    const Budget b = chain.budget_at(2e-4);
    const double digits = 2e-12; // of numbers printed with 13
    EXPECT_NEAR(b.kinetic / erg / row.kinetic, 1, digits) << row.kind;
    EXPECT_NEAR(b.coulomb / erg / row.coulomb, 1, digits) << row.kind;
    EXPECT_NEAR(b.field / erg / row.field, 1, digits) << row.kind;
    EXPECT_NEAR(b.elastic / erg / row.elastic, 1, digits) << row.kind;
    EXPECT_NEAR(b.dissipated / erg / row.dissipated, 1, 10 * digits) << row.kind;
    EXPECT_NEAR(b.work / erg / row.work, 1, 100 * digits) << row.kind;
  }
  const GoldenChain golden("free");
  const Budget start = BudgetedChain(golden, SurfaceTensionForm::paper).budget_at(0);
  EXPECT_NEAR(start.stored() / erg / 5.838473304754611, 1, 1e-14);
  EXPECT_NEAR(start.coulomb / erg / 6.009651446934868, 1, 1e-14);
  EXPECT_NEAR(start.field / erg / -0.1711781421802560, 1, 1e-14);
}

/// sum m v of a free chain of unlike beads after 2e-4 s, and sum m |v|.
std::pair<Vec3, double> momentum(std::optional<SurfaceTensionForm> form, bool driven) {
  GoldenChain golden("free");
  Scene& scene = golden.scene;
  scene.config.surface_tension.reset();
  if (form)
    scene.config.surface_tension =
        SurfaceTensionConfig{.coefficient = pvp::surface_tension, .form = *form};
  for (std::size_t k = 0; k < golden.size(); ++k) {
    scene.chain.mass[k] *= 1 + 0.3 * std::sin(static_cast<double>(k));
    scene.chain.charge[k] *= 1 + 0.3 * std::cos(static_cast<double>(k));
  }
  if (driven) scene.config.gravity = GravityConfig{pvp::gravity};
  if (!driven) scene.config.field.reset();
  integrate(scene, "dormand-prince", 1e-9);
  const auto simulation = run(scene, 2e-4);
  const JetState& jet = simulation->jet();
  Vec3 total = Vec3::Zero();
  double size = 0;
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    total += jet.mass[k] * jet.columns().velocity()[k];
    size += jet.mass[k] * jet.columns().velocity()[k].norm();
  }
  return {total, size};
}

// Whatever the error of the steps: every stage's forces sum to zero.
TEST(Momentum,
     of_a_free_chain_is_kept_to_round_off_unless_the_papers_surface_tension_acts) {
  const double round_off = 1e-14; // some hundred steps
  const auto [without, size] = momentum({}, false);
  EXPECT_LE(without.norm(), round_off * size);
  const auto [line, line_size] = momentum(SurfaceTensionForm::line, false);
  EXPECT_LE(line.norm(), round_off * line_size);
  const auto [paper, paper_size] = momentum(SurfaceTensionForm::paper, false);
  EXPECT_GT(paper.norm(), 1e-5 * paper_size);
}

TEST(Momentum, grows_by_the_force_of_field_and_gravity) {
  const auto [line, size] = momentum(SurfaceTensionForm::line, true);
  const GoldenChain golden("free");
  double force = 0;
  for (std::size_t k = 0; k < golden.size(); ++k) {
    const double s = static_cast<double>(k);
    force += pvp::charge * (1 + 0.3 * std::cos(s)) * *golden.scene.config.field->strength
             + pvp::mass * (1 + 0.3 * std::sin(s)) * pvp::gravity;
  }
  // The masses of the file are those of the fluid to its 16 digits.
  EXPECT_LE((line - Vec3(force * 2e-4, 0, 0)).norm(), 1e-14 * size);
}

} // namespace
} // namespace ehdjet
