#include "ehdjet/io/plot_page.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "page_content.hpp"
#include "page_layout.hpp"

namespace ehdjet {

const std::vector<std::pair<std::string, std::string>>& page_panels() {
  static const std::vector<std::pair<std::string, std::string>> all{
      {"side", "the jet from the side"},
      {"along", "the jet along its axis"},
      {"space", "the jet in space"},
      {"radius", "radius along the jet"},
      {"map", "the fibre on the collector"},
      {"fibre", "length of the deposited fibre by its radius"},
      {"beads", "number of beads over time"},
      {"path", "path length over time"},
      {"tip", "distance of the tip from the axis over time"},
      {"impact", "impact speed over time"}};
  return all;
}

namespace {

bool is_view(const std::string& panel) {
  return panel == "side" || panel == "along" || panel == "space";
}

// What a file lacks for a panel, and the key of a scene that brings it; nothing if it is all there.
std::string lack_of(const std::string& panel, const RunReader& run) {
  if (is_view(panel) || panel == "radius") {
    if (!run.has("frames")) return "has no frames: set output.frames in the scene";
    return run.frame_times().empty() ? "has no frame yet" : "";
  }
  if (panel == "map" || panel == "fibre") {
    if (!run.has("deposit"))
      return "has no deposit: set output.deposit = true in the scene";
    return run.column("deposit", "removal_time").empty()
               ? "has an empty deposit: no bead has left at the collector"
               : "";
  }
  if (!run.has("observables"))
    return "has no observables: set output.observables in the scene";
  if (run.column("observables", "time").empty()) return "has no row of observables yet";
  const bool landed = panel != "impact"
                      || std::ranges::any_of(run.column("observables", "impact_speed"),
                                             [](double v) { return v != 0; });
  return landed ? "" : "has no impact: no bead has landed";
}

bool has_data(const std::string& panel, const RunReader& run) {
  return lack_of(panel, run).empty();
}

std::string joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

// Height of the page below the title and a line for each run.
double below_head(const Canvas& page, bool titled, std::size_t runs) {
  return page.height
         - page.letter
               * ((titled ? 1.45 * 1.35 : 0) + 1.45 * static_cast<double>(runs) + 0.5);
}

} // namespace

bool PlotPage::Content::has_room_for(const std::vector<std::string>& panels) const {
  const auto views = static_cast<std::size_t>(std::ranges::count_if(panels, is_view));
  const Canvas page = canvas();
  return have_room(page, below_head(page, !title.empty(), runs.size()),
                   {.views = views,
                    .diagrams = panels.size() - views,
                    .with_side = std::ranges::find(panels, "side") != panels.end()});
}

// Those that were asked for, or as many as there is room for.
void PlotPage::Content::choose_panels() {
  const auto any_has = [&](const std::string& panel) {
    return std::ranges::any_of(
        runs, [&](const Run& run) { return has_data(panel, *run.of.run); });
  };
  if (!options.panels.empty()) {
    for (const std::string& panel : options.panels) {
      if (shows(panel)) continue;
      if (!any_has(panel)) {
        std::string lacks;
        for (const Run& run : runs)
          lacks += fmt::format("{}{} {}", lacks.empty() ? "" : "; ",
                               run.of.run->path().string(), lack_of(panel, *run.of.run));
        throw InputError(fmt::format("cannot draw the panel {}: {}", panel, lacks));
      }
      shown.push_back(panel);
    }
    if (has_room_for(shown)) return;
    const double height = options.height;
    while (!has_room_for(shown) && options.height < largest) options.height += 10;
    throw InputError(fmt::format(
        "a page of {:g}x{:g} pixels has no room for the panels {}: they need {:g}x{:g}",
        options.width, height, joined(shown), options.width, options.height));
  }
  // The most telling ones first.
  for (const char* panel : {"side", "along", "radius", "space", "map", "fibre", "beads",
                            "path", "tip", "impact"}) {
    if ((options.movie && !is_view(panel) && panel != std::string("radius"))
        || !any_has(panel))
      continue;
    std::vector<std::string> more = shown;
    more.emplace_back(panel);
    if (has_room_for(more))
      shown = std::move(more);
    else
      left_out.emplace_back(panel);
  }
  if (shown.empty())
    throw InputError(fmt::format("{} has neither frames, deposit nor observables to plot",
                                 runs.front().of.run->path().string()));
}

// Who asked for a panel is told that nothing would be in it.
void PlotPage::Content::refuse_if_empty(std::optional<double> until) const {
  if (has_landed(until)) return;
  for (const std::string& panel : options.panels)
    if (panel == "map" || panel == "fibre")
      throw InputError(fmt::format(
          "cannot draw the panel {}: no bead has left at the collector by t = {:.6g} s",
          panel, until.value_or(0)));
}

PlotPage::PlotPage(std::vector<PlottedRun> runs, std::string title, PageOptions options)
    : content_(std::make_unique<Content>()) {
  Content& c = *content_;
  EHDJET_EXPECTS(!runs.empty() && runs.size() <= most_runs);
  c.title = std::move(title), c.options = std::move(options);
  c.options.fixed_axes = c.options.fixed_axes || c.options.movie;
  for (const double size : {c.options.width / least_width, c.options.height / least_height,
                            largest / c.options.width, largest / c.options.height})
    if (!(size >= 1))
      throw InputError(fmt::format(
          "the page would be {:g} by {:g} pixels: the least is {:g} by {:g}, the most {:g}",
          c.options.width, c.options.height, least_width, least_height, largest));
  for (PlottedRun& of : runs)
    c.runs.push_back({.of = std::move(of),
                      .colour = colours::runs[c.runs.size()],
                      .frame_times = {},
                      .deposit = {},
                      .observables = {}});
  c.choose_panels();
  Range most_radii;
  for (Content::Run& run : c.runs) {
    const RunReader& file = *run.of.run;
    if (has_data("side", file)) run.frame_times = file.frame_times();
    if ((c.shows("map") || c.shows("fibre")) && has_data("map", file)) {
      run.deposit.emplace(file);
      for (const Values* radii : {&run.deposit->radius, &run.deposit->dry_radius})
        most_radii.include(run.deposit->most_radii(*radii));
    }
    if (file.has("observables")) {
      run.observables.emplace();
      for (const char* name : {"time", "beads", "path_length", "tip_yz", "impact_speed"})
        run.observables->columns.push_back({name, "", file.column("observables", name)});
    }
    if (c.options.fixed_axes)
      for (std::size_t k = 0; k < run.frame_times.size(); ++k)
        c.all_frames.include(DrawnFrame(file.frame(k)));
  }
  c.bins = RadiusBins(most_radii);
}

PlotPage::~PlotPage() = default;

const std::vector<std::string>& PlotPage::left_out() const {
  return content_->left_out;
}

std::vector<double> PlotPage::frame_times() const {
  for (const Content::Run& run : content_->runs)
    if (!run.frame_times.empty()) return run.frame_times;
  return {};
}

double PlotPage::gif_frames_per_second(double wanted) {
  if (wanted > 50)
    throw InputError(fmt::format(
        "a GIF cannot show {:g} frames per second: players take what is faster than 50 for "
        "10. Choose up to 50, or a name that ends in .mp4",
        wanted));
  return 100 / std::round(100 / wanted);
}

std::string PlotPage::terminal(const std::filesystem::path& output,
                               std::optional<double> frames_per_second) const {
  const std::string extension = output.extension().string();
  const Canvas page = content_->canvas();
  // `name` of gnuplot's terminal, in which letters have another height for the same number.
  const auto set_terminal = [&](const std::string& name, double scale, double unit,
                                const char* unit_name) {
    return fmt::format("set encoding utf8\nset terminal {} size {:g}{},{:g}{} font "
                       "'sans,{:.3g}' fontscale {:.3g}\n",
                       name, page.width * unit, unit_name, page.height * unit, unit_name,
                       0.75 * page.letter, scale);
  };
  if (frames_per_second && extension == ".gif")
    // Every frame with the colours that it has: "optimize" would give all those of the first one.
    return set_terminal(fmt::format("gif animate delay {:.0f}",
                                    100 / gif_frames_per_second(*frames_per_second)),
                        1, 1, "");
  if (extension == (frames_per_second ? ".mp4" : ".png"))
    return set_terminal("pngcairo", 1, 1, "");
  if (frames_per_second)
    throw InputError(fmt::format(
        "cannot draw a movie to {}: the name must end in .gif or .mp4", output.string()));
  if (extension == ".svg") return set_terminal("svg background '#ffffff'", 1.2, 1, "");
  if (extension == ".pdf") return set_terminal("pdfcairo", 0.6, 1.0 / 108, "in");
  throw InputError(fmt::format("cannot plot to {}: the name must end in .png, .svg or .pdf",
                               output.string()));
}

std::vector<std::optional<DrawnFrame>>
PlotPage::Content::frames(std::optional<double> time) const {
  std::vector<std::optional<DrawnFrame>> all;
  for (const Run& run : runs) {
    all.emplace_back();
    if (run.frame_times.empty()) continue;
    std::optional<double> at = time;
    if (time && options.movie) // a run that is over, or has not begun, stands still
      at = std::clamp(*time, run.frame_times.front(), run.frame_times.back());
    all.back().emplace(run.of.run->frame(run.of.run->nearest_frame(at)));
  }
  return all;
}

// Title, and which run at what time has which colour. Sets `top` below them.
std::string PlotPage::Content::head(const std::vector<std::optional<DrawnFrame>>& frames,
                                    const Canvas& page, double& top) const {
  std::string s;
  int label = 1;
  const double letter = page.letter;
  top = below_head(page, !title.empty(), runs.size());
  double below = page.height;
  const auto line = [&](const std::string& text, double size, const char* colour) {
    below -= 1.45 * size;
    s += fmt::format("set label {} {} at {} center font ',{:.3g}' noenhanced tc rgb '{}'\n",
                     label++, Canvas::quoted(Canvas::fitted(text, size, page.width)),
                     page.at(page.width / 2, below + 0.55 * size), 0.75 * size, colour);
  };
  if (!title.empty()) line(title, 1.35 * letter, "black");
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::string text = runs[r].of.label;
    if (frames[r]) {
      const Unit unit = time_unit(frames[r]->frame.time);
      text += fmt::format(",  t = {:.6g} {},  {} beads", frames[r]->frame.time / unit.size,
                          unit.name, frames[r]->frame.rows());
    }
    line((several() ? "\u2500\u2500 " : "") + text, letter,
         several() ? runs[r].colour : "black");
  }
  return s;
}

