#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "page_content.hpp"

namespace ehdjet {
namespace {

constexpr double least_length = 1e-3; // of an axis of lengths that are all zero [m]
constexpr double no_length = 1e-8 * least_length; // less than an atom, and round-off [m]

} // namespace

// The jet from the side, or along its axis.
Panel PlotPage::Content::side(const std::vector<std::optional<DrawnFrame>>& frames,
                              const Extent& extent, bool along) const {
  // A straight jet has a view along its axis all the same.
  const double across = extent.across > no_length ? 1.08 * extent.across
                                                  : extent.x.padded(least_length).high / 10;
  const Range width{-across, across};
  const Unit unit = length_unit(along ? 2 * across : extent.x.high - extent.x.low);
  const char *first = along ? "y" : "x", *second = along ? "z" : "y";
  Panel panel{.title = along ? "Along the axis" : "Side view",
              .x = {first, unit, along ? width : extent.x.padded(least_length)},
              .y = {second, unit, width},
              .curves = {},
              .equal_scales = true};
  const double letter = canvas().letter;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (!frames[r]) continue;
    const auto& [frame, jets, arc] = *frames[r];
    panel.curves.push_back(
        {.style = frame.rows() > 600 * jets.size()
                      ? "lines lw 1.3"
                      : fmt::format("linespoints lw 1.3 pt 7 ps {:.2g}", 0.02 * letter),
         .colour = runs[r].colour,
         .x = frame[first],
         .y = frame[second],
         .lines = jets});
    Curve nozzles{.style = fmt::format("points pt 5 ps {:.2g}", 0.06 * letter),
                  .colour = "black",
                  .x = {},
                  .y = {},
                  .lines = {},
                  .name = r == 0 && !along ? start() : ""};
    Curve landed{.style = fmt::format("points pt 7 ps {:.2g}", 0.06 * letter),
                 .colour = several() ? runs[r].colour : colours::vermillion,
                 .x = {},
                 .y = {},
                 .lines = {},
                 .name = several() || along ? "" : "landed"};
    const auto add = [&, &frame = frame](Curve& curve, std::size_t k) {
      curve.x.push_back(frame[first][k]), curve.y.push_back(frame[second][k]);
      curve.lines.assign({{0, curve.x.size()}});
    };
    for (const BeadRange& jet : jets) add(nozzles, jet.begin);
    for (std::size_t k = 0; k < frame.rows(); ++k)
      if (frame["landed"][k] != 0) add(landed, k);
    panel.curves.push_back(std::move(nozzles));
    if (!landed.x.empty()) panel.curves.push_back(std::move(landed));
  }
  return panel;
}

std::string PlotPage::Content::space(const std::vector<std::optional<DrawnFrame>>& frames,
                                     const Extent& extent, const Box& cell) const {
  std::vector<Canvas::Line> lines;
  for (std::size_t r = 0; r < frames.size(); ++r)
    if (frames[r])
      lines.push_back({frames[r]->frame["x"], frames[r]->frame["y"], frames[r]->frame["z"],
                       frames[r]->jets, runs[r].colour});
  const Range x = extent.x.padded(least_length);
  // gnuplot draws a very slender box beyond its cell.
  const double across = std::max(1.08 * extent.across, 0.2 * (x.high - x.low));
  return canvas().draw_in_space(lines, x, across, length_unit(x.high - x.low), cell);
}

Panel PlotPage::Content::radius(const std::vector<std::optional<DrawnFrame>>& frames,
                                const Extent& extent) const {
  const bool wide = extent.radius.high > 4 * extent.radius.low;
  const Unit unit = length_unit(extent.radius.high);
  const Range arc{0, extent.arc.high > 0 ? extent.arc.high : least_length};
  Range r = extent.radius.padded(least_length);
  if (wide) r = {extent.radius.low / 1.2, extent.radius.high * 1.2};
  Panel panel{.title = fmt::format("Radius along the jet ({})", unit.name),
              .x = {fmt::format("length from the {}", start()), length_unit(arc.high), arc},
              .y = {"", unit, r, wide},
              .curves = {}};
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (frames[k])
      panel.curves.push_back({.style = "lines lw 1.5",
                              .colour = runs[k].colour,
                              .x = frames[k]->arc,
                              .y = frames[k]->frame["radius"],
                              .lines = frames[k]->jets,
                              .function = true});
  return panel;
}

