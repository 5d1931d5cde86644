#include "crowding.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet::detail {

double Crowding::of(const PointCharges& charges) {
  constexpr std::size_t leaf = 32;
  charges_.load({&charges, 1}, 1);
  clusters_.find(charges_, 0, leaf);
  // Of so many leaves along a whipping jet and in a cube (cost_model.cpp), to a fifth.
  const auto leaves = static_cast<double>(clusters_.tree.leaves().size());
  const double on_a_jet = std::clamp(7000 / leaves, 5.0, std::max(leaves, 5.0)),
               in_a_cloud = std::min(leaves, 45 * std::pow(leaves, 0.25));
  if (in_a_cloud < 1.3 * on_a_jet) return 0; // all are neighbours of all
  return std::clamp(std::log(clusters_.neighbours / on_a_jet)
                        / std::log(in_a_cloud / on_a_jet),
                    0.0, 1.0);
}

} // namespace ehdjet::detail
