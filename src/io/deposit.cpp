#include "run_writer.hpp"

namespace ehdjet {

namespace {

class Deposit final : public Observer {
public:
  Deposit(RunWriter& writer, hid_t group)
      : writer_(writer)
      , time_(real(group, {"time", "s", "of the landing"}))
      , removal_time_(real(group, {"removal_time", "s", "when the bead left the chain"}))
      , x_(real(group, {"x", "m", "position on the collector"}))
      , y_(real(group, {"y", "m", "position on the collector"}))
      , z_(real(group, {"z", "m", "position on the collector"}))
      , vx_(real(group, {"vx", "m/s", "velocity at the landing"}))
      , vy_(real(group, {"vy", "m/s", "velocity at the landing"}))
      , vz_(real(group, {"vz", "m/s", "velocity at the landing"}))
      , stress_(real(group, {"stress", "Pa", "at the landing"}))
      , landing_radius_(
            real(group, {"landing_radius", "m", "of the bead's link at the landing"}))
      , radius_(real(group, {"radius", "m", "of the bead's link when it left the chain"}))
      , mass_(real(group, {"mass", "kg", "of the bead's link"}))
      , charge_(real(group, {"charge", "C", "of the bead's link"}))
      , volume_(real(group, {"volume", "m^3", "of the bead's link"})) {}

  void deposit(const DepositedBead& deposited) override {
    writer_.write([&] { append(deposited); });
  }

private:
  hdf5::Column& real(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, double{}, 1024);
  }

  void append(const DepositedBead& deposited) {
    const Bead& bead = deposited.bead;
    time_.append(deposited.time);
    removal_time_.append(deposited.removal_time);
    x_.append(bead.position.x()), y_.append(bead.position.y()),
        z_.append(bead.position.z());
    vx_.append(bead.velocity.x()), vy_.append(bead.velocity.y()),
        vz_.append(bead.velocity.z());
    stress_.append(bead.stress);
    landing_radius_.append(deposited.landing_radius);
    radius_.append(deposited.radius);
    mass_.append(bead.mass);
    charge_.append(bead.charge);
    volume_.append(bead.volume);
  }

  RunWriter& writer_;
  hdf5::Column &time_, &removal_time_, &x_, &y_, &z_, &vx_, &vy_, &vz_, &stress_,
      &landing_radius_, &radius_, &mass_, &charge_, &volume_;
};

} // namespace

std::unique_ptr<Observer> make_deposit(RunWriter& writer) {
  std::unique_ptr<Observer> observer;
  writer.write([&] {
    observer = std::make_unique<Deposit>(writer, writer.create_group("deposit"));
  });
  writer.flush();
  return observer;
}

} // namespace ehdjet
