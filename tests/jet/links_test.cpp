#include "ehdjet/jet/links.hpp"
#include "ehdjet/jet/stage.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace ehdjet {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
const Vec3 direction{1. / 3, 2. / 3, -2. / 3};

/// Bead k at distance k^2 from bead 0, so that link k has length 2k - 1.
struct Line {
  explicit Line(std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 r = direction * static_cast<double>(k * k);
      x.push_back(r.x()), y.push_back(r.y()), z.push_back(r.z());
    }
  }
  [[nodiscard]] ConstVec3View r() const { return {x, y, z}; }
  std::vector<double> x, y, z;
};

TEST(Links, point_downstream_from_the_upstream_neighbour) {
  const Line line(7);
  Links links;
  links.compute(line.r(), 1);
  ASSERT_EQ(links.length.size(), 8U);
  for (std::size_t k = 1; k < 7; ++k) {
    const double length = 2.0 * static_cast<double>(k) - 1;
    EXPECT_NEAR(links.length[k], length, 36 * 4 * epsilon) << k; // of positions up to 36
    EXPECT_NEAR(links.dx[k], length / 3, 36 * epsilon) << k;
    EXPECT_NEAR(links.dy[k], 2 * length / 3, 36 * epsilon) << k;
    EXPECT_NEAR(links.dz[k], -2 * length / 3, 36 * epsilon) << k;
  }
}

TEST(Links, the_bead_behind_an_embryo_is_linked_to_bead_zero) {
  const Line line(7);
  Links links;
  links.compute(line.r(), 2);
  EXPECT_NEAR(links.length[2], 4, 8 * epsilon);
  EXPECT_NEAR(links.dy[2], 8. / 3, 8 * epsilon);
  EXPECT_NEAR(links.length[3], 5, 16 * epsilon);
}

TEST(Links, entries_outside_the_chain_have_no_extent_also_when_the_chain_changes_its_size) {
  Links links;
  for (const std::size_t n : {9U, 5U, 7U})
    for (const std::size_t first : {1U, 2U, 1U}) {
      const Line line(n);
      links.compute(line.r(), first);
      for (std::size_t k = 0; k < first; ++k) {
        EXPECT_EQ(links.dx[k], 0);
        EXPECT_EQ(links.length[k], 1);
      }
      ASSERT_EQ(links.length.size(), n + 1);
      EXPECT_EQ(links.dx[n], 0);
      EXPECT_EQ(links.dy[n], 0);
      EXPECT_EQ(links.dz[n], 0);
      EXPECT_EQ(links.length[n], 1);
      EXPECT_EQ(links.last, n - 1);
    }
}

TEST(Stage, links_follow_the_positions_after_invalidation) {
  Line line(3);
  std::vector<double> flat(18, 0.0), ones(3, 1.0);
  const auto place = [&] {
    std::ranges::copy(line.x, flat.begin());
    std::ranges::copy(line.y, flat.begin() + 3);
    std::ranges::copy(line.z, flat.begin() + 6);
  };
  Stage stage;
  stage.mass = stage.charge = stage.volume = ones;
  stage.columns = JetColumns<const double>{flat, 3};
  place();
  EXPECT_NEAR(stage.links().length[1], 1, 4 * epsilon);
  for (auto* column : {&line.x, &line.y, &line.z})
    for (double& c : *column) c *= 2;
  place();
  stage.invalidate();
  EXPECT_NEAR(stage.links().length[1], 2, 8 * epsilon);
}

} // namespace
} // namespace ehdjet
