#include "record_columns.hpp"

#include "ehdjet/jet/link_radii.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace ehdjet {
namespace {

constexpr ColumnType count = ColumnType::count, flag = ColumnType::flag;

// Sum of the chords between successive beads; an embryo lies on its chord.
double path_length(const ConstVec3View& r) {
  double length = 0;
  for (std::size_t k = 1; k < r.size(); ++k) length += (r[k] - r[k - 1]).norm();
  return length;
}

Vec3 tip(const JetSnapshot& s) {
  return s.columns.position()[s.columns.beads - 1];
}

double tip_x(const JetSnapshot& s) {
  return tip(s).x();
}
double tip_from_axis(const JetSnapshot& s) {
  return std::hypot(tip(s).y(), tip(s).z());
}
/// Full opening angle of the cone that the tip runs on.
double aperture(const JetSnapshot& s) {
  return 2 * std::atan2(tip_from_axis(s), tip(s).x()) * 180 / std::numbers::pi;
}
double length_of_path(const JetSnapshot& s) {
  return path_length(s.columns.position());
}

/// The change of a sum, of all jets together, since the previous row, divided by the time since then.
class Rate {
public:
  explicit Rate(CompensatedSum Ledger::*sum)
      : sum_(sum) {}
  double operator()(const JetSnapshot& s) { return rate(s.time, s.ledger.*sum_); }
  double operator()(const ArraySnapshot& s) {
    return rate(s.time, sum_of(s.ledgers).*sum_);
  }

  void archive(const Archive& a) {
    a("previous_time", previous_time_), a("previous", previous_);
  }

private:
  double rate(double time, double now) {
    const double elapsed = time - previous_time_;
    // No time has elapsed in the first row, and if the same time is written twice.
    const double rate = elapsed > 0 ? (now - previous_) / elapsed : 0.;
    previous_time_ = time, previous_ = now;
    return rate;
  }

  CompensatedSum Ledger::*sum_;
  double previous_time_ = std::numeric_limits<double>::infinity(); // [s]
  double previous_ = 0;
};

template <class Row>
RecordColumn<Row> rate_of(CompensatedSum Ledger::*sum, const ColumnInfo& info) {
  const auto rate = std::make_shared<Rate>(sum);
  return {info, [rate](const Row& row) { return (*rate)(row); },
          [rate](const Archive& a) { rate->archive(a); }};
}

/// The mean or the largest over the jets of an array of what `of` says of each.
template <class Of>
auto mean(Of of) {
  return [of](const ArraySnapshot& s) {
    double sum = 0;
    for (std::size_t j = 0; j < s.jets.size(); ++j) sum += of(s.jet(j));
    return sum / static_cast<double>(s.jets.size());
  };
}
template <class Of>
auto largest(Of of) {
  return [of](const ArraySnapshot& s) {
    double value = of(s.jet(0));
    for (std::size_t j = 1; j < s.jets.size(); ++j) value = std::max(value, of(s.jet(j)));
    return value;
  };
}

auto from_ledger(double Ledger::*value) {
  return [value](const JetSnapshot& s) { return s.ledger.*value; };
}
auto from_ledgers(double Ledger::*value) {
  return [value](const ArraySnapshot& s) { return sum_of(s.ledgers).*value; };
}
auto from_statistics(std::uint64_t RunStatistics::*value) {
  return [value](const auto& s) { return static_cast<double>(s.statistics.*value); };
}
auto change_of(double JetTotals::*value) {
  return [value](const RefinementRecord& r) { return r.change.*value; };
}
auto momentum_change(int component) {
  return [component](const RefinementRecord& r) { return r.change.momentum[component]; };
}
auto number_of(std::size_t RefinementRecord::*value) {
  return [value](const RefinementRecord& r) { return static_cast<double>(r.*value); };
}

/// A column that `fill(snapshot, values)` computes. The values are zero before, and valid until the next
/// column with the same `room` is computed.
template <class Fill>
auto computed(const std::shared_ptr<std::vector<double>>& room, Fill fill) {
  return [room, fill](const JetSnapshot& s) -> std::span<const double> {
    room->assign(s.jet.beads(), 0.0);
    fill(s, *room);
    return *room;
  };
}

void fill_radius(const JetSnapshot& s, std::vector<double>& values) {
  for (std::size_t k = 1; k < values.size(); ++k)
    values[k] = link_volume(s.jet, s.columns, k);
  link_radii(s.columns.position(), s.jet.first(), values, values);
}

void mark_landed(const JetSnapshot& s, std::vector<double>& values) {
  for (const LandedBead& b : s.jet.landed) values[b.bead] = 1;
}

void mark_embryo(const JetSnapshot& s, std::vector<double>& values) {
  if (s.jet.has_embryo) values[1] = 1;
}

} // namespace

