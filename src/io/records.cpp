#include "ehdjet/io/records.hpp"

#include "ehdjet/core/error.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "record_columns.hpp"
#include "recorder.hpp"

namespace ehdjet {
namespace {

/// Writes a part of a run file that has one row per `Row`.
template <class Row>
class Record final : public Recorder<Observer, JetSnapshot> {
public:
  Record(std::shared_ptr<RunFile> file, const char* part,
         std::vector<RecordColumn<Row>> columns, std::optional<double> interval = {},
         std::size_t rows_of_chunk = chunk_rows)
      : Recorder(std::move(file), interval)
      , part_(part)
      , columns_(std::move(columns)) {
    for (const auto& c : columns_)
      data_sets_.push_back(&file_->add_column(part, c, rows_of_chunk));
    file_->flush();
  }
  void archive(const Archive& a) override { ehdjet::archive(a, part_, columns_); }

  void deposit(const DepositedBead& bead) override {
    if constexpr (std::is_same_v<Row, DepositedBead>)
      file_->write([&] { append_row(bead); });
  }
  void refined(const RefinementRecord& record) override {
    if constexpr (std::is_same_v<Row, RefinementRecord>)
      file_->write([&] { append_row(record); });
  }

private:
  void append(const JetSnapshot& snapshot) override {
    if constexpr (std::is_same_v<Row, JetSnapshot>) append_row(snapshot);
  }
  void append_row(const Row& row) {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      data_sets_[i]->append(columns_[i].value(row));
  }

  const char* part_;
  std::vector<RecordColumn<Row>> columns_;
  std::vector<Column*> data_sets_;
};

/// Appends the columns of `accounts`, the first of which has the others measured.
void append(std::vector<RecordColumn<JetSnapshot>>& columns,
            const std::shared_ptr<Accounts>& accounts) {
  const auto given = accounts->columns();
  const auto row = std::make_shared<std::vector<double>>(given.size());
  for (std::size_t i = 0; i < given.size(); ++i)
    columns.push_back({{given[i].name, given[i].unit, given[i].description},
                       [accounts, row, i](const JetSnapshot& s) {
                         if (i == 0) accounts->measure(s, *row);
                         return (*row)[i];
                       }});
}

/// Writes all beads of a frame one after the other, and where each frame ends.
class Frames final : public Recorder<Observer, JetSnapshot> {
public:
  Frames(std::shared_ptr<RunFile> file, double interval, const BeadTable& table)
      : Recorder(std::move(file), interval)
      , columns_(frame_columns(table)) {
    for (const FrameColumn& c : columns_)
      data_sets_.push_back(&file_->add_column("beads", c, 4 * chunk_rows));
    times_ = std::make_unique<FrameTimes>(*file_, *data_sets_.front());
    file_->flush();
  }

private:
  void append(const JetSnapshot& snapshot) override {
    EHDJET_EXPECTS(snapshot.columns.beads == snapshot.jet.beads());
    for (std::size_t i = 0; i < columns_.size(); ++i)
      data_sets_[i]->append(columns_[i].values(snapshot));
    times_->append(snapshot.time);
  }

  std::vector<FrameColumn> columns_;
  std::vector<Column*> data_sets_;
  std::unique_ptr<FrameTimes> times_;
};

class ResolvingPower final : public Recorder<Observer, JetSnapshot> {
public:
  ResolvingPower(std::shared_ptr<RunFile> file, double interval, double link_length)
      : Recorder(std::move(file), interval)
      , link_length_(link_length)
      , time_(add({"time", "s", "of each sample"}, chunk_rows))
      , power_(
            add({"r", "1", "R = link_length/l at all values of lambda, sample after sample",
                 ColumnType::real, "r"},
                places * 64)) {
    EHDJET_EXPECTS(link_length > 0);
    Column& lambda = add({"lambda", "1", "arc length from the nozzle over the jet's",
                          ColumnType::real, "lambda"},
                         places);
    file_->write([&] {
      for (std::size_t i = lambda.rows(); i < places; ++i) lambda.append(at(i));
    });
    file_->flush();
  }

private:
  static constexpr std::size_t places = 101; // lambda = 0, 0.01, ... 1

