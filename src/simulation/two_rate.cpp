#include "ehdjet/simulation/two_rate.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/events/insertion.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace ehdjet {
namespace {

/// Beads behind the inner ones that are integrated with them, but only for their sake.
constexpr std::size_t buffer_beads = 2, fewest_inner_beads = 4;
/// Macro steps after which their number is judged.
constexpr std::size_t window = 16;
/// How many beads behind those act on the inner beads with their charges at every stage. The others are
/// extrapolated, which no error estimate sees: the tighter the tolerance, the farther they have to be.
std::size_t near_beads(std::size_t inner_beads, double rtol) {
  const double digits = std::max(0.0, -std::log10(rtol) - 5);
  return std::max(16 + static_cast<std::size_t>(std::lround(8 * digits)), inner_beads / 2);
}
/// The first downstream bead is integrated twice: with the inner beads, where all beads from
/// the second one below it on are predicted, and downstream. By so many tolerances its two states may differ. The error of the last
/// inner bead is about ten times smaller.
constexpr double allowed_mismatch = 4;
/// Of the quadrature in time of the inner beads' field.
constexpr std::size_t quadrature_nodes = 12;

struct Node {
  double place, weight;
};

std::vector<Node> gauss_legendre(std::size_t number) {
  gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(number);
  EHDJET_EXPECTS(table != nullptr);
  std::vector<Node> nodes(number);
  for (std::size_t i = 0; i < number; ++i)
    gsl_integration_glfixed_point(0, 1, i, &nodes[i].place, &nodes[i].weight, table);
  gsl_integration_glfixed_table_free(table);
  return nodes;
}

Vec3View three_columns(std::vector<double>& v, std::size_t rows) {
  v.resize(3 * rows);
  const std::span<double> all(v);
  return {all.subspan(0, rows), all.subspan(rows, rows), all.subspan(2 * rows, rows)};
}

template <class Columns>
Columns rows_of(Columns v, std::size_t first, std::size_t last) {
  const auto of = [&](auto column) { return column.subspan(first, last - first); };
  return {of(v.x), of(v.y), of(v.z)};
}

/// The first beads of a chain. None of them has landed.
JetState first_beads(const JetState& jet, std::size_t rows) {
  JetState part = blank_like(jet, rows);
  part.absorbing_plane.reset();
  for (std::size_t c = 0; c < jet.columns().count(); ++c)
    std::copy_n(jet.columns().column(c).begin(), rows, part.columns().column(c).begin());
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c)
    std::copy_n(jet.carried(c).begin(), rows, part.carried(c).begin());
  return part;
}

/// Bead `rows` and those behind it are those of `jet` from `from` on, with the state y; those before
/// it are of `inner`.
void join(const JetState& inner, std::size_t rows, const JetState& jet,
          std::span<const double> y, std::size_t from, JetState& out) {
  const std::size_t n = jet.beads(), beads = rows + n - from;
  const auto behind = static_cast<std::ptrdiff_t>(rows);
  if (out.beads() != beads) out = blank_like(inner, beads);
  out.time = inner.time, out.has_embryo = inner.has_embryo;
  out.fed_since = inner.fed_since, out.absorbing_plane = jet.absorbing_plane;
  for (std::size_t c = 0; c < jet.columns().count(); ++c) {
    const auto column = out.columns().column(c);
    std::ranges::copy(inner.columns().column(c).first(rows), column.begin());
    std::ranges::copy(y.subspan(c * n + from, n - from), column.begin() + behind);
  }
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c) {
    const std::span<const double> above(inner.carried(c)), below(jet.carried(c));
    std::ranges::copy(above.first(rows), out.carried(c).begin());
    std::ranges::copy(below.subspan(from), out.carried(c).begin() + behind);
  }
  out.field_is_off = jet.field_is_off, out.mat = jet.mat;
  out.landed = jet.landed;
  for (LandedBead& b : out.landed) b.bead += rows - from;
}

} // namespace

/// A macro step, in the numbers of the chain at its start.
class TwoRate::Step final : public DenseStep {
public:
  Step(TwoRate& parts, const JetState& chain)
      : DenseStep(parts.start_, parts.h_, chain)
      , two_(parts)
      , rows_(parts.inner_beads_) {}

