#include "ehdjet/multirate/inner_record.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>

namespace ehdjet {
namespace {

/// Lagrange's polynomials of the sample places 0, 1/4, 1/2, 3/4, 1.
std::array<double, InnerRecord::samples> weights_at(double x) {
  std::array<double, InnerRecord::samples> weight{};
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = 1;
    for (std::size_t j = 0; j < weight.size(); ++j)
      if (j != i)
        weight[i] *= (4 * x - static_cast<double>(j))
                     / (static_cast<double>(i) - static_cast<double>(j));
  }
  return weight;
}

double place_in(const InnerRecord::Piece& piece, double t) {
  const double width = piece.end - piece.begin;
  return width > 0 ? std::clamp((t - piece.begin) / width, 0.0, 1.0) : 0.0;
}

} // namespace

void InnerRecord::begin(std::size_t rows, std::size_t beads, const Ledger& ledger) {
  rows_ = rows, beads_at_start_ = beads, ledger_ = &ledger, used_ = 0;
}

InnerRecord::Piece& InnerRecord::add_piece() {
  if (used_ == pieces_.size()) pieces_.emplace_back();
  return pieces_[used_++];
}

void InnerRecord::begin_step(const DenseStep& step,
                             std::span<const std::unique_ptr<Event>> /*events*/) {
  step_ = &step;
}

void InnerRecord::end_step(double t, double theta) {
  Piece& piece = add_piece();
  piece.begin = step_->t0, piece.end = t;
  piece.chain = step_->jet, piece.ledger = *ledger_;
  piece.births = piece.chain.beads() - beads_at_start_;
  piece.closing = nullptr;
  for (std::size_t i = 0; i < samples; ++i) {
    piece.state[i].resize(piece.chain.y.size());
    step_->state(theta * static_cast<double>(i) / (samples - 1), piece.state[i]);
  }
  step_ = nullptr;
}

void InnerRecord::before_event(const Event& event, const JetState& /*jet*/) {
  pieces_[used_ - 1].closing = &event;
}

// Of no length: what the event has left is there also at the end of the macro step.
void InnerRecord::after_event(const Event& /*event*/, const JetState& jet) {
  Piece& piece = add_piece();
  piece.begin = piece.end = jet.time;
  piece.chain = jet, piece.ledger = *ledger_;
  piece.births = jet.beads() - beads_at_start_;
  piece.closing = nullptr;
  for (auto& state : piece.state) state = jet.y;
}

const InnerRecord::Piece& InnerRecord::at(double t) const {
  EHDJET_EXPECTS(used_ > 0);
  const auto all = pieces();
  const auto next = std::ranges::upper_bound(all, t, {}, &Piece::begin);
  return next == all.begin() ? all.front() : *std::prev(next);
}

void InnerRecord::chain_at(const Piece& piece, double t, JetState& chain) const {
  chain = piece.chain;
  const auto weight = weights_at(place_in(piece, t));
  for (std::size_t i = 0; i < chain.y.size(); ++i) {
    chain.y[i] = 0;
    for (std::size_t s = 0; s < samples; ++s) chain.y[i] += weight[s] * piece.state[s][i];
  }
  chain.time = t;
  inflow_->prescribe(t, chain.has_embryo, chain.columns());
}

double InnerRecord::value(double t, std::size_t column, std::size_t row) const {
  const Piece& piece = at(t);
  const auto weight = weights_at(place_in(piece, t));
  const std::size_t shift = row > 0 ? piece.births : 0; // bead 0 keeps its number
  const std::size_t i = column * piece.chain.beads() + row + shift;
  double value = 0;
  for (std::size_t s = 0; s < samples; ++s) value += weight[s] * piece.state[s][i];
  return value;
}

void InnerRecord::prescribe(double t, JetColumns<double> y) const {
  if (used_ == 0) return; // the rates at the start of a step: the beads are where they are
  const Piece& piece = at(t);
  const auto weight = weights_at(place_in(piece, t));
  const std::size_t beads = piece.chain.beads();
  for (std::size_t c = 0; c < y.count(); ++c)
    for (std::size_t row = 1; row < rows_; ++row) {
      const std::size_t i = c * beads + row + piece.births;
      double value = 0;
      for (std::size_t s = 0; s < samples; ++s) value += weight[s] * piece.state[s][i];
      y.column(c)[row] = value;
    }
}

} // namespace ehdjet
