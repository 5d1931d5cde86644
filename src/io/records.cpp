#include "ehdjet/io/records.hpp"

#include "ehdjet/core/error.hpp"

#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "record_columns.hpp"

namespace ehdjet {
namespace {

constexpr std::size_t chunk_rows = 1024;

/// Writes a part of a run file that has a row per `Row`. Rows at times come at multiples of
/// `interval` [s].
template <class Row>
class Record final : public Observer {
public:
  Record(std::shared_ptr<RunFile> file, const char* part,
         std::vector<RecordColumn<Row>> columns, std::optional<double> interval = {},
         std::size_t rows_of_chunk = chunk_rows)
      : file_(std::move(file))
      , columns_(std::move(columns)) {
    EHDJET_EXPECTS(!interval || *interval > 0);
    if (interval) schedule_.emplace(*interval);
    for (const auto& c : columns_)
      data_sets_.push_back(&file_->add_column(part, c, rows_of_chunk));
    file_->flush();
  }

  [[nodiscard]] double next_time() const override {
    return schedule_ ? schedule_->next() : Observer::next_time();
  }
  void skip_to(double time) override {
    if (schedule_) schedule_->skip_to(time);
  }
  void observe(const JetSnapshot& snapshot) override {
    append(snapshot);
    schedule_->advance();
  }
  void deposit(const DepositedBead& bead) override { append(bead); }
  void refined(const RefinementRecord& record) override { append(record); }

private:
  template <class Given>
  void append(const Given& row) {
    if constexpr (std::is_same_v<Given, Row>)
      file_->write([&] {
        for (std::size_t i = 0; i < columns_.size(); ++i)
          data_sets_[i]->append(columns_[i].value(row));
      });
  }

  std::shared_ptr<RunFile> file_;
  std::optional<Schedule> schedule_;
  std::vector<RecordColumn<Row>> columns_;
  std::vector<Column*> data_sets_;
};

/// All but the column of that name, if it is not `wanted`.
template <class Row>
std::vector<RecordColumn<Row>> with(bool wanted, std::string_view name,
                                    std::vector<RecordColumn<Row>> columns) {
  if (!wanted) std::erase_if(columns, [&](const auto& c) { return c.name == name; });
  return columns;
}

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

/// One list of columns that are as long as the jet has beads, and where each frame ends in them.
class Frames final : public Observer {
public:
  Frames(std::shared_ptr<RunFile> file, double interval, const BeadTable& table)
      : file_(std::move(file))
      , schedule_(interval)
      , columns_(frame_columns(table)) {
    EHDJET_EXPECTS(interval > 0);
    for (const FrameColumn& c : columns_)
      data_sets_.push_back(&file_->add_column("beads", c, 4 * chunk_rows));
    time_ = &file_->add_column("frames", {"time", "s", "of each frame"}, chunk_rows);
    offset_ = &file_->add_column("frames",
                                 {"offset", "1",
                                  "frame k is the rows offset[k] to offset[k+1] of /beads",
                                  ColumnType::count},
                                 chunk_rows);
    offset_->append(0);
    file_->flush();
  }

  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }

  void observe(const JetSnapshot& snapshot) override {
    EHDJET_EXPECTS(snapshot.columns.beads == snapshot.jet.beads());
    file_->write([&] {
      for (std::size_t i = 0; i < columns_.size(); ++i)
        data_sets_[i]->append(columns_[i].values(snapshot));
      rows_ += snapshot.jet.beads();
      time_->append(snapshot.time);
      offset_->append(static_cast<double>(rows_)); // last: it makes the rows above a frame
    });
    schedule_.advance();
  }

private:
  std::shared_ptr<RunFile> file_;
  Schedule schedule_;
  std::vector<FrameColumn> columns_;
  std::vector<Column*> data_sets_;
  Column *time_ = nullptr, *offset_ = nullptr;
  std::size_t rows_ = 0;
};

class Checkpoints final : public Observer {
public:
  explicit Checkpoints(std::shared_ptr<RunFile> file)
      : file_(std::move(file)) {}
  void checkpoint(const Checkpoint& checkpoint) override { file_->keep(checkpoint); }

private:
  std::shared_ptr<RunFile> file_;
};

} // namespace

std::unique_ptr<Observer> record_observables(std::shared_ptr<RunFile> file, double interval,
                                             bool with_coulomb_error,
                                             std::shared_ptr<Accounts> further) {
  auto columns = with(with_coulomb_error, "coulomb_error", observable_columns());
  if (further) append(columns, further);
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
                                        std::shared_ptr<Accounts> accounts) {
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

std::unique_ptr<Observer> record_checkpoints(std::shared_ptr<RunFile> file) {
  return std::make_unique<Checkpoints>(std::move(file));
}

} // namespace ehdjet
