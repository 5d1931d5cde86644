#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "far_field.hpp"

namespace ehdjet::detail {

/// Root mean square of the net force on the targets, by which errors are judged. It is estimated
/// anew in each call, from the forces on a few groups of charges, by low multipoles and nearby
/// charges: a call depends on its arguments only.
class ForceScale {
public:
  ForceScale(const ExpansionKernel& kernel, int order);

  /// Every thread of the team.
  void sample(const ClusterProblem& problem);
  /// Without k_C, in the units of clusters. The largest few do not count: if a few charges have
  /// nearly all of the force, a sample must not take them for typical.
  [[nodiscard]] double value();

private:
  void add_field(const ClusterProblem& problem, std::uint32_t cluster, std::size_t begin);

  Expansions expansions_;
  std::vector<double> squares_;        ///< of sampled forces
  std::vector<unsigned char> ignored_; ///< flags of close pairs among samples
};

} // namespace ehdjet::detail
