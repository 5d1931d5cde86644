#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "support/refined.hpp"

namespace ehdjet {
namespace {

using namespace test;

/// The mean distance of landings from the axis of the array, of each jet.
class MeanLanding final : public ArrayObserver {
public:
  MeanLanding(std::size_t jets, double from)
      : from_(from)
      , sum_(jets, 0.0)
      , count_(jets, 0.0) {}
  void deposit(std::size_t j, const DepositedBead& bead) override {
    if (bead.time < from_) return;
    sum_[j] += std::hypot(bead.bead.position.y(), bead.bead.position.z());
    ++count_[j];
  }
  [[nodiscard]] double of(std::size_t j) const { return sum_[j] / count_[j]; }

private:
  double from_;
  std::vector<double> sum_, count_;
};

// Independent figures: outer jets 14 to 16 cm off the axis (alone: 4.46 cm), a path of 162 cm in the
// middle.
TEST(ArraySlow, of_nine_jets_drives_the_outer_ones_out_and_squeezes_the_middle_one) {
  Scene scene = case_one("dormand-prince", 1e-5);
  scene.config.array = ArrayConfig{.rows = 3, .columns = 3, .spacing = 1 * cm};
  const auto simulation = build_array_simulation(scene);
  const auto landings = std::make_shared<MeanLanding>(9, 13e-3);
  simulation->add(landings);
  simulation->run_until(16e-3);
  EXPECT_NEAR(path_length_of(simulation->jet(4)), 162 * cm, 4 * cm);
  EXPECT_LT(landings->of(4), 5 * cm);
  double sum = 0;
  for (const std::size_t j : {0U, 1U, 2U, 3U, 5U, 6U, 7U, 8U}) {
    EXPECT_GT(landings->of(j), 12 * cm) << j;
    EXPECT_LT(landings->of(j), 17 * cm) << j;
    EXPECT_GT(path_length_of(simulation->jet(j)), 280 * cm) << j;
    sum += landings->of(j) / 8;
  }
  EXPECT_NEAR(sum, 15 * cm, 1.2 * cm);
}

} // namespace
} // namespace ehdjet
