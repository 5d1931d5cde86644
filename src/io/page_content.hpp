#pragma once

#include "ehdjet/io/plot_page.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "deposited_fibre.hpp"
#include "drawn_frame.hpp"
#include "panel.hpp"

/// A page of plots: its runs, and its panels (page_panels.cpp).
namespace ehdjet {

namespace colours { // those of Okabe and Ito, which colour-blind readers can distinguish
inline constexpr const char* blue = "#0072B2";
inline constexpr const char* vermillion = "#D55E00";
inline constexpr const char* green = "#009E73";
inline constexpr const char* purple = "#CC79A7";
inline constexpr const char* runs[PlotPage::most_runs] = {
    blue, vermillion, green, purple, "#E69F00", "#56B4E9", "#000000", "#999999"};
} // namespace colours

/// A quantity of which a panel shows the history.
struct History {
  const char *panel, *title, *column, *colour;
  bool length = false, after_first_landing = false, counted = false;
};
inline constexpr History histories[] = {
    {"beads", "Beads", "beads", colours::blue, false, false, true},
    {"path", "Path length", "path_length", colours::vermillion, true},
    {"tip", "Tip: distance from the axis", "tip_yz", colours::green, true},
    {"impact", "Impact speed (m/s)", "impact_speed", colours::purple, false, true}};

struct PlotPage::Content {
  struct Run {
    PlottedRun of;
    const char* colour;
    Values frame_times;
    std::optional<DepositedFibre> deposit;
    std::optional<RunTable> observables;
  };

  std::vector<Run> runs;
  std::string title;
  PageOptions options;
  std::vector<std::string> shown, left_out; // names of panels
  Extent all_frames;                        // with fixed axes
  RadiusBins bins;

  [[nodiscard]] bool several() const { return runs.size() > 1; }
  /// What bead 0 is in all runs.
  [[nodiscard]] const char* start() const {
    const bool nozzles =
        std::ranges::all_of(runs, [](const Run& run) { return run.of.has_nozzle; });
    return nozzles ? "nozzle" : "first bead";
  }
  [[nodiscard]] bool shows(const std::string& panel) const {
    return std::ranges::find(shown, panel) != shown.end();
  }
  /// Whether there is a fibre by then, or axes that wait for it.
  [[nodiscard]] bool has_landed(std::optional<double> time) const {
    return options.fixed_axes || !time || std::ranges::any_of(runs, [&](const Run& run) {
             return run.deposit && run.deposit->landed_by(*time) > 0;
           });
  }
  [[nodiscard]] Canvas canvas() const {
    const double least = std::min(options.width, options.height);
    return {options.width, options.height,
            std::max(10.0, 0.0115
                               * std::min(std::sqrt(options.width * options.height),
                                          1.75 * least))};
  }
  void choose_panels();
  [[nodiscard]] bool has_room_for(const std::vector<std::string>& panels) const;
  void refuse_if_empty(std::optional<double> until) const;

  [[nodiscard]] std::vector<std::optional<DrawnFrame>>
  frames(std::optional<double> time) const;
  [[nodiscard]] Panel side(const std::vector<std::optional<DrawnFrame>>& frames,
                           const Extent& extent, bool along) const;
  [[nodiscard]] std::string space(const std::vector<std::optional<DrawnFrame>>& frames,
                                  const Extent& extent, const Box& cell) const;
  [[nodiscard]] Panel radius(const std::vector<std::optional<DrawnFrame>>& frames,
                             const Extent& extent) const;
  [[nodiscard]] Panel map(std::optional<double> time) const;
  [[nodiscard]] Panel histogram(std::optional<double> time) const;
  [[nodiscard]] Panel history(const History& of, std::optional<double> time) const;
  [[nodiscard]] std::string head(const std::vector<std::optional<DrawnFrame>>& frames,
                                 const Canvas& page, double& top) const;
};

} // namespace ehdjet
