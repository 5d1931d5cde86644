#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "support/scenes.hpp"

/// PVP jets with mesh refinement.
namespace ehdjet::test {

inline Scene refined_case(double length, double interval = 1e-3, double rtol = 1e-5) {
  Scene s = case_one("dormand-prince", rtol);
  s.config.refinement = RefinementConfig{.length = length, .interval = interval};
  s.config.output.refinements = RefinementRecords::sums;
  return s;
}

/// Collects what refinements did and what was deposited.
class Collected final : public Observer {
public:
  Collected(std::vector<RefinementRecord>& records, std::vector<DepositedBead>& deposit)
      : records_(records)
      , deposit_(deposit) {}
  void refined(const RefinementRecord& record) override { records_.push_back(record); }
  void deposit(const DepositedBead& bead) override { deposit_.push_back(bead); }

private:
  std::vector<RefinementRecord>& records_;
  std::vector<DepositedBead>& deposit_;
};

struct RefinedRun {
  explicit RefinedRun(const Scene& scene)
      : simulation(build_simulation(scene)) {
    simulation->add(std::make_unique<Collected>(records, deposit));
  }
  std::vector<RefinementRecord> records;
  std::vector<DepositedBead> deposit;
  std::unique_ptr<Simulation> simulation;
};

inline double path_length_of(const JetState& jet) {
  const auto r = jet.columns().position();
  double length = 0;
  for (std::size_t k = 1; k < jet.beads(); ++k) length += (r[k] - r[k - 1]).norm();
  return length;
}

/// l_step/l in the link where the arc length is lambda of the jet's.
inline double resolving_power(const JetState& jet, ConstVec3View r, double lambda) {
  const std::size_t first = jet.first();
  std::vector<double> length(jet.beads(), 0.0);
  double total = 0;
  for (std::size_t k = first; k < jet.beads(); ++k)
    total += length[k] = link_length(r, first, k);
  std::size_t k = first;
  double end = length[first];
  while (k + 1 < jet.beads() && end < lambda * total) end += length[++k];
  return pvp::link_length / length[k];
}

} // namespace ehdjet::test
