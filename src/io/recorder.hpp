#pragma once

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/schedule.hpp"
#include "ehdjet/run_files/run_file.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "record_columns.hpp"

namespace ehdjet {

inline constexpr std::size_t chunk_rows = 1024;

/// Writes a part of a run file, at multiples of `interval` [s] or when something happens. `Base` is
/// Observer or ArrayObserver, and `Snapshot` what it observes.
template <class Base, class Snapshot>
class Recorder : public Base {
public:
  Recorder(std::shared_ptr<RunFile> file, std::optional<double> interval)
      : file_(std::move(file)) {
    EHDJET_EXPECTS(!interval || *interval > 0);
    if (interval) schedule_.emplace(*interval);
  }
  [[nodiscard]] double next_time() const final {
    return schedule_ ? schedule_->next() : Base::next_time();
  }
  void skip_to(double time) final {
    if (schedule_) schedule_->skip_to(time);
  }
  void observe(const Snapshot& snapshot) final {
    file_->write([&] { append(snapshot); });
    schedule_->advance();
  }

protected:
  virtual void append(const Snapshot& snapshot) = 0;

  std::shared_ptr<RunFile> file_;

private:
  std::optional<Schedule> schedule_;
};

/// Keeps the last checkpoint of a run in its file.
template <class Base>
class CheckpointRecorder final : public Base {
public:
  explicit CheckpointRecorder(std::shared_ptr<RunFile> file)
      : file_(std::move(file)) {}
  void checkpoint(const Checkpoint& checkpoint) override { file_->keep(checkpoint); }

private:
  std::shared_ptr<RunFile> file_;
};

/// Where the frames of /beads end, and their times.
class FrameTimes {
public:
  /// `beads`: a column of /beads.
  FrameTimes(RunFile& file, const Column& beads)
      : time_(file.add_column("frames", {"time", "s", "of each frame"}, chunk_rows))
      , offset_(file.add_column("frames",
                                {"offset", "1",
                                 "frame k is the rows offset[k] to offset[k+1] of /beads",
                                 ColumnType::count, "offset"},
                                chunk_rows))
      , beads_(beads) {
    if (offset_.rows() == 0) offset_.append(0);
  }
  /// After the beads of a frame have been appended.
  void append(double time) {
    time_.append(time);
    offset_.append(static_cast<double>(beads_.rows())); // last: it completes the frame
  }

private:
  Column &time_, &offset_;
  const Column& beads_;
};

/// Removes the column of that name unless it is `wanted`.
template <class Row>
std::vector<RecordColumn<Row>> with(bool wanted, std::string_view name,
                                    std::vector<RecordColumn<Row>> columns) {
  if (!wanted) std::erase_if(columns, [&](const auto& c) { return c.name == name; });
  return columns;
}

} // namespace ehdjet
