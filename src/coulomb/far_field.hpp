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

/// Clusters of sources and of targets, with their multipoles.
struct ClusterProblem {
  const PairKernel& pairs;
  const Expansions& expansions;
  ScaledCharges& charges;
  const ClusterTree &sources, &targets; ///< the same tree if the charges act on each other
  const Multipoles& multipoles;         ///< of the sources
  const Acceptance& acceptance;

  [[nodiscard]] bool is_mutual() const { return &sources == &targets; }
};

/// The treecode or the fast multipole method.
class FarField {
public:
  virtual ~FarField() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Allocates the memory for a problem.
  virtual void reserve(const ClusterProblem& problem, std::size_t threads) = 0;
  /// Adds the fields of all targets to `charges.field(...)` of one or all threads. Every thread of
  /// the team must call it.
  virtual void act(const ClusterProblem& problem, std::size_t thread, std::size_t team) = 0;
  /// Whether the last call has left out clusters at one place, all pairs of which are coincident.
  [[nodiscard]] virtual bool met_coincident() const = 0;
  /// Number of pairs of charges that the last call has summed one by one.
  [[nodiscard]] virtual std::uint64_t near_pairs() const = 0;
};

std::unique_ptr<FarField> make_treecode();
std::unique_ptr<FarField> make_fast_multipole();

} // namespace ehdjet::detail