std::vector<RecordColumn<JetSnapshot>> observable_columns() {
  return {
      {{"time", "s", "simulated time"}, [](const auto& s) { return s.time; }},
      {{"beads", "1", "of the chain, bead 0 at the nozzle included", count},
       [](const auto& s) { return static_cast<double>(s.jet.beads()); }},
      {{"tip_x", "m", "leading bead: distance from the nozzle plane"}, tip_x},
      {{"tip_yz", "m", "leading bead: distance from the axis"}, tip_from_axis},
      {{"path_length", "m", "length of the chain, chord by chord"}, length_of_path},
      {{"nozzle_speed", "m/s", "speed given to the last released bead"},
       from_ledger(&Ledger::release_speed)},
      {{"impact_speed", "m/s", "speed of the last landed bead"},
       from_ledger(&Ledger::impact_speed)},
      {{"collector_radius", "m", "of the last landed link"},
       from_ledger(&Ledger::collector_radius)},
      rate_of<JetSnapshot>(
          &Ledger::inserted_charge,
          {"current_in", "A", "charge inserted since the previous row, over time"}),
      rate_of<JetSnapshot>(
          &Ledger::removed_charge,
          {"current_out", "A", "charge removed since the previous row, over time"}),
      {{"aperture", "deg", "2 atan(tip_yz / tip_x)"}, aperture},
      {{"evaluations", "1", "of the right-hand side, so far", count},
       from_statistics(&RunStatistics::evaluations)},
      {{"steps", "1", "accepted, so far", count}, from_statistics(&RunStatistics::steps)},
      {{"rejected", "1", "rejected steps, so far", count},
       from_statistics(&RunStatistics::rejected)},
      {{"coulomb_error", "1", "relative L2 error of the Coulomb force at its last check"},
       [](const auto& s) { return s.statistics.coulomb_error.value_or(0); }},
      {{"inner_evaluations", "1", "of the beads near the nozzle, with two rates, so far",
        count},
       [](const auto& s) {
         return static_cast<double>(
             s.statistics.two_rates.value_or(TwoRateRecord{}).inner_evaluations);
       }},
      {{"full_sums", "1",
        "Coulomb sums so far, everything included: pairs over all pairs of the jet"},
       [](const auto& s) {
         return s.statistics.two_rates.value_or(TwoRateRecord{}).full_sums;
       }}};
}