  [[nodiscard]] bool keeps_chain() const override { return false; }
  [[nodiscard]] std::span<const double> end_x() const override {
    return two_.integrator().end_state().first(jet.beads());
  }
  void state(double theta, std::span<double> out) const override {
    if (theta == 0) {
      std::ranges::copy(jet.y, out.begin());
    } else if (theta == 1) {
      std::ranges::copy(two_.integrator().end_state(), out.begin());
    } else {
      two_.parts_.integrator->prepare_dense_output(*two_.parts_.downstream);
      two_.integrator().dense_output(theta, 0, out);
    }
    two_.parts_.record->prescribe(time(theta), {out, jet.beads()});
  }
  void chain_at(double theta, double past, JetState& seen) const override {
    const InnerRecord::Piece& piece = two_.parts_.record->at(past);
    JetState inner;
    two_.parts_.record->chain_at(piece, time(theta), inner);
    std::vector<double> y(jet.y.size());
    state(theta, y);
    join(inner, rows_ + piece.births, jet, y, rows_, seen);
  }
  void ledger_at(double past, Ledger& ledger) const override {
    ledger = two_.parts_.record->at(past).ledger;
  }
  [[nodiscard]] std::size_t births(double past) const override {
    return two_.parts_.record->at(past).births;
  }
  void list_inner_times(std::vector<InnerTime>& times) const override {
    for (const auto& piece : two_.parts_.record->pieces())
      times.push_back({.time = piece.end, .event = piece.closing});
  }

private:
  [[nodiscard]] double component(double theta, std::size_t index) const override {
    const std::size_t row = index % jet.beads(), column = index / jet.beads();
    if (theta == 0) return jet.y[index];
    if (row < rows_) return two_.parts_.record->value(time(theta), column, row);
    if (theta == 1) return two_.integrator().end_state()[index];
    two_.parts_.integrator->prepare_dense_output(*two_.parts_.downstream);
    double value = 0;
    two_.integrator().dense_output(theta, index, {&value, 1});
    return value;
  }

  TwoRate& two_;
  std::size_t rows_;
};

TwoRate::TwoRate(Parts parts, const Options& options)
    : parts_(std::move(parts))
    , options_(options)
    , inner_beads_(options.inner_beads) {
  EHDJET_EXPECTS(options.inner_beads >= fewest_inner_beads);
  parts_.inner->add(parts_.record);
  parts_.inner->after_each_step([this](const Simulation&) {
    learn_distant_field();
    field_before_.resize(parts_.record->pieces().size() + 1);
    field_before_.back() = *parts_.field;
  });
}

TwoRate::~TwoRate() = default;

bool TwoRate::suits(const JetState& jet, bool in_use) const {
  const std::size_t n = jet.beads(),
                    fewest = std::max(options_.fewest_beads, 2 * inner_beads_);
  if (n < (in_use ? fewest - fewest / 4 : fewest)) return false;
  return jet.landed.empty()
         || jet.landed.front().bead >= std::min(
                n, inner_beads_ + buffer_beads + near_beads(inner_beads_, options_.rtol));
}

void TwoRate::between_attempts(const std::function<void()>& hook) {
  parts_.inner->between_attempts(hook);
}

StepOutcome TwoRate::attempt(const JetState& jet, const Ledger& ledger, double h) {
  start_ = jet.time, h_ = h;
  if (!ready_) prepare(jet);
  if (inner_ready_) {
    take_back_inner(jet.time + h);
    if (jet.table->drying()) bind_downstream(jet); // masses are those of the last stage
  } else {
    prepare_inner(jet, ledger);
  }

  const Simulation& inner = *parts_.inner;
  const std::uint64_t before = inner.dynamics().evaluations();
  const bool done = run_inner(jet.time + h);
  const std::uint64_t evaluations = inner.dynamics().evaluations() - before;
  inner_evaluations_ += evaluations;
  if (!done) return {.error = std::nan("")};
  pairs_ += static_cast<double>(evaluations * (inner_beads_ + buffer_beads)
                                * inner.jet().beads());
  project(jet, h);

  start_rate_ = alone_;
  parts_.projected->add_acceleration(
      jet.time, 1, jet.charge, parts_.downstream->inverse_mass(),
      JetColumns<double>{start_rate_, jet.beads()}.velocity());
  rest_landed(jet, start_rate_);
  parts_.integrator->restart();
  parts_.integrator->start_from_rate(start_rate_);
  StepOutcome outcome = parts_.integrator->attempt(*parts_.downstream, jet.time, h, jet.y);
  const double difference = mismatch() / allowed_mismatch;
  mismatch_limits_ = !(difference <= outcome.error);
  if (outcome.error <= 1) outcome.error = std::max(outcome.error, difference);
  // Nobody would judge a step in which nearly all beads land.
  if (parts_.downstream->judged_rows(parts_.integrator->end_state())
      < inner_beads_ + buffer_beads)
    outcome.error = std::nan("");
  const auto n = static_cast<double>(jet.beads());
  full_sums_ += std::exchange(pairs_, 0.0) / (n * n);
  return outcome;
}