std::string PlotPage::draw(std::optional<double> time) const {
  const Content& c = *content_;
  const Canvas page = c.canvas();
  const auto frames = c.frames(time);
  Extent extent = c.all_frames;
  std::optional<double> frame_time;
  for (const auto& f : frames)
    if (f) {
      if (!c.options.fixed_axes) extent.include(*f);
      if (!frame_time) frame_time = f->frame.time;
    }
  const std::optional<double> until = time ? frame_time.value_or(*time) : frame_time;

  c.refuse_if_empty(until);
  double top = 0;
  std::string s = "reset\nset border 3 lc rgb '#404040'\nset tics nomirror out scale 0.6\n"
                  "set grid lc rgb '#E4E4E4' lw 1 lt 1\n"
                  "set key samplen 1 opaque box lc rgb '#E4E4E4'\nset multiplot\n";
  s += c.head(frames, page, top);

  // Views of the jet above, diagrams below.
  std::vector<Drawing> views, diagrams;
  const auto panel = [&](Panel p) {
    return [&page, p = std::move(p)](const Box& cell) { return page.draw(p, cell); };
  };
  if (c.shows("side")) views.emplace_back(panel(c.side(frames, extent, false)));
  if (c.shows("along")) views.emplace_back(panel(c.side(frames, extent, true)));
  if (c.shows("space"))
    views.emplace_back([&](const Box& cell) { return c.space(frames, extent, cell); });
  if (c.shows("radius")) diagrams.emplace_back(panel(c.radius(frames, extent)));
  if (c.shows("map") && c.has_landed(until)) diagrams.emplace_back(panel(c.map(until)));
  if (c.shows("fibre") && c.has_landed(until))
    diagrams.emplace_back(panel(c.histogram(until)));
  for (const History& h : histories)
    if (c.shows(h.panel)) diagrams.emplace_back(panel(c.history(h, frame_time)));

  return s + arranged(page, top, views, c.shows("side"), diagrams) + "unset multiplot\n";
}

} // namespace ehdjet
