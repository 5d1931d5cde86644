#pragma once

#include "ehdjet/budget/budget.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/scenes.hpp"

/// Runs whose energy and momentum are accounted for.
namespace ehdjet::test {

/// A row of a budget by the names of its columns.
using BudgetRow = std::map<std::string, double>;

struct BudgetedRun {
  BudgetedRun(const Scene& scene, double interval)
      : BudgetedRun(build_simulation(scene), interval) {}
  BudgetedRun(std::unique_ptr<Simulation> moved, double interval)
      : simulation(std::move(moved)) {
    auto made = std::make_unique<Budget>(simulation->dynamics(), simulation->events());
    budget = made.get();
    simulation->add(std::make_unique<Watch>(interval, [this](const JetSnapshot& s) {
      std::vector<double> values(budget->columns().size());
      budget->measure(s, values);
      BudgetRow row{{"time", s.time}};
      for (std::size_t i = 0; i < values.size(); ++i)
        row[budget->columns()[i].name] = values[i];
      rows.push_back(row);
    }));
    simulation->add(std::move(made));
  }
  [[nodiscard]] const BudgetRow& last() const { return rows.back(); }
  BudgetedRun(const BudgetedRun&) = delete; // the simulation refers to it
  BudgetedRun& operator=(const BudgetedRun&) = delete;

  /// Largest |residual| of the energy.
  [[nodiscard]] double worst() const {
    double largest = 0;
    for (const BudgetRow& row : rows) {
      const double residual = std::abs(row.at("energy_residual"));
      largest = residual <= largest ? largest : residual; // a NaN stays
    }
    return largest;
  }
  std::unique_ptr<Simulation> simulation;
  Budget* budget = nullptr;
  std::vector<BudgetRow> rows;
};

struct FinishedRun : BudgetedRun {
  FinishedRun(const Scene& scene, double end_time, double interval)
      : BudgetedRun(scene, interval) {
    simulation->run_until(end_time);
  }
};

} // namespace ehdjet::test
