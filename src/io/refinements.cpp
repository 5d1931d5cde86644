#include "run_writer.hpp"

namespace ehdjet {

namespace {

class Refinements final : public Observer {
public:
  Refinements(RunWriter& writer, bool with_coulomb_energy, hid_t group)
      : writer_(writer)
      , time_(real(group, {"time", "s", "of the refinement"}))
      , kept_(count(group, {"kept", "1", "beads 0 to this one were left as they were"}))
      , before_(count(group, {"beads_before", "1", "links of the chain before"}))
      , after_(count(group, {"beads_after", "1", "links of the chain afterwards"}))
      , mass_(real(group, {"mass_change", "kg", "of the chain's sum"}))
      , charge_(real(group, {"charge_change", "C", "of the chain's sum"}))
      , volume_(real(group, {"volume_change", "m^3", "of the chain's sum"}))
      , px_(real(group, {"momentum_change_x", "kg m/s", "of beads that move freely"}))
      , py_(real(group, {"momentum_change_y", "kg m/s", "of beads that move freely"}))
      , pz_(real(group, {"momentum_change_z", "kg m/s", "of beads that move freely"}))
      , kinetic_(real(group, {"kinetic_energy_change", "J", "of beads that move freely"}))
      , elastic_(
            real(group, {"elastic_energy_change", "J", "of the sum of V sigma^2/(2G)"}))
      , coulomb_(with_coulomb_energy
                     ? &real(group, {"coulomb_energy_change", "J", "of all pairs of beads"})
                     : nullptr)
      , worst_link_(real(group, {"worst_link", "1",
                                 "largest |l/l* - 1| of the new links' chords l, where l* "
                                 "is the arc length that they were given"})) {}

  void refined(const RefinementRecord& record) override {
    writer_.write([&] { append(record); });
  }

private:
  static constexpr std::size_t chunk_rows = 256;
  hdf5::Column& real(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, double{}, chunk_rows);
  }
  hdf5::Column& count(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, std::uint64_t{}, chunk_rows);
  }

  void append(const RefinementRecord& record) {
    const JetTotals& change = record.change;
    time_.append(record.time);
    kept_.append(std::uint64_t{record.kept});
    before_.append(std::uint64_t{record.beads_before});
    after_.append(std::uint64_t{record.beads_after});
    mass_.append(change.mass), charge_.append(change.charge), volume_.append(change.volume);
    px_.append(change.momentum.x()), py_.append(change.momentum.y()),
        pz_.append(change.momentum.z());
    kinetic_.append(change.kinetic_energy), elastic_.append(change.elastic_energy);
    if (coulomb_ != nullptr) coulomb_->append(change.coulomb_energy);
    worst_link_.append(record.worst_link);
  }

  RunWriter& writer_;
  hdf5::Column &time_, &kept_, &before_, &after_, &mass_, &charge_, &volume_, &px_, &py_,
      &pz_, &kinetic_, &elastic_;
  hdf5::Column* coulomb_; // absent unless asked for
  hdf5::Column& worst_link_;
};

} // namespace

std::unique_ptr<Observer> make_refinements(RunWriter& writer, bool with_coulomb_energy) {
  std::unique_ptr<Observer> observer;
  writer.write([&] {
    observer = std::make_unique<Refinements>(writer, with_coulomb_energy,
                                             writer.create_group("refinements"));
  });
  writer.flush();
  return observer;
}

} // namespace ehdjet
