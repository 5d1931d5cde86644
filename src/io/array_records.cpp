#include "ehdjet/io/records.hpp"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "record_columns.hpp"
#include "recorder.hpp"

namespace ehdjet {
namespace {

using ArrayRecorder = Recorder<ArrayObserver, ArraySnapshot>;

class Observables final : public ArrayRecorder {
public:
  Observables(std::shared_ptr<RunFile> file, double interval, bool coulomb_error)
      : ArrayRecorder(std::move(file), interval)
      , columns_(with(coulomb_error, "coulomb_error", array_observable_columns())) {
    for (const auto& c : columns_)
      data_sets_.push_back(&file_->add_column("observables", c, chunk_rows));
    file_->flush();
  }
  void archive(const Archive& a) override { ehdjet::archive(a, "observables", columns_); }

private:
  void append(const ArraySnapshot& snapshot) override {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      data_sets_[i]->append(columns_[i].value(snapshot));
  }

  std::vector<RecordColumn<ArraySnapshot>> columns_;
  std::vector<Column*> data_sets_;
};

/// Writes the beads of all jets of a frame, jet after jet, and where each frame ends.
class Frames final : public ArrayRecorder {
public:
  Frames(std::shared_ptr<RunFile> file, double interval, const BeadTable& table)
      : ArrayRecorder(std::move(file), interval)
      , columns_(frame_columns(table)) {
    for (const FrameColumn& c : columns_)
      data_sets_.push_back(&file_->add_column("beads", c, 4 * chunk_rows));
    jet_ = &file_->add_column("beads", jet_column(), 4 * chunk_rows);
    times_ = std::make_unique<FrameTimes>(*file_, *data_sets_.front());
    file_->flush();
  }

private:
  void append(const ArraySnapshot& snapshot) override {
    for (std::size_t j = 0; j < snapshot.jets.size(); ++j) {
      const JetSnapshot jet = snapshot.jet(j);
      for (std::size_t i = 0; i < columns_.size(); ++i)
        data_sets_[i]->append(columns_[i].values(jet));
      for (std::size_t k = 0; k < jet.jet.beads(); ++k)
        jet_->append(static_cast<double>(j));
    }
    times_->append(snapshot.time);
  }

  std::vector<FrameColumn> columns_;
  std::vector<Column*> data_sets_;
  Column* jet_ = nullptr;
  std::unique_ptr<FrameTimes> times_;
};

/// Writes a part that has one row per `Row`, each of one jet.
template <class Row>
class RowsOfJets final : public ArrayObserver {
public:
  RowsOfJets(std::shared_ptr<RunFile> file, const char* part,
             std::vector<RecordColumn<Row>> columns, std::size_t rows_of_chunk)
      : file_(std::move(file))
      , columns_(std::move(columns)) {
    for (const auto& c : columns_)
      data_sets_.push_back(&file_->add_column(part, c, rows_of_chunk));
    jet_ = &file_->add_column(part, jet_column(), rows_of_chunk);
    file_->flush();
  }
  void deposit(std::size_t j, const DepositedBead& bead) override { append(j, bead); }
  void refined(std::size_t j, const RefinementRecord& record) override {
    append(j, record);
  }

private:
  template <class Other>
  void append(std::size_t /*j*/, const Other& /*row*/) {}
  void append(std::size_t j, const Row& row) {
    file_->write([&] {
      for (std::size_t i = 0; i < columns_.size(); ++i)
        data_sets_[i]->append(columns_[i].value(row));
      jet_->append(static_cast<double>(j));
    });
  }

  std::shared_ptr<RunFile> file_;
  std::vector<RecordColumn<Row>> columns_;
  std::vector<Column*> data_sets_;
  Column* jet_ = nullptr;
};

} // namespace

std::unique_ptr<ArrayObserver> record_array_observables(std::shared_ptr<RunFile> file,
                                                        double interval,
                                                        bool coulomb_error) {
  return std::make_unique<Observables>(std::move(file), interval, coulomb_error);
}

std::unique_ptr<ArrayObserver> record_array_frames(std::shared_ptr<RunFile> file,
                                                   double interval,
                                                   const BeadTable& table) {
  return std::make_unique<Frames>(std::move(file), interval, table);
}

std::unique_ptr<ArrayObserver>
record_array_deposit(std::shared_ptr<RunFile> file,
                     std::shared_ptr<const BeadTable> table) {
  return std::make_unique<RowsOfJets<DepositedBead>>(
      std::move(file), "deposit", deposit_columns(std::move(table)), chunk_rows);
}

std::unique_ptr<ArrayObserver> record_array_refinements(std::shared_ptr<RunFile> file) {
  return std::make_unique<RowsOfJets<RefinementRecord>>(
      std::move(file), "refinements",
      with(false, "coulomb_energy_change", refinement_columns()), chunk_rows / 4);
}

std::unique_ptr<ArrayObserver> record_array_checkpoints(std::shared_ptr<RunFile> file) {
  return std::make_unique<CheckpointRecorder<ArrayObserver>>(std::move(file));
}

} // namespace ehdjet
