#pragma once

#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/jet/stage.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace ehdjet::test {

/// The table of jets with these terms.
inline std::shared_ptr<const BeadTable> table_of(std::span<ForceTerm* const> terms) {
  auto table = std::make_shared<BeadTable>();
  for (const ForceTerm* term : terms)
    for (BeadColumn& column : term->columns()) table->declare(std::move(column));
  return table;
}

/// A chain with the columns of some terms, which are at birth, whose beads are moved by hand.
struct TermChain {
  TermChain(std::size_t n, std::vector<ForceTerm*> of)
      : terms(std::move(of))
      , jet(blank_jet(table_of(terms), n)) {
    for (auto* column : {&jet.mass, &jet.charge, &jet.volume}) column->assign(n, 1.0);
    const auto integrated = jet.table->integrated(), carried = jet.table->carried();
    for (std::size_t c = BeadTable::basic_integrated; c < integrated.size(); ++c)
      for (double& value : jet.columns().column(c)) value = integrated[c].at_birth;
    for (std::size_t c = BeadTable::basic_carried; c < carried.size(); ++c)
      jet.carried(c).assign(n, carried[c].at_birth);
    for (ForceTerm* term : terms) term->bind(*jet.table);
  }
  void place(std::size_t k, const Vec3& r, const Vec3& v = Vec3::Zero()) {
    jet.columns().position().set(k, r), jet.columns().velocity().set(k, v);
  }
  /// Integrated column c of those that the terms have added.
  std::span<double> added(std::size_t c) {
    return jet.columns().column(BeadTable::basic_integrated + c);
  }
  [[nodiscard]] std::size_t added_columns() const {
    return jet.table->integrated().size() - BeadTable::basic_integrated;
  }
  Stage& stage() {
    stage_.columns = std::as_const(jet).columns();
    stage_.mass = jet.mass, stage_.charge = stage_.link_charge = jet.charge;
    stage_.volume = jet.volume, stage_.declared = jet.declared;
    stage_.first = jet.first(), stage_.landed = jet.landed;
    stage_.invalidate();
    return stage_;
  }
  /// The sum of the terms' forces on every bead [N].
  std::vector<Vec3> force() {
    std::vector<double> f(3 * jet.beads(), 0.0);
    const std::span<double> all(f);
    const std::size_t n = jet.beads();
    const Vec3View view{all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)};
    for (ForceTerm* term : terms) term->add_force(stage(), view);
    std::vector<Vec3> forces;
    for (std::size_t k = 0; k < n; ++k) forces.push_back(view[k]);
    return forces;
  }
  /// d/dt of the integrated columns; zero for those that no term has added.
  std::vector<double> rates() {
    std::vector<double> all(jet.y.size(), 0.0);
    for (ForceTerm* term : terms) term->set_column_rates(stage(), {all, jet.beads()});
    return all;
  }
  [[nodiscard]] double rate(const std::vector<double>& rates, std::size_t c,
                            std::size_t k) const {
    return rates[(BeadTable::basic_integrated + c) * jet.beads() + k];
  }
  /// The tension of link k over its section, which is the stress [Pa].
  double stress(std::size_t k) {
    std::vector<double> tension(jet.beads(), 0.0);
    for (ForceTerm* term : terms) term->add_tension(stage(), tension);
    return tension[k] * stage().links().length[k] / jet.volume[k];
  }

  std::vector<ForceTerm*> terms;
  JetState jet;

private:
  Stage stage_;
};

} // namespace ehdjet::test
