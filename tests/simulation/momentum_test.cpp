#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

#include "support/scenes.hpp"

namespace ehdjet {
namespace {

using namespace test;

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
