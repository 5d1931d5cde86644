#pragma once

#include "ehdjet/dynamics/jet_dynamics.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "support/stress.hpp"

/// The Jacobian of the local forces, by differences and as implicit steps have it.
namespace ehdjet::test {

/// A bent chain in motion with unequal beads, all numbers of order one.
struct BentJet {
  explicit BentJet(std::size_t n,
                   std::shared_ptr<const BeadTable> table = table_with_stress()) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(0.5, 1.5);
    jet.table = std::move(table);
    jet.y.assign(jet.table->integrated().size() * n, 0.0);
    for (auto* column : {&jet.mass, &jet.charge, &jet.volume})
      for (std::size_t k = 0; k < n; ++k) column->push_back(u(random));
    const auto c = jet.columns();
    for (std::size_t k = 0; k < n; ++k) {
      c.position().set(k, {static_cast<double>(k) * u(random), 0.4 * u(random), u(random)});
      c.velocity().set(k, {u(random), -u(random), 2 * u(random)});
      for (std::size_t i = BeadTable::basic_integrated; i < c.count(); ++i)
        c.column(i)[k] = jet.table->integrated()[i].at_birth + 0.3 * u(random);
    }
    for (std::size_t i = BeadTable::basic_carried; i < jet.table->carried().size(); ++i) {
      auto& column = jet.declared.emplace_back();
      for (std::size_t k = 0; k < n; ++k) column.push_back(u(random));
    }
  }
  JetState jet;
};

/// One number for each entry of the state: whether f or J may depend on it.
struct Held {
  std::vector<std::size_t> beads, links;
};
inline std::vector<bool> moving_entries(const JetState& jet, const Held& held) {
  std::vector<bool> moves(jet.y.size(), true);
  for (const std::size_t k : held.beads)
    for (std::size_t c = 0; c < 6; ++c) moves[c * jet.beads() + k] = false;
  for (std::size_t c = BeadTable::basic_integrated; c < jet.columns().count(); ++c)
    for (const std::size_t k : held.links) moves[c * jet.beads() + k] = false;
  return moves;
}

inline Eigen::MatrixXd differences(JetDynamics& dynamics, const JetState& jet,
                                   const std::vector<bool>& moves) {
  const std::size_t size = jet.y.size();
  const auto columns = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(columns, columns);
  std::vector<double> y = jet.y, up(size), down(size);
  for (std::size_t i = 0; i < size; ++i) {
    if (!moves[i]) continue;
    const double h = 1e-5, here = y[i];
    y[i] = here + h, dynamics.evaluate(0.3, y, up);
    y[i] = here - h, dynamics.evaluate(0.3, y, down);
    y[i] = here;
    for (std::size_t row = 0; row < size; ++row)
      j(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i)) =
          (up[row] - down[row]) / (2 * h);
  }
  return j;
}

/// J as it acts in `solve`: (I - M^-1)/eta, M the matrix of its columns.
inline Eigen::MatrixXd solved(JetDynamics& dynamics, const JetState& jet,
                              const std::vector<bool>& moves, double eta) {
  StiffPart& stiff = *dynamics.stiff_part();
  stiff.linearize(0.3, jet.y);
  stiff.factorize(eta);
  const auto size = static_cast<Eigen::Index>(jet.y.size());
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (!moves[static_cast<std::size_t>(i)]) continue;
    std::vector<double> x(jet.y.size(), 0.0);
    x[static_cast<std::size_t>(i)] = 1;
    stiff.solve(x);
    inverse.col(i) = Eigen::VectorXd::Map(x.data(), size);
  }
  return (Eigen::MatrixXd::Identity(size, size) - inverse.inverse()) / eta;
}

inline void expect_same(JetDynamics& dynamics, const JetState& jet, const Held& held,
                        double bound = 1e-7) {
  dynamics.bind(jet);
  const auto moves = moving_entries(jet, held);
  const Eigen::MatrixXd by_differences = differences(dynamics, jet, moves);
  for (const double eta : {0.01, 0.3, 3.0}) {
    const Eigen::MatrixXd j = solved(dynamics, jet, moves, eta);
    EXPECT_LE((j - by_differences).cwiseAbs().maxCoeff(),
              bound * by_differences.cwiseAbs().maxCoeff())
        << eta;
  }
}

} // namespace ehdjet::test