Panel PlotPage::Content::map(std::optional<double> time) const {
  Panel panel{.title = "Fibre on the collector",
              .x = {"y"},
              .y = {"z"},
              .curves = {},
              .equal_scales = true};
  for (const Run& run : runs) {
    if (!run.deposit) continue;
    const DepositedFibre& d = *run.deposit;
    const std::size_t beads = time ? d.landed_by(*time) : d.y.size();
    panel.curves.push_back(d.on_collector(beads, run.colour));
    if (options.fixed_axes)
      panel.x.range.include(d.y), panel.y.range.include(d.z);
    else
      panel.x.range.include(panel.curves.back().x),
          panel.y.range.include(panel.curves.back().y);
  }
  const auto is_point = [](const Range& r) { return r.high - r.low < no_length; };
  if (is_point(panel.x.range) && is_point(panel.y.range)) // a line would not be seen
    for (Curve& curve : panel.curves)
      curve.style = fmt::format("points pt 7 ps {:.2g}", 0.06 * canvas().letter);
  panel.x.range = panel.x.range.padded(least_length);
  panel.y.range = panel.y.range.padded(least_length);
  panel.x.unit = panel.y.unit = length_unit(std::max(
      panel.x.range.high - panel.x.range.low, panel.y.range.high - panel.y.range.low));
  return panel;
}

Panel PlotPage::Content::histogram(std::optional<double> time) const {
  const Range& radii = bins.radii();
  Panel panel{.title = "",
              .x = {"radius", length_unit(radii.high), radii, bins.logarithmic()},
              .y = {},
              .curves = {}};
  double most = 0;
  for (const Run& run : runs) {
    if (!run.deposit) continue;
    const DepositedFibre& d = *run.deposit;
    const auto add = [&](const Values& radius, const char* colour, const char* name) {
      const std::size_t all = d.radius.size();
      const Values length = bins.lengths(d, radius, time ? d.landed_by(*time) : all);
      most =
          std::max(most, std::ranges::max(options.fixed_axes ? bins.lengths(d, radius, all)
                                                             : length));
      Curve steps{.style = several() ? "lines lw 1.5"
                                     : "filledcurves y1=0 fs solid 0.4 border lw 1.5",
                  .colour = colour,
                  .x = {},
                  .y = {},
                  .lines = {{0, 2 * RadiusBins::number + 2}},
                  .name = name};
      steps.x.push_back(bins.edge(0)), steps.y.push_back(0);
      for (std::size_t i = 0; i < RadiusBins::number; ++i)
        for (const std::size_t end : {i, i + 1})
          steps.x.push_back(bins.edge(end)), steps.y.push_back(length[i]);
      steps.x.push_back(bins.edge(RadiusBins::number)), steps.y.push_back(0);
      panel.curves.push_back(std::move(steps));
    };
    const bool dries = !d.dry_radius.empty() && !several();
    add(d.radius, several() ? run.colour : colours::vermillion,
        dries ? "as it landed" : "");
    if (dries) add(d.dry_radius, colours::blue, "dry");
  }
  panel.y.unit = length_unit(most);
  panel.y.range = {0, most > 0 ? 1.1 * most : least_length};
  panel.title = fmt::format("Length of fibre by radius ({})", panel.y.unit.name);
  return panel;
}

Panel PlotPage::Content::history(const History& of, std::optional<double> time) const {
  Panel panel;
  panel.title = of.title, panel.x.name = "time";
  for (const Run& run : runs) {
    if (!run.observables) continue;
    Curve curve{.style = "lines lw 2",
                .colour = several() ? run.colour : of.colour,
                .x = (*run.observables)["time"],
                .y = (*run.observables)[of.column],
                .lines = {},
                .function = true};
    const auto first = static_cast<std::size_t>( // the speed is 0 before the first landing
        of.after_first_landing
            ? std::ranges::find_if(curve.y, [](double v) { return v != 0; })
                  - curve.y.begin()
            : 0);
    if (first < curve.x.size()) curve.lines = {{first, curve.x.size()}};
    panel.x.range.include(curve.x);
    panel.y.range.include(
        Values(curve.y.begin() + static_cast<std::ptrdiff_t>(first), curve.y.end()));
    panel.curves.push_back(std::move(curve));
  }
  if (!(panel.x.range.high > panel.x.range.low)) panel.x.range = panel.x.range.padded();
  panel.x.unit = time_unit(panel.x.range.high);
  const double least = of.length ? least_length : 1;
  panel.y.range = panel.y.range.padded(least);
  if (panel.y.range.high == least && panel.y.range.low == -least)
    panel.y.least_step = 0.5; // of an axis without numbers but zero
  if (of.length) {
    panel.y.unit = length_unit(panel.y.range.high);
    panel.title += fmt::format(" ({})", panel.y.unit.name);
  }
  if (of.counted) {
    panel.y.least_step = 1;
    if (const double middle = (panel.y.range.low + panel.y.range.high) / 2;
        panel.y.range.high - panel.y.range.low < 2)
      panel.y.range = {middle - 1.1, middle + 1.1};
  }
  if (time) panel.marked = *time;
  return panel;
}

} // namespace ehdjet