/// The rates at the start of a step of which nothing is known from the step before.
void TwoRate::prepare(const JetState& jet) {
  parts_.record->begin(0, 0, parts_.inner->ledger()); // all beads are in their places
  evaluate_alone(jet);
  jerk_.assign(jet.y.size(), 0.0);
  set_rate(jet);
  parts_.field->clear();
  ready_ = true, inner_ready_ = false;
}

void TwoRate::evaluate_alone(const JetState& jet) {
  parts_.projected->clear();
  bind_downstream(jet);
  alone_.resize(jet.y.size());
  parts_.downstream->evaluate(jet.time, jet.y, alone_);
}

void TwoRate::bind_downstream(const JetState& jet) {
  parts_.downstream->lead(
      {.head = inner_beads_, .guide = parts_.record.get(), .passed_fly_on = true});
  parts_.downstream->bind(jet);
}

/// The sum of what the downstream beads and the inner ones do to the former.
void TwoRate::set_rate(const JetState& jet) {
  const std::size_t n = jet.beads(), m = inner_beads_;
  const auto targets = rows_of(jet.columns().position(), m, n);
  buffer_.assign(3 * (n - m), 0.0);
  const Vec3View e = three_columns(buffer_, n - m);
  add_field_of(jet, 0, m, targets, e);
  rate_ = alone_;
  const Vec3View a = JetColumns<double>{rate_, n}.velocity();
  for (std::size_t k = m; k < n; ++k)
    a.add(k, jet.charge[k] / link_mass(jet, k) * e[k - m]);
  rest_landed(jet, rate_);
}

void TwoRate::rest_landed(const JetState& jet, std::vector<double>& rate) const {
  const JetColumns<double> rates{rate, jet.beads()};
  for (const LandedBead& b : jet.landed) {
    for (std::size_t c = 0; c < rates.count(); ++c) rates.column(c)[b.bead] = 0;
    rates.position().set(b.bead, parts_.downstream->constraints().plate_velocity);
  }
}

void TwoRate::prepare_inner(const JetState& jet, const Ledger& ledger) {
  bind_downstream(jet);
  const std::size_t free = inner_beads_ + buffer_beads;
  distant_ = std::min(jet.beads(), free + near_beads(inner_beads_, options_.rtol));
  jet_ = &jet;
  parts_.predictor->start(jet, rate_, jerk_);
  parts_.predictor->lead(free, distant_ - free);
  parts_.inner_dynamics->lead({.tail = distant_ - free, .guide = parts_.predictor.get()});
  parts_.inner->take_over(first_beads(jet, distant_), ledger);
  parts_.record->begin(inner_beads_, distant_, parts_.inner->ledger());
  if (!parts_.field->is_known()) learn_distant_field();
  field_before_.assign(1, *parts_.field);
  inner_ready_ = true;
}

/// False if the inner beads cannot go on so far. Then the places of the others are predicted too badly,
/// and a shorter macro step may help.
/// errors : what stopped them, if shorter steps did not help
bool TwoRate::run_inner(double end) {
  constexpr int most_failures = 5; // each time with a fifth of the step
  try {
    parts_.inner->run_until(end);
    failures_ = 0;
    return true;
  } catch (const RunError&) {
    if (++failures_ == most_failures) throw;
    *parts_.field = field_before_.front();
    inner_ready_ = false;
    return false;
  }
}