std::vector<RecordColumn<ArraySnapshot>> array_observable_columns() {
  const auto beads = [](const ArraySnapshot& s) {
    double sum = 0;
    for (const JetState& jet : s.jets) sum += static_cast<double>(jet.beads());
    return sum;
  };
  return {
      {{"time", "s", "simulated time"}, [](const auto& s) { return s.time; }},
      {{"beads", "1", "of all jets, those at the nozzles included", count}, beads},
      {{"tip_x", "m", "leading bead: distance from the nozzle plane, the largest"},
       largest(tip_x)},
      {{"tip_yz", "m", "leading bead: distance from the axis of the array, the largest"},
       largest(tip_from_axis)},
      {{"path_length", "m", "length of a jet, chord by chord: mean"}, mean(length_of_path)},
      {{"nozzle_speed", "m/s", "speed given to the last released bead of a jet: mean"},
       from_ledgers(&Ledger::release_speed)},
      {{"impact_speed", "m/s", "speed of the last landed bead of a jet: mean"},
       from_ledgers(&Ledger::impact_speed)},
      {{"collector_radius", "m", "of the last landed link of a jet: mean"},
       from_ledgers(&Ledger::collector_radius)},
      rate_of<ArraySnapshot>(
          &Ledger::inserted_charge,
          {"current_in", "A", "charge inserted since the previous row, over time: sum"}),
      rate_of<ArraySnapshot>(
          &Ledger::removed_charge,
          {"current_out", "A", "charge removed since the previous row, over time: sum"}),
      {{"aperture", "deg", "2 atan(tip_yz / tip_x) of a jet, the largest"},
       largest(aperture)},
      {{"evaluations", "1", "of the right-hand side of all jets together, so far", count},
       from_statistics(&RunStatistics::evaluations)},
      {{"steps", "1", "common steps accepted, so far", count},
       from_statistics(&RunStatistics::steps)},
      {{"rejected", "1", "rejected steps, so far", count},
       from_statistics(&RunStatistics::rejected)},
      {{"coulomb_error", "1", "relative L2 error of the Coulomb force at its last check"},
       [](const auto& s) { return s.statistics.coulomb_error.value_or(0); }}};
}

ColumnInfo jet_column() {
  return {"jet", "1", "number of the jet in the array: row * columns + column", count};
}

std::vector<RecordColumn<RefinementRecord>> refinement_columns() {
  return {
      {{"time", "s", "of the refinement"}, [](const auto& r) { return r.time; }},
      {{"kept", "1", "beads 0 to this one were left as they were", count},
       number_of(&RefinementRecord::kept)},
      {{"beads_before", "1", "of the chain before", count},
       number_of(&RefinementRecord::beads_before)},
      {{"beads_after", "1", "of the chain afterwards", count},
       number_of(&RefinementRecord::beads_after)},
      {{"mass_change", "kg", "of the chain's sum"}, change_of(&JetTotals::mass)},
      {{"charge_change", "C", "of the chain's sum"}, change_of(&JetTotals::charge)},
      {{"volume_change", "m^3", "of the chain's sum"}, change_of(&JetTotals::volume)},
      {{"momentum_change_x", "kg m/s", "of beads that move freely"}, momentum_change(0)},
      {{"momentum_change_y", "kg m/s", "of beads that move freely"}, momentum_change(1)},
      {{"momentum_change_z", "kg m/s", "of beads that move freely"}, momentum_change(2)},
      {{"kinetic_energy_change", "J", "of beads that move freely"},
       change_of(&JetTotals::kinetic_energy)},
      {{"elastic_energy_change", "J", "of the sum of V sigma^2/(2G)"},
       change_of(&JetTotals::elastic_energy)},
      {{"coulomb_energy_change", "J", "of all pairs of beads and of the near field"},
       change_of(&JetTotals::coulomb_energy)},
      {{"worst_link", "1",
        "largest |l/l* - 1| of the new links' chords l, where l* is the arc length that "
        "they were given"},
       [](const auto& r) { return r.worst_link; }}};
}

std::vector<FrameColumn> frame_columns(const BeadTable& table) {
  const auto info = [](const BeadColumn& c) {
    return ColumnInfo{c.name, c.unit, c.description};
  };
  const auto room = std::make_shared<std::vector<double>>();
  std::vector<FrameColumn> columns;
  for (const BeadColumn& c : table.integrated())
    columns.push_back({info(c), [place = columns.size()](const JetSnapshot& s) {
                         return s.columns.column(place);
                       }});
  columns.push_back(
      {{"radius", "m", "of the link to the bead upstream"}, computed(room, fill_radius)});
  for (std::size_t c = 0; c < table.carried().size(); ++c)
    columns.push_back(
        {info(table.carried()[c]), [c](const JetSnapshot& s) -> std::span<const double> {
           return s.jet.carried(c);
         }});
  columns.push_back({{"landed", "1", "1: the bead rests on the collector", flag},
                     computed(room, mark_landed)});
  columns.push_back({{"embryo", "1", "1: the bead is still forming at the nozzle", flag},
                     computed(room, mark_embryo)});
  return columns;
}

