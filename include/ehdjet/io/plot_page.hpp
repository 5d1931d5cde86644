#pragma once

#include "ehdjet/run_files/run_reader.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ehdjet {

/// A run on a page, and what distinguishes it there from the others.
struct PlottedRun {
  const RunReader* run;
  std::string label;
  bool has_nozzle = true; ///< bead 0 is one, not the first of a free chain
};

struct PageOptions {
  double width = 1600, height = 1200; ///< [px]; of PDF pages 108 px are an inch
  /// Some of `page_panels`; if empty, all of which there are data and for which there is room, in a movie those of
  /// the jet.
  std::vector<std::string> panels{};
  bool fixed_axes = false; ///< axes have room for all frames, whichever is drawn
  bool movie = false;      ///< fixed axes, and a run that is over keeps its last frame
};

/// The panels of a page, by name and what they show.
const std::vector<std::pair<std::string, std::string>>& page_panels();

/// Draws one run, or several in the same axes, on a page: gnuplot commands. A panel of which no run has
/// the data is left out, unless it was asked for. The runs must live as long as the page.
///
/// errors : InputError if nothing is left to draw, the size is out of its range, or a panel that was asked for has
///          no data or no room
class PlotPage {
public:
  static constexpr std::size_t most_runs = 8; ///< as many colours can be distinguished
  static constexpr double least_width = 480, least_height = 360, largest = 10000; ///< [px]

  PlotPage(std::vector<PlottedRun> runs, std::string title, PageOptions options);
  ~PlotPage();
  PlotPage(const PlotPage&) = delete;
  PlotPage& operator=(const PlotPage&) = delete;

  /// Commands that choose the format by the extension: .png, .svg or .pdf, and for a movie .gif or
  /// .mp4, whose pages are PNG images for ffmpeg. errors : InputError for another one
  [[nodiscard]] std::string terminal(const std::filesystem::path& output,
                                     std::optional<double> frames_per_second = {}) const;
  /// The frames nearest to `time`, by default the last ones, and what landed until then.
  [[nodiscard]] std::string draw(std::optional<double> time) const;
  /// The panels that have data but no room.
  [[nodiscard]] const std::vector<std::string>& left_out() const;
  /// The nearest speed that a GIF can have, whose frames are shown for whole hundredths of a second.
  /// errors : InputError above 50, which players do not show
  static double gif_frames_per_second(double wanted);
  /// Times of all frames of the first run that has any [s].
  [[nodiscard]] std::vector<double> frame_times() const;

private:
  struct Content;
  std::unique_ptr<Content> content_;
};

} // namespace ehdjet