/// A shorter macro step: the micro steps that end before its end stay.
void TwoRate::take_back_inner(double end) {
  const auto pieces = parts_.record->pieces();
  std::size_t kept = 0;
  while (kept < pieces.size() && pieces[kept].end <= end) ++kept;
  if (kept == pieces.size()) return;
  parts_.inner->take_over(pieces[kept].chain, pieces[kept].ledger);
  *parts_.field = field_before_[kept];
  field_before_.resize(kept + 1);
  parts_.record->keep(kept);
}

/// Of the beads that act on the inner ones by extrapolation only.
void TwoRate::learn_distant_field() {
  const std::size_t n = jet_->beads(), beads = n - distant_,
                    mat = jet_->mat ? jet_->mat->size() : 0, count = beads + mat;
  if (count == 0) return;
  const JetState& inner = parts_.inner->jet();
  const std::size_t free = inner.beads() - (distant_ - inner_beads_ - buffer_beads);
  const Vec3View places = three_columns(places_, count);
  parts_.predictor->places(inner.time, distant_, rows_of(places, 0, beads));
  charge_.assign(std::next(jet_->charge.begin(), static_cast<std::ptrdiff_t>(distant_)),
                 jet_->charge.end());
  if (parts_.downstream->constraints().grounded_collector)
    for (const LandedBead& b : jet_->landed)
      if (b.bead >= distant_) charge_[b.bead - distant_] = 0;
  const bool insulating = parts_.downstream->constraints().insulating_collector;
  if (options_.collector) // who has passed it has left, or rests on it
    for (std::size_t i = 0; i < beads; ++i) {
      if (!(places.x[i] > *options_.collector)) continue;
      if (insulating)
        places.x[i] = *options_.collector;
      else
        charge_[i] = 0;
    }
  if (mat > 0) add_mat(rows_of(places, beads, count), inner.time);
  buffer_.assign(3 * free, 0.0);
  ones_.resize(std::max(ones_.size(), free), 1.0);
  parts_.inward->add_force_from(
      {places, charge_},
      {rows_of(inner.columns().position(), 0, free), std::span(ones_).first(free)},
      three_columns(buffer_, free));
  parts_.field->learn(inner.time, buffer_, free);
  pairs_ += static_cast<double>(free * count);
}

/// The charges on the collector at time t, behind those of the distant beads.
void TwoRate::add_mat(Vec3View places, double t) {
  const Vec3 way = t * parts_.downstream->constraints().plate_velocity;
  std::size_t i = 0;
  jet_->mat->for_each_part([&](const MatCharges& part) {
    const double share = part.remaining(t, options_.decay_time);
    for (std::size_t j = 0; j < part.size(); ++j, ++i) {
      places.set(i, part.place()[j] + way);
      charge_.push_back(share * part.charge[j]);
    }
  });
}

/// field (targets) += that of beads [first, last) with the charges that act at the time of the chain.
void TwoRate::add_field_of(const JetState& chain, std::size_t first, std::size_t last,
                           ConstVec3View targets, Vec3View field) {
  if (first == last || targets.size() == 0) return;
  const auto begin = chain.charge.begin();
  charge_.assign(std::next(begin, static_cast<std::ptrdiff_t>(first)),
                 std::next(begin, static_cast<std::ptrdiff_t>(last)));
  const auto r = chain.columns().position();
  if (first <= 1 && last > 1 && parts_.inflow->changes_content(chain.has_embryo)) {
    const LinkContent full{
        .volume = chain.volume[1], .mass = chain.mass[1], .charge = chain.charge[1]};
    charge_[1 - first] = parts_.inflow->acting(full, chain.fed_since, chain.time, r).charge;
  }
  ones_.resize(std::max(ones_.size(), targets.size()), 1.0);
  parts_.outward->add_force_from({rows_of(r, first, last), charge_},
                                 {targets, std::span(ones_).first(targets.size())}, field);
  pairs_ += static_cast<double>((last - first) * targets.size());
}

/// How much the two states of bead m at the end of the step differ, in tolerances.
double TwoRate::mismatch() const {
  const JetState& inner = parts_.inner->jet();
  const auto end = parts_.integrator->end_state();
  const std::size_t columns = inner.columns().count(), n = end.size() / columns,
                    births = inner.beads() - distant_;
  double largest = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    const double a = inner.columns().column(c)[inner_beads_ + births],
                 b = end[c * n + inner_beads_];
    largest =
        std::max(largest, std::abs(a - b) / (parts_.scale.column_scale[c] + std::abs(b)));
  }
  return largest / parts_.scale.rtol;
}

