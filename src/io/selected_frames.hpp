#pragma once

#include "ehdjet/io/run_reader.hpp"

#include <cstddef>
#include <optional>

namespace ehdjet {

struct FrameRange {
  std::size_t first, end;
};

/// The frame nearest to `time`, or the last one. errors : InputError if there is none yet
std::size_t selected_frame(const RunReader& run, std::optional<double> time);

/// The frame nearest to `time`, or all of them. errors : InputError if there is none yet
FrameRange selected_frames(const RunReader& run, std::optional<double> time);

} // namespace ehdjet
