#pragma once

#include "ehdjet/run_files/run_reader.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace ehdjet {

struct FrameRange {
  std::size_t first, end;
};

/// The frame nearest to `time`, or all of them. errors : InputError if there is none yet
inline FrameRange selected_frames(const RunReader& run, std::optional<double> time) {
  const std::size_t last = run.nearest_frame(time);
  return {time ? last : 0, last + 1};
}

/// A column of a frame, or zeros if the run had none.
inline std::vector<double> column_or_zeros(const Frame& frame, std::string_view name) {
  const RunTable::Column* found = frame.find(name);
  return found != nullptr ? found->values : std::vector<double>(frame.rows());
}

} // namespace ehdjet
