#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "acceptance.hpp"
#include "cluster_tree.hpp"
#include "kernels.hpp"
#include "multipoles.hpp"
#include "scaled_charges.hpp"

namespace ehdjet::detail {

/// Clusters of sources and of targets, ready to act on each other.
struct ClusterProblem {
  const PairKernel& pairs;
  const Expansions& expansions;
  ScaledCharges& charges;
  const ClusterTree &sources, &targets; ///< the same tree: they act on each other
  const Multipoles& multipoles;         ///< of the sources
  const Acceptance& acceptance;

  [[nodiscard]] bool is_mutual() const { return &sources == &targets; }
};

/// Treecode or fast multipole method: which clusters act on which, and how.
class FarField {
public:
  virtual ~FarField() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Allocates what the problem needs.
  virtual void reserve(const ClusterProblem& problem, std::size_t threads) = 0;
  /// Fields of all targets, into `charges.field(...)` of one or all threads, which is clear. Called
  /// by every thread of the team.
  virtual void act(const ClusterProblem& problem, std::size_t thread, std::size_t team) = 0;
  /// Whether the last call has left out clusters at one place, all pairs of which are coincident.
  [[nodiscard]] virtual bool met_coincident() const = 0;
  /// Pairs of charges that the last call has summed one by one.
  [[nodiscard]] virtual std::uint64_t near_pairs() const = 0;
};

std::unique_ptr<FarField> make_treecode();
std::unique_ptr<FarField> make_fast_multipole();

} // namespace ehdjet::detail
