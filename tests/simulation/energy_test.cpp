#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/energy_budget.hpp"

namespace ehdjet {
namespace {

using namespace test;

// d/dt (stored energy) = - dissipation + power of the paper's surface tension
TEST(Energy, of_a_chain_is_stored_dissipated_or_the_work_of_surface_tension) {
  for (const std::string kind : {"free", "held"}) {
    for (const auto form : {SurfaceTensionForm::paper, SurfaceTensionForm::line}) {
      GoldenChain golden(kind);
      golden.scene.config.surface_tension->form = form;
      BudgetedChain chain(golden.scene);
      const ChainBudget start = chain.budget_at(0);
      for (std::size_t i = 1; i < golden.times(); ++i) {
        const ChainBudget b = chain.budget_at(golden.time(i));
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
    BudgetedChain chain(golden.scene);
    const ChainBudget b = chain.budget_at(2e-4);
    const double digits = 2e-12; // of numbers printed with 13
    EXPECT_NEAR(b.kinetic / erg / row.kinetic, 1, digits) << row.kind;
    EXPECT_NEAR(b.coulomb / erg / row.coulomb, 1, digits) << row.kind;
    EXPECT_NEAR(b.field / erg / row.field, 1, digits) << row.kind;
    EXPECT_NEAR(b.elastic / erg / row.elastic, 1, digits) << row.kind;
    EXPECT_NEAR(b.dissipated / erg / row.dissipated, 1, 10 * digits) << row.kind;
    EXPECT_NEAR(b.work / erg / row.work, 1, 100 * digits) << row.kind;
  }
  const GoldenChain golden("free");
  const ChainBudget start = BudgetedChain(golden.scene).budget_at(0);
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