void TwoRate::project(const JetState& jet, double h) {
  static const std::vector<Node> nodes = gauss_legendre(quadrature_nodes);
  const std::size_t m = inner_beads_, count = jet.beads() - m;
  const Vec3View places = three_columns(places_, count);
  ProjectedField& projected = *parts_.projected;
  projected.begin(jet.time, h, m, count);
  for (const Node& node : nodes) {
    const double t = jet.time + node.place * h;
    const InnerRecord::Piece& piece = parts_.record->at(t);
    parts_.record->chain_at(piece, t, inner_chain_);
    parts_.predictor->places(t, m, places);
    buffer_.assign(3 * count, 0.0);
    add_field_of(inner_chain_, 0, m + piece.births, places, three_columns(buffer_, count));
    projected.add(node.place, node.weight, buffer_);
  }
}

std::unique_ptr<DenseStep> TwoRate::step(const JetState& jet) {
  return std::make_unique<Step>(*this, jet);
}

void TwoRate::commit(JetState& jet, Ledger& ledger, RunStatistics& statistics) {
  const Simulation& inner = *parts_.inner;
  const std::size_t n = jet.beads(), m = inner_beads_,
                    births = inner.jet().beads() - distant_;
  ++macro_steps_;
  const std::size_t worst = parts_.integrator->worst_component() % n;
  JetState next;
  join(inner.jet(), m + births, jet, parts_.integrator->end_state(), m, next);
  next.time = start_ + h_;
  ledger = inner.ledger();
  statistics.insertions += births;
  for (const InnerRecord::Piece& piece : parts_.record->pieces())
    if (dynamic_cast<const Release*>(piece.closing) != nullptr) ++statistics.releases;

  previous_.swap(rate_);
  carry_over(jet, next, births);
  set_rate(next);
  const std::size_t beads = next.beads();
  jerk_.assign(next.y.size(), 0.0);
  for (std::size_t c = 0; c < next.columns().count(); ++c)
    for (std::size_t k = m + births; k < beads; ++k)
      jerk_[c * beads + k] = (rate_[c * beads + k] - previous_[c * n + k - births]) / h_;
  rest_landed(next, jerk_); // its rows of places play no part
  forget_distant(next, births);
  jet = std::move(next);
  ready_ = !adapt(worst, births), inner_ready_ = false;
}

/// The rates of the downstream beads without the inner ones, at the end of the step and with those
/// beads that have become downstream ones in it.
void TwoRate::carry_over(const JetState& jet, const JetState& next, std::size_t births) {
  const std::span<const double> end_rate = parts_.integrator->end_rate();
  if (end_rate.empty()) {
    parts_.record->begin(0, 0, parts_.inner->ledger());
    evaluate_alone(next);
    return;
  }
  const std::size_t n = jet.beads(), beads = next.beads(), m = inner_beads_,
                    old = m + births; // the first one that was downstream before
  start_rate_.assign(end_rate.begin(), end_rate.end());
  parts_.projected->add_acceleration(next.time, -1, jet.charge,
                                     parts_.downstream->inverse_mass(),
                                     JetColumns<double>{start_rate_, n}.velocity());
  alone_.assign(next.y.size(), 0.0);
  if (births > 0) {
    JetDynamics& downstream = *parts_.downstream;
    parts_.projected->clear();
    parts_.record->begin(0, 0, parts_.inner->ledger());
    downstream.bind(next);
    downstream.evaluate(next.time, next.y, alone_, {m, old}, {m, beads});
    pairs_ += static_cast<double>(births * (beads - m));
  }
  for (std::size_t c = 0; c < next.columns().count(); ++c)
    std::copy_n(start_rate_.begin() + static_cast<std::ptrdiff_t>(c * n + m), n - m,
                alone_.begin() + static_cast<std::ptrdiff_t>(c * beads + old));
  buffer_.assign(3 * (beads - old), 0.0);
  const Vec3View field = three_columns(buffer_, beads - old);
  add_field_of(next, m, old, rows_of(next.columns().position(), old, beads), field);
  const Vec3View a = JetColumns<double>{alone_, beads}.velocity();
  for (std::size_t k = old; k < beads; ++k)
    a.add(k, next.charge[k] / link_mass(next, k) * field[k - old]);
  rest_landed(next, alone_);
}

