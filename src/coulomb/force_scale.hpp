#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "far_field.hpp"

namespace ehdjet::detail {

/// Root mean square of the net force on the targets that move, by which errors are judged. It is
/// estimated anew in each call, from the forces on a few groups of charges, by low multipoles and
/// nearby charges: a call depends on its arguments only.
class ForceScale {
public:
  ForceScale(const ExpansionKernel& kernel, int order);

  /// Every thread of the team.
  void sample(const ClusterProblem& problem);
  /// Without k_C, in the units of clusters. The largest few do not count: if a few charges have
  /// nearly all of the force, a sample must not take them for typical. For the norm `moving` the
  /// strongest tenth does not count, as it says.
  [[nodiscard]] double value(ToleranceNorm norm);

private:
  void choose_groups(const ClusterProblem& problem);
  void add_field(const ClusterProblem& problem, std::uint32_t cluster, std::size_t begin);

  Expansions expansions_;
  std::vector<std::size_t> groups_;    ///< first charges of those that are sampled
  std::vector<double> squares_;        ///< of sampled forces
  std::vector<unsigned char> ignored_; ///< flags of close pairs among samples
};

} // namespace ehdjet::detail
