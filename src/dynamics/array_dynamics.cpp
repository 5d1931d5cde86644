#include "ehdjet/dynamics/array_dynamics.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ehdjet {
namespace {

Vec3View three_columns(std::vector<double>& v) {
  const std::span<double> all(v);
  const std::size_t n = v.size() / 3;
  return {all.subspan(0, n), all.subspan(n, n), all.subspan(2 * n, n)};
}

Vec3View rows_of(Vec3View v, BeadRange rows) {
  const auto of = [rows](std::span<double> c) {
    return c.subspan(rows.begin, rows.size());
  };
  return {of(v.x), of(v.y), of(v.z)};
}

} // namespace

void ArrayDynamics::add(std::unique_ptr<JetDynamics> jet,
                        std::shared_ptr<SharedCoulomb> coulomb, const JetAxis& axis) {
  parts_.push_back(
      {.dynamics = std::move(jet), .coulomb = std::move(coulomb), .axis = axis});
}

void ArrayDynamics::bind(std::size_t j, const JetState& jet) {
  Part& bound = parts_[j];
  bound.dynamics->bind(jet);
  bound.state.resize(jet.y.size()), bound.rate.resize(jet.y.size());
  bound.rows.end = bound.rows.begin + jet.beads();
  std::size_t end = 0;
  for (Part& part : parts_) {
    const std::size_t n = part.rows.size();
    part.rows = {end, end + n};
    end += n;
  }
  for (auto* v : {&place_, &force_}) v->resize(3 * end);
  charge_.resize(end), moves_.resize(end);
  for (Part& part : parts_)
    part.coulomb->read_from(rows_of(three_columns(force_), part.rows));
}

void ArrayDynamics::take(std::span<const double> all, std::size_t j,
                         std::span<double> own) const {
  const BeadRange rows = parts_[j].rows;
  const std::size_t n = rows.size();
  for (std::size_t c = 0; c * n < own.size(); ++c)
    std::ranges::copy(all.subspan(c * beads() + rows.begin, n),
                      own.subspan(c * n, n).begin());
}

void ArrayDynamics::put(std::span<const double> own, std::size_t j,
                        std::span<double> all) const {
  const BeadRange rows = parts_[j].rows;
  const std::size_t n = rows.size();
  for (std::size_t c = 0; c * n < own.size(); ++c)
    std::ranges::copy(own.subspan(c * n, n),
                      all.subspan(c * beads() + rows.begin, n).begin());
}

/// `change(part, own)` changes the columns of each jet in turn.
template <class Change>
void ArrayDynamics::change_each(std::span<double> all, const Change& change) const {
  for (std::size_t j = 0; j < jets(); ++j) {
    room_.resize(parts_[j].state.size());
    take(all, j, room_);
    change(*parts_[j].dynamics, std::span<double>(room_));
    put(room_, j, all);
  }
}

void ArrayDynamics::prescribe(double t, std::span<double> y) const {
  change_each(
      y, [t](const JetDynamics& jet, std::span<double> own) { jet.prescribe(t, own); });
}

/// The places and charges of all beads as they act.
void ArrayDynamics::gather_charges(double t, std::span<const double> y) {
  const Vec3View place = three_columns(place_);
  for (std::size_t j = 0; j < jets(); ++j) {
    Part& part = parts_[j];
    take(y, j, part.state);
    const Stage& stage = part.dynamics->stage_at(t, part.state);
    const ConstVec3View r = stage.columns.position();
    const Vec3View own = rows_of(place, part.rows);
    std::ranges::copy(r.x, own.x.begin());
    std::ranges::transform(r.y, own.y.begin(), [&](double at) { return at + part.axis.y; });
    std::ranges::transform(r.z, own.z.begin(), [&](double at) { return at + part.axis.z; });
    const auto first = static_cast<std::ptrdiff_t>(part.rows.begin);
    std::ranges::copy(stage.charge, charge_.begin() + first);
    std::ranges::copy(stage.moves, moves_.begin() + first);
  }
}

void ArrayDynamics::evaluate(double t, std::span<const double> y, std::span<double> rate) {
  ++evaluations_;
  gather_charges(t, y);
  std::ranges::fill(force_, 0.0);
  solver_->add_force({three_columns(place_), charge_, moves_}, three_columns(force_));
  coincident_pairs_ =
      std::max<std::uint64_t>(coincident_pairs_, solver_->coincident_pairs());
  for (std::size_t j = 0; j < jets(); ++j) {
    Part& part = parts_[j];
    part.dynamics->evaluate(t, part.state, part.rate);
    put(part.rate, j, rate);
  }
}

void ArrayDynamics::linearize(double t, std::span<const double> y) {
  for (std::size_t j = 0; j < jets(); ++j) {
    take(y, j, parts_[j].state);
    parts_[j].dynamics->stiff_part()->linearize(t, parts_[j].state);
  }
}

void ArrayDynamics::factorize(double eta) {
  for (Part& part : parts_) part.dynamics->stiff_part()->factorize(eta);
}

void ArrayDynamics::solve(std::span<double> x) const {
  change_each(
      x, [](JetDynamics& jet, std::span<double> own) { jet.stiff_part()->solve(own); });
}

void ArrayDynamics::add_time_derivative(double factor, std::span<double> out) const {
  change_each(out, [factor](JetDynamics& jet, std::span<double> own) {
    jet.stiff_part()->add_time_derivative(factor, own);
  });
}

StiffPart::Modes ArrayDynamics::fastest_modes() const {
  Modes fastest{};
  for (const Part& part : parts_) {
    const Modes modes = part.dynamics->stiff_part()->fastest_modes();
    for (std::size_t i = 0; i < modes.size(); ++i)
      if (!(std::abs(modes[i]) <= std::abs(fastest[i]))) fastest[i] = modes[i]; // NaN stays
  }
  return fastest;
}

void ArrayDynamics::archive(const Archive& a) {
  a("evaluations", evaluations_), a("coincident_pairs", coincident_pairs_);
  solver_->archive(a.part("solver"));
  for (std::size_t j = 0; j < jets(); ++j)
    jet(j).archive(a.part("jet" + std::to_string(j)));
}

} // namespace ehdjet