/// The beads that have moved away from the nozzle by the births act by extrapolation from now on.
void TwoRate::forget_distant(const JetState& next, std::size_t births) {
  const std::size_t free = inner_beads_ + buffer_beads, beads = next.beads(),
                    first = std::min(beads, free + near_beads(inner_beads_, options_.rtol)),
                    last = std::min(beads, first + births);
  if (!parts_.field->is_known()) return;
  buffer_.assign(3 * free, 0.0);
  add_field_of(next, first, last, rows_of(next.columns().position(), 0, free),
               three_columns(buffer_, free));
  parts_.field->add_to_past(buffer_, free);
}

/// m is right if beads far behind it limit the macro step. Returns whether it has changed.
bool TwoRate::adapt(std::size_t worst, std::size_t births) {
  constexpr std::size_t close = 3;
  if (mismatch_limits_ || worst < inner_beads_ + close) ++near_cut_;
  if (++steps_in_window_ < window && births + close < inner_beads_) return false;
  const bool too_few = 2 * near_cut_ > window || births + close >= inner_beads_;
  near_cut_ = steps_in_window_ = 0;
  if (!too_few || !options_.adapts) return false;
  inner_beads_ += std::max<std::size_t>(4, inner_beads_ / 8);
  return true;
}

void TwoRate::chain_changed(const JetState& jet, bool only_end) {
  inner_ready_ = false;
  if (!only_end || !ready_) {
    ready_ = false;
    return;
  }
  const std::size_t columns = jet.columns().count(), beads = jet.beads(),
                    before = alone_.size() / columns;
  EHDJET_EXPECTS(before >= beads);
  for (std::vector<double>* v : {&alone_, &rate_, &jerk_}) {
    for (std::size_t c = 1; c < columns; ++c)
      std::copy_n(v->begin() + static_cast<std::ptrdiff_t>(c * before), beads,
                  v->begin() + static_cast<std::ptrdiff_t>(c * beads));
    v->resize(columns * beads);
    rest_landed(jet, *v);
  }
}

void TwoRate::count(RunStatistics& statistics) const {
  statistics.evaluations += downstream_evaluations();
  TwoRateRecord& record = *statistics.two_rates;
  record.steps = macro_steps_, record.inner_beads = inner_beads_;
  record.method = parts_.integrator->method_in_use();
  record.inner_evaluations = inner_evaluations_;
  record.full_sums = static_cast<double>(statistics.evaluations) + full_sums_;
}

void TwoRate::archive(const Archive& a, const JetState& jet) {
  a("inner_beads", inner_beads_), a("near_cut", near_cut_);
  a("steps_in_window", steps_in_window_), a("macro_steps", macro_steps_);
  a("inner_evaluations", inner_evaluations_), a("full_sums", full_sums_),
      a("pairs", pairs_);
  std::uint64_t downstream = downstream_evaluations();
  a("downstream_evaluations", downstream);
  downstream_before_ = downstream - parts_.downstream->evaluations();
  parts_.inner->archive_pace(a.part("inner"));
  parts_.integrator->archive(a.part("integrator"));
  a.require("inner_beads", inner_beads_ >= fewest_inner_beads, "is too few");
  a.require("steps_in_window", steps_in_window_ <= window, "is too many");
  a.require("near_cut", near_cut_ <= steps_in_window_, "is more than steps_in_window");
  // Between two steps the inner chain is not prepared; it starts from the whole chain.
  if (a.is_reading()) inner_ready_ = false;
  a("ready", ready_);
  std::vector<double> unknown;
  a("alone", ready_ ? alone_ : unknown), a("rate", ready_ ? rate_ : unknown);
  a("jerk", ready_ ? jerk_ : unknown);
  for (const std::vector<double>* v : {&alone_, &rate_, &jerk_})
    a.require("ready", !ready_ || v->size() == jet.y.size(), "has rates of another chain");
  if (!ready_) parts_.field->clear();
  parts_.field->archive_past(a.part("distant_field"), inner_beads_ + buffer_beads);
}

} // namespace ehdjet
