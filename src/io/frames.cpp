#include "ehdjet/core/error.hpp"
#include "ehdjet/jet/jet_state.hpp"

#include <cstdint>
#include <utility>

#include "run_writer.hpp"

namespace ehdjet {

namespace {

constexpr std::size_t chunk_rows = 4096; // 32 KiB of doubles
constexpr std::size_t frame_chunk_rows = 1024;

class Frames final : public Observer {
public:
  Frames(RunWriter& writer, double interval, bool with_stress, hid_t beads, hid_t frames)
      : writer_(writer)
      , schedule_(interval)
      , x_(real(beads, {"x", "m", "position along the axis, from the nozzle"}))
      , y_(real(beads, {"y", "m", "position across the axis"}))
      , z_(real(beads, {"z", "m", "position across the axis"}))
      , vx_(real(beads, {"vx", "m/s", "velocity"}))
      , vy_(real(beads, {"vy", "m/s", "velocity"}))
      , vz_(real(beads, {"vz", "m/s", "velocity"}))
      , radius_(real(beads, {"radius", "m", "of the link to the bead upstream"}))
      , volume_(real(beads, {"volume", "m^3", "of that link"}))
      , mass_(real(beads, {"mass", "kg", "of that link"}))
      , charge_(real(beads, {"charge", "C", "of that link"}))
      , landed_(flag(beads, {"landed", "1", "1: the bead rests on the collector"}))
      , embryo_(flag(beads, {"embryo", "1", "1: the bead is still forming at the nozzle"}))
      , stress_(with_stress ? &real(beads, {"stress", "Pa", "of that link"}) : nullptr)
      , time_(writer.add_column(frames, {"time", "s", "of each frame"}, double{},
                                frame_chunk_rows))
      , offset_(writer.add_column(
            frames,
            {"offset", "1", "frame k is the rows offset[k] to offset[k+1] of /beads"},
            std::uint64_t{}, frame_chunk_rows)) {
    offset_.append(rows_);
  }

  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }

  void observe(const JetSnapshot& snapshot) override {
    EHDJET_EXPECTS(snapshot.columns.beads == snapshot.jet.beads());
    EHDJET_EXPECTS(stress_ == nullptr || snapshot.columns.has_stress());
    writer_.write([&] { append(snapshot); });
    schedule_.advance();
  }

private:
  hdf5::Column& real(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, double{}, chunk_rows);
  }
  hdf5::Column& flag(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, std::uint8_t{}, chunk_rows);
  }

  void append(const JetSnapshot& snapshot) {
    const JetColumns<const double>& columns = snapshot.columns;
    const JetState& jet = snapshot.jet;
    x_.append(columns.position().x), y_.append(columns.position().y),
        z_.append(columns.position().z);
    vx_.append(columns.velocity().x), vy_.append(columns.velocity().y),
        vz_.append(columns.velocity().z);
    if (stress_ != nullptr) stress_->append(columns.stress());
    volume_.append(std::span<const double>(jet.volume));
    mass_.append(std::span<const double>(jet.mass));
    charge_.append(std::span<const double>(jet.charge));
    append_radius(columns.position(), jet);
    append_flags(jet);
    rows_ += jet.beads();
    time_.append(snapshot.time);
    offset_.append(rows_); // last: it makes the rows above a frame
  }

  void append_radius(const ConstVec3View& r, const JetState& jet) {
    const auto radius = [&](std::size_t bead) {
      return link_radius(jet.volume[bead], link_length(r, jet.first(), bead));
    };
    // Bead 0 has no link; it gets the radius of the first one, so that a drawn jet has a start.
    radius_.append(jet.first() < jet.beads() ? radius(jet.first()) : 0.);
    if (jet.has_embryo) radius_.append(link_radius(jet.volume[1], (r[1] - r[0]).norm()));
    for (std::size_t k = jet.first(); k < jet.beads(); ++k) radius_.append(radius(k));
  }

  void append_flags(const JetState& jet) {
    std::size_t next = 0;
    for (std::size_t k = 0; k < jet.beads(); ++k) {
      const bool landed = next < jet.landed.size() && jet.landed[next].bead == k;
      if (landed) ++next;
      landed_.append(std::uint8_t{landed});
      embryo_.append(std::uint8_t{jet.has_embryo && k == 1});
    }
  }

  RunWriter& writer_;
  Schedule schedule_;
  std::uint64_t rows_ = 0;
  hdf5::Column &x_, &y_, &z_, &vx_, &vy_, &vz_, &radius_, &volume_, &mass_, &charge_,
      &landed_, &embryo_;
  hdf5::Column* stress_; // absent in a jet without stress
  hdf5::Column &time_, &offset_;
};

} // namespace

std::unique_ptr<Observer> make_frames(RunWriter& writer, double interval,
                                      bool with_stress) {
  std::unique_ptr<Observer> observer;
  writer.write([&] {
    const hdf5::Handle beads = writer.create_group("beads");
    const hdf5::Handle frames = writer.create_group("frames");
    observer = std::make_unique<Frames>(writer, interval, with_stress, beads, frames);
  });
  writer.flush();
  return observer;
}

} // namespace ehdjet
