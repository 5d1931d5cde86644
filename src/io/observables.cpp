#include "ehdjet/core/error.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "run_writer.hpp"

namespace ehdjet {

namespace {

constexpr std::size_t chunk_rows = 1024;

struct Tip {
  double x, yz;
};

Tip tip(const ConstVec3View& r) {
  const std::size_t n = r.size() - 1;
  return {r.x[n], std::hypot(r.y[n], r.z[n])};
}

// Sum of the chords between successive beads; an embryo lies on its chord.
double path_length(const ConstVec3View& r) {
  double length = 0;
  for (std::size_t k = 1; k < r.size(); ++k) length += (r[k] - r[k - 1]).norm();
  return length;
}

double aperture(const Tip& tip) { // full opening angle of the cone the tip runs on [deg]
  return 2 * std::atan2(tip.yz, tip.x) * 180 / std::numbers::pi;
}

class Observables final : public Observer {
public:
  Observables(RunWriter& writer, double interval, bool with_coulomb_error, hid_t group)
      : writer_(writer)
      , schedule_(interval)
      , time_(real(group, {"time", "s", "simulated time"}))
      , beads_(count(group, {"beads", "1", "links of the chain: all beads but the nozzle"}))
      , tip_x_(real(group, {"tip_x", "m", "leading bead: distance from the nozzle plane"}))
      , tip_yz_(real(group, {"tip_yz", "m", "leading bead: distance from the axis"}))
      , path_length_(
            real(group, {"path_length", "m", "length of the chain, chord by chord"}))
      , nozzle_speed_(
            real(group, {"nozzle_speed", "m/s", "speed given to the last released bead"}))
      , impact_speed_(real(group, {"impact_speed", "m/s", "speed of the last landed bead"}))
      , collector_radius_(real(group, {"collector_radius", "m", "of the last landed link"}))
      , current_in_(real(group, {"current_in", "A",
                                 "charge inserted since the previous row, over time"}))
      , current_out_(real(group, {"current_out", "A",
                                  "charge removed since the previous row, over time"}))
      , aperture_(real(group, {"aperture", "deg", "2 atan(tip_yz / tip_x)"}))
      , evaluations_(count(group, {"evaluations", "1", "of the right-hand side, so far"}))
      , steps_(count(group, {"steps", "1", "accepted, so far"}))
      , rejected_(count(group, {"rejected", "1", "rejected steps, so far"}))
      , coulomb_error_(
            with_coulomb_error
                ? &real(group, {"coulomb_error", "1",
                                "relative L2 error of the Coulomb force at its last check"})
                : nullptr) {}

  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }

  void observe(const JetSnapshot& snapshot) override {
    writer_.write([&] { append(snapshot); });
    schedule_.advance();
  }

private:
  hdf5::Column& real(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, double{}, chunk_rows);
  }
  hdf5::Column& count(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, std::uint64_t{}, chunk_rows);
  }

  void append(const JetSnapshot& snapshot) {
    const ConstVec3View r = snapshot.columns.position();
    const Ledger& ledger = snapshot.ledger;
    const double elapsed = snapshot.time - previous_time_;
    const bool first = !(elapsed > 0); // also of a row that comes twice
    time_.append(snapshot.time);
    beads_.append(std::uint64_t{snapshot.jet.links()});
    tip_x_.append(tip(r).x);
    tip_yz_.append(tip(r).yz);
    path_length_.append(path_length(r));
    nozzle_speed_.append(ledger.release_speed);
    impact_speed_.append(ledger.impact_speed);
    collector_radius_.append(ledger.collector_radius);
    current_in_.append(first ? 0. : (ledger.inserted_charge - previous_in_) / elapsed);
    current_out_.append(first ? 0. : (ledger.removed_charge - previous_out_) / elapsed);
    aperture_.append(aperture(tip(r)));
    evaluations_.append(snapshot.statistics.evaluations);
    steps_.append(snapshot.statistics.steps);
    rejected_.append(snapshot.statistics.rejected);
    if (coulomb_error_ != nullptr)
      coulomb_error_->append(snapshot.statistics.coulomb_error.value_or(0));
    previous_time_ = snapshot.time;
    previous_in_ = ledger.inserted_charge, previous_out_ = ledger.removed_charge;
  }

  RunWriter& writer_;
  Schedule schedule_;
  hdf5::Column &time_, &beads_, &tip_x_, &tip_yz_, &path_length_, &nozzle_speed_,
      &impact_speed_, &collector_radius_, &current_in_, &current_out_, &aperture_,
      &evaluations_, &steps_, &rejected_;
  hdf5::Column* coulomb_error_; // absent without checks
  double previous_time_ = std::numeric_limits<double>::infinity();
  double previous_in_ = 0, previous_out_ = 0; // [C]
};

} // namespace

std::unique_ptr<Observer> make_observables(RunWriter& writer, double interval,
                                           bool with_coulomb_error) {
  std::unique_ptr<Observer> observer;
  writer.write([&] {
    observer = std::make_unique<Observables>(writer, interval, with_coulomb_error,
                                             writer.create_group("observables"));
  });
  writer.flush();
  return observer;
}

} // namespace ehdjet