  Column& add(const ColumnInfo& info, std::size_t rows_of_chunk) {
    return file_->add_column("resolving_power", info, rows_of_chunk);
  }
  static double at(std::size_t place) { return static_cast<double>(place) / (places - 1); }

  // Each lambda gets R of the link in which it lies. The link across an embryo is one link.
  void append(const JetSnapshot& snapshot) override {
    const auto r = snapshot.columns.position();
    const std::size_t first = snapshot.jet.first(), beads = snapshot.jet.beads();
    length_.resize(beads);
    double total = 0;
    for (std::size_t k = first; k < beads; ++k) {
      length_[k] = link_length(r, first, k);
      total += length_[k];
    }
    std::array<double, places> row{};
    std::size_t k = first;
    double end = length_[first];
    for (std::size_t i = 0; i < places; ++i) {
      while (k + 1 < beads && end < at(i) * total) end += length_[++k];
      row[i] = link_length_ / length_[k];
    }
    power_.append(std::span<const double>(row));
    time_.append(snapshot.time); // last: it completes the sample
  }

  double link_length_; // [m]
  std::vector<double> length_;
  Column &time_, &power_;
};

} // namespace

std::unique_ptr<Observer> record_observables(std::shared_ptr<RunFile> file, double interval,
                                             const FurtherObservables& further) {
  auto columns = with(further.coulomb_error, "coulomb_error", observable_columns());
  for (const char* name : {"inner_evaluations", "full_sums"})
    columns = with(further.two_rates, name, std::move(columns));
  if (further.accounts) append(columns, further.accounts);
  return std::make_unique<Record<JetSnapshot>>(std::move(file), "observables",
                                               std::move(columns), interval);
}

std::unique_ptr<Observer> record_frames(std::shared_ptr<RunFile> file, double interval,
                                        const BeadTable& table) {
  return std::make_unique<Frames>(std::move(file), interval, table);
}

std::unique_ptr<Observer> record_deposit(std::shared_ptr<RunFile> file,
                                         std::shared_ptr<const BeadTable> table) {
  return std::make_unique<Record<DepositedBead>>(std::move(file), "deposit",
                                                 deposit_columns(std::move(table)));
}

std::unique_ptr<Observer> record_refinements(std::shared_ptr<RunFile> file,
                                             bool with_coulomb_energy) {
  return std::make_unique<Record<RefinementRecord>>(
      std::move(file), "refinements",
      with(with_coulomb_energy, "coulomb_energy_change", refinement_columns()),
      std::nullopt, chunk_rows / 4);
}

std::unique_ptr<Observer> record_budget(std::shared_ptr<RunFile> file, double interval,
                                        const std::shared_ptr<Accounts>& accounts) {
  std::vector<RecordColumn<JetSnapshot>> columns{
      {{"time", "s", "of each row"}, [](const JetSnapshot& s) { return s.time; }}};
  append(columns, accounts);
  std::string names;
  for (const auto& column : accounts->columns())
    names += (names.empty() ? "" : ",") + column.name;
  file->describe("budget", "columns", names);
  return std::make_unique<Record<JetSnapshot>>(std::move(file), "budget",
                                               std::move(columns), interval);
}

std::unique_ptr<Observer> record_resolving_power(std::shared_ptr<RunFile> file,
                                                 double interval, double link_length) {
  return std::make_unique<ResolvingPower>(std::move(file), interval, link_length);
}

std::unique_ptr<Observer> record_checkpoints(std::shared_ptr<RunFile> file) {
  return std::make_unique<CheckpointRecorder<Observer>>(std::move(file));
}

} // namespace ehdjet
