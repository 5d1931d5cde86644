#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include "clusters.hpp"
#include "scaled_charges.hpp"

namespace ehdjet::detail {

/// How crowded charges are: 0 along a single jet, 1 where they fill space, by the number of
/// neighbours that the leaves of a cluster tree have.
class Crowding {
public:
  /// cost : that of a cluster tree, about a hundredth of a force call
  double of(const PointCharges& charges);

private:
  ScaledCharges charges_;
  Clusters clusters_;
};

} // namespace ehdjet::detail
