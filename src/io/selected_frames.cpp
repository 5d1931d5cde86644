#include "selected_frames.hpp"

namespace ehdjet {

std::size_t selected_frame(const RunReader& run, std::optional<double> time) {
  const std::size_t frames = run.frame_times().size();
  return time || frames == 0 ? run.nearest_frame(time.value_or(0)) : frames - 1;
}

FrameRange selected_frames(const RunReader& run, std::optional<double> time) {
  const std::size_t frame = selected_frame(run, time);
  return {time ? frame : 0, frame + 1};
}

} // namespace ehdjet