std::shared_ptr<const BeadTable> exported_table() {
  auto table = std::make_shared<BeadTable>();
  table->declare({.name = "stress", .unit = "Pa", .description = ""});
  return table;
}

std::vector<RunTable::Column> further_columns(const Frame& frame) {
  const auto usual = frame_columns(*exported_table());
  std::vector<RunTable::Column> further = frame.columns;
  std::erase_if(further, [&](const RunTable::Column& c) {
    return std::ranges::find(usual, c.name, &ColumnInfo::name) != usual.end();
  });
  return further;
}

std::vector<BeadRange> jets_of(const RunTable& frame) {
  const RunTable::Column* jet = frame.find("jet");
  if (jet == nullptr) return {{0, frame.rows()}};
  std::vector<BeadRange> jets;
  for (std::size_t k = 0; k < frame.rows(); ++k) {
    if (k == 0 || jet->values[k] != jet->values[k - 1]) jets.push_back({k, k});
    jets.back().end = k + 1;
  }
  return jets;
}

std::vector<double> column_or_zeros(const RunTable& frame, std::string_view name) {
  const RunTable::Column* found = frame.find(name);
  return found != nullptr ? found->values : std::vector<double>(frame.rows());
}

std::vector<RecordColumn<DepositedBead>>
deposit_columns(std::shared_ptr<const BeadTable> table) {
  std::vector<RecordColumn<DepositedBead>> columns{
      {{"time", "s", "of the landing"}, [](const auto& d) { return d.time; }},
      {{"removal_time", "s", "when the bead left the chain"},
       [](const auto& d) { return d.removal_time; }}};
  const auto add = [&](const BeadColumn& c, std::size_t place) {
    const bool carried = c.evolution == Evolution::carried;
    columns.push_back(
        {{c.name, c.unit, c.description + (carried ? "" : ", at the landing")},
         [place, table](const DepositedBead& d) {
           return column_values(d.bead, *table)[place];
         }});
  };
  const std::size_t integrated = table->integrated().size();
  for (std::size_t c = 0; c < integrated; ++c) add(table->integrated()[c], c);
  if (!table->find_integrated("stress"))
    columns.push_back({{"stress", "Pa", "there is none"}, [](const auto&) { return 0.; }});
  columns.push_back({{"landing_radius", "m", "of the bead's link at the landing"},
                     [](const auto& d) { return d.landing_radius; }});
  columns.push_back({{"radius", "m", "of the bead's link when it left the chain"},
                     [](const auto& d) { return d.radius; }});
  if (const auto drying = table->drying())
    columns.push_back({{"dry_radius", "m", "of the bead's link once all solvent has gone"},
                       [table, drying](const DepositedBead& d) {
                         const double lost = column_values(d.bead, *table)[drying->column];
                         return d.radius * std::sqrt(drying->dry / (1 - lost));
                       }});
  for (std::size_t c = 0; c < table->carried().size(); ++c)
    add(table->carried()[c], integrated + c);
  // In an export the volume is the last of the basic carried columns.
  const auto volume = std::ranges::find(columns, "volume", &ColumnInfo::name);
  std::rotate(volume, volume + 1, volume + BeadTable::basic_carried);
  return columns;
}

std::vector<double> link_lengths(const RunTable& deposit) {
  const auto &volume = deposit["volume"], &radius = deposit["radius"];
  const RunTable::Column* lost = deposit.find(evaporated);
  std::vector<double> lengths(deposit.rows());
  for (std::size_t k = 0; k < lengths.size(); ++k)
    lengths[k] = volume[k] * (lost != nullptr ? 1 - lost->values[k] : 1)
                 / (std::numbers::pi * radius[k] * radius[k]);
  return lengths;
}

} // namespace ehdjet
