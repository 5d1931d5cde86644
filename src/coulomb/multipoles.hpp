#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "cluster_tree.hpp"
#include "expansion_tables.hpp"
#include "kernels.hpp"

namespace ehdjet::detail {

/// x^n, n >= 0.
inline double power(double x, int n) {
  double result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1) result *= x;
  return result;
}

struct Displacement {
  double x, y, z;
  [[nodiscard]] double norm() const { return std::sqrt(x * x + y * y + z * z); }
};
[[nodiscard]] inline Displacement between(const double* from, const double* to) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

/// A batch whose lanes have no effect. `set_lane` assigns a cluster to a lane.
[[nodiscard]] ExpansionKernel::Batch idle_batch();
inline void set_lane(ExpansionKernel::Batch& batch, std::size_t lane, const double* from,
                     double* to, const Displacement& d) {
  batch.from[0][lane] = from, batch.to[0][lane] = to;
  batch.dx[lane] = d.x, batch.dy[lane] = d.y, batch.dz[lane] = d.z;
}

/// The kernel with the tables of one order.
struct Expansions {
  Expansions(const ExpansionKernel& operators, int order)
      : kernel(operators)
      , tables(order)
      , numbers(tables.numbers())
      , lines((coefficients(order) + padding - 1) / padding)
      , set(lines * padding) {}
  Expansions(const Expansions&) = delete; // `numbers` points into `tables`
  Expansions& operator=(const Expansions&) = delete;

  ExpansionKernel kernel;
  ExpansionTables tables;
  ExpansionNumbers numbers;
  std::size_t lines, set; ///< cache lines and numbers per coefficient set, with padding
};

/// Upward: sets the multipoles of the clusters of one level from those of their children. Downward:
/// adds the local expansions of the clusters of one level to those of their children. `sets` has one
/// coefficient set per cluster. Every thread of the team must call it.
enum class Shift { upward, downward };
void shift_level(const Expansions& expansions, const ClusterTree& tree, std::size_t level,
                 double* sets, Shift direction);

/// The multipoles of all clusters of a tree. Every thread of the team must call `gather` and `weigh`.
class Multipoles {
public:
  explicit Multipoles(const Expansions& expansions)
      : expansions_(expansions) {}
  void reserve(const ClusterTree& tree) {
    const std::size_t lines = expansions_.lines * tree.clusters().size();
    if (sets_.size() < lines) sets_.resize(lines);
  }
  void gather(const ClusterTree& tree, const ChargeColumns& charges);
  /// Sets Cluster::lumped: the error of the series relative to that of evenly spread charges. If the
  /// charges are `uneven`, the worst case.
  void weigh(ClusterTree& tree, bool uneven) const;
  [[nodiscard]] const double* operator[](std::size_t cluster) const {
    return sets_[expansions_.lines * cluster].value;
  }

private:
  const Expansions& expansions_;
  std::vector<CacheLine> sets_;
};

} // namespace ehdjet::detail
