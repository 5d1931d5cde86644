#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "record_columns.hpp"

namespace ehdjet {
namespace {

using Values = std::vector<double>;

// The colours of Okabe and Ito, which colour-blind readers can distinguish.
constexpr const char* blue = "#0072B2";
constexpr const char* green = "#009E73";
constexpr const char* vermillion = "#D55E00";
constexpr const char* purple = "#CC79A7";
constexpr const char* grey = "#999999";

constexpr double page_width = 1600, page_height = 1000; // [px]

struct Unit {
  const char* name;
  double size; // [SI unit]
};

Unit length_unit(double extent) {
  if (extent >= 1) return {"m", 1};
  if (extent >= 0.01) return {"cm", 1e-2};
  return extent >= 1e-4 ? Unit{"mm", 1e-3} : Unit{"µm", 1e-6};
}

Unit time_unit(double extent) {
  if (extent >= 1) return {"s", 1};
  return extent >= 1e-3 ? Unit{"ms", 1e-3} : Unit{"µs", 1e-6};
}

struct Range {
  double low, high;
};

Range range_of(const Values& values) {
  Range range{std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()};
  for (const double value : values)
    if (std::isfinite(value))
      range = {std::min(range.low, value), std::max(range.high, value)};
  return range;
}

// Adds a margin to the range. The result is never empty, because gnuplot refuses an empty range.
Range padded(Range range) {
  if (!(range.low <= range.high)) return {0, 1};
  const double margin = range.high > range.low ? 0.06 * (range.high - range.low)
                        : range.high != 0      ? 0.1 * std::abs(range.high)
                                               : 1;
  return {range.low - margin, range.high + margin};
}

double largest(const Values& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

std::string in_quotes(std::string_view text) { // in gnuplot's single quotes
  std::string result(1, '\'');
  for (const char c : text) result.append(c == '\'' ? 2 : 1, c);
  return result + '\'';
}

// A box in fractions of the page, measured from the lower left corner.
struct Box {
  double left, right, bottom, top;
};

std::string place(const Box& box) {
  return fmt::format("set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n"
                     "set bmargin at screen {:.4f}\nset tmargin at screen {:.4f}\n",
                     box.left, box.right, box.bottom, box.top);
}

// Several `lines` are kept apart.
std::string data_block(const char* name, const Values& a, const Values& b, double unit_a,
                       double unit_b, const std::vector<BeadRange>& lines) {
  constexpr std::size_t most_rows = 20000; // more than the page has pixels
  const std::size_t stride = a.size() / most_rows + 1;
  std::string block = fmt::format("${} << EOD\n", name);
  for (const BeadRange& line : lines) {
    if (line.begin > 0) block += '\n';
    for (std::size_t i = line.begin; i < line.end; i += stride)
      block += fmt::format("{:.7g} {:.7g}\n", a[i] / unit_a, b[i] / unit_b);
  }
  return block + "EOD\n";
}

std::string data_block(const char* name, const Values& a, const Values& b, double unit_a,
                       double unit_b) {
  return data_block(name, a, b, unit_a, unit_b, {{0, a.size()}});
}

std::string terminal(const std::filesystem::path& output) {
  const std::string extension = output.extension().string();
  const auto size = [](double unit) {
    return fmt::format("{:g},{:g}", page_width * unit, page_height * unit);
  };
  if (extension == ".png") return "pngcairo size " + size(1) + " font 'sans,15'";
  if (extension == ".svg")
    return "svg size " + size(1) + " font 'sans,18' background '#ffffff'";
  if (extension == ".pdf") // 108 px per inch gives the same proportions of text and page
    return fmt::format("pdfcairo size {:g}in,{:g}in font 'sans,14'", page_width / 108,
                       page_height / 108);
  throw InputError(fmt::format("cannot plot to {}: the name must end in .png, .svg or .pdf",
                               output.string()));
}

// The ranges of the two views [m], and the unit of their axes.
struct Extent {
  Range x;
  double across; // largest |y| or |z|
  Unit unit;
};

// Coordinates of the deposited beads across the axis [m].
struct Deposited {
  Values y, z;
};

Extent extent_of(const Frame& f, const Deposited& deposit) {
  const double across =
      std::max({largest(f["y"]), largest(f["z"]), largest(deposit.y), largest(deposit.z)});
  Range x = range_of(f["x"]);
  // A chain in a plane x = const also gets a view of some width.
  const double least = std::max({x.high - x.low, 0.3 * across, 1e-9});
  x.high = x.low + least;
  return {{x.low - 0.02 * least, x.high + 0.02 * least},
          std::max(1.08 * across, 0.1 * least),
          length_unit(least)};
}

// Boxes for the two views. A metre has the same length in both views and both directions.
std::pair<Box, Box> view_boxes(const Extent& extent, double bottom, double top) {
  const double left = 0.07, gap = 0.085, right = 0.985;
  const double width = extent.x.high - extent.x.low + 2 * extent.across; // of both [m]
  const double metre = std::min((top - bottom) * page_height / (2 * extent.across),
                                (right - left - gap) * page_width / width); // [px]
  const double half_height = metre * extent.across / page_height,
               middle = (top + bottom) / 2;
  const double start = left + (right - left - gap - metre * width / page_width) / 2;
  const double side_end = start + metre * (extent.x.high - extent.x.low) / page_width;
  const double end = side_end + gap + metre * 2 * extent.across / page_width;
  return {{start, side_end, middle - half_height, middle + half_height},
          {side_end + gap, end, middle - half_height, middle + half_height}};
}

// The beads that have left the chain until `time` [s].
Deposited landed_by(double time, const RunReader& run) {
  if (!run.has("deposit")) return {};
  const RunTable deposit = run.table("deposit");
  const Values& removal = deposit["removal_time"];
  const auto later = [&](double t) { return t > time; };
  const auto beads =
      static_cast<std::size_t>(std::ranges::find_if(removal, later) - removal.begin());
  Deposited landed{deposit["y"], deposit["z"]};
  landed.y.resize(beads), landed.z.resize(beads);
  return landed;
}

// The jet from the side and along its axis.
std::string views(const Frame& f, const Deposited& deposit, double bottom, double top) {
  const Extent extent = extent_of(f, deposit);
  const auto [side, along] = view_boxes(extent, bottom, top);
  const double m = extent.unit.size;
  Values x, y, z; // of landed beads
  for (std::size_t k = 0; k < f.rows(); ++k)
    if (f["landed"][k] != 0)
      x.push_back(f["x"][k]), y.push_back(f["y"][k]), z.push_back(f["z"][k]);
  const std::vector<BeadRange> jets = jets_of(f);
  Values nozzle_x, nozzle_y, nozzle_z;
  for (const BeadRange& jet : jets)
    nozzle_x.push_back(f["x"][jet.begin]), nozzle_y.push_back(f["y"][jet.begin]),
        nozzle_z.push_back(f["z"][jet.begin]);
  std::string s = data_block("side", f["x"], f["y"], m, m, jets)
                  + data_block("along", f["y"], f["z"], m, m, jets)
                  + data_block("landed_side", x, y, m, m)
                  + data_block("landed_along", y, z, m, m)
                  + data_block("deposit", deposit.y, deposit.z, m, m)
                  + data_block("nozzle_side", nozzle_x, nozzle_y, m, m)
                  + data_block("nozzle_along", nozzle_y, nozzle_z, m, m);
  const std::string jet =
      fmt::format("with linespoints lc rgb '{}' lw 1.3 pt 7 ps 0.35 notitle", blue);
  const std::string nozzle = "with points lc rgb 'black' pt 5 ps 1.1 ";
  const std::string landed =
      fmt::format("with points lc rgb '{}' pt 7 ps 1.1 ", vermillion);
  s += place(side)
       + fmt::format("set title 'Side view' offset 0,-0.4\nset key top left Left reverse\n"
                     "set xlabel 'x  ({0})'\nset ylabel 'y  ({0})' offset 1,0\n"
                     "set xrange [{1:.7g}:{2:.7g}]\nset yrange [-{3:.7g}:{3:.7g}]\n",
                     extent.unit.name, extent.x.low / m, extent.x.high / m,
                     extent.across / m)
       + "plot $side " + jet + ", $nozzle_side " + nozzle + "title 'nozzle'";
  if (!x.empty()) s += ", $landed_side " + landed + "title 'landed'";
  s += "\nunset label 1\n";
  s += place(along)
       + fmt::format("set title 'Along the axis' offset 0,-0.4\n{2}\n"
                     "set xlabel 'y  ({0})'\nset ylabel 'z  ({0})' offset 1,0\n"
                     "set xrange [-{1:.7g}:{1:.7g}]\nset yrange [-{1:.7g}:{1:.7g}]\nplot ",
                     extent.unit.name, extent.across / m,
                     deposit.y.empty() ? "unset key" : "");
  if (!deposit.y.empty())
    s +=
        fmt::format("$deposit with points lc rgb '{}' pt 7 ps 0.4 title 'deposit', ", grey);
  s += "$along " + jet + ", $nozzle_along " + nozzle + "notitle";
  if (!x.empty()) s += ", $landed_along " + landed + "notitle";
  return s + "\n";
}

struct Panel {
  const char* title;
  std::string unit; // empty if the values have none
  const char* colour;
  Values values; // NaN where there is no value
};

std::vector<Panel> panels(const RunReader& run) {
  const auto with_length_unit = [&](const char* title, const char* column,
                                    const char* colour) {
    Values values = run.column("observables", column);
    const Unit unit = length_unit(largest(values));
    for (double& value : values) value /= unit.size;
    return Panel{title, unit.name, colour, std::move(values)};
  };
  Values impact = run.column("observables", "impact_speed");
  // The speed is 0 before the first bead has landed.
  std::ranges::replace(impact, 0.0, std::numeric_limits<double>::quiet_NaN());
  return {{"Beads", "", blue, run.column("observables", "beads")},
          with_length_unit("Path length", "path_length", vermillion),
          with_length_unit("Tip: distance from the axis", "tip_yz", green),
          {"Impact speed", "m/s", purple, std::move(impact)}};
}

std::string draw(const Panel& panel, const Values& time, const Unit& unit, const Box& box) {
  const Range range = range_of(panel.values), shown = padded(range), times = range_of(time);
  const double end = times.high > times.low ? times.high : times.low + unit.size;
  const std::string in_unit = panel.unit.empty() ? "" : "  (" + panel.unit + ")";
  return data_block("panel", time, panel.values, unit.size, 1) + place(box)
         + fmt::format("set title '{}{}' offset 0,-0.4\nunset key\nunset ylabel\n"
                       "set xlabel 'time  ({})'\n"
                       "set xrange [{:.7g}:{:.7g}]\nset yrange [{:.7g}:{:.7g}]\n{}"
                       "plot $panel with lines lc rgb '{}' lw 2\n"
                       "unset label 1\nunset label 99\n",
                       panel.title, in_unit, unit.name, times.low / unit.size,
                       end / unit.size, shown.low, shown.high,
                       range.low <= range.high
                           ? ""
                           : "set label 99 'none yet' at graph 0.5,0.5 center\n",
                       panel.colour);
}

std::string observables(const RunReader& run, std::optional<double> frame_time,
                        double bottom, double top, std::size_t per_row) {
  const Values time = run.column("observables", "time");
  const std::vector<Panel> all = panels(run);
  const Unit unit = time_unit(largest(time));
  const std::size_t rows = all.size() / per_row;
  const double width = 0.955 / static_cast<double>(per_row);
  const double height = (top - bottom) / static_cast<double>(rows);
  std::string s = "set tics font ',13'\n";
  if (frame_time) // marks the time of the views
    s += fmt::format(
        "set arrow 1 from first {0:.7g}, graph 0 to first {0:.7g}, graph 1 nohead "
        "lc rgb '{1}' dt 2 lw 1.5 back\n",
        *frame_time / unit.size, grey);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t row = i / per_row;
    const double left = 0.03 + width * static_cast<double>(i % per_row);
    const double ceiling = top - height * static_cast<double>(row);
    s += draw(
        all[i], time, unit,
        {left + 0.04, left + width - 0.005, ceiling - height + 0.075, ceiling - 0.045});
  }
  return s;
}

} // namespace

std::string plot_page(const RunReader& run, std::optional<double> time,
                      const std::filesystem::path& output) {
  std::string s = fmt::format("set encoding utf8\nset terminal {}\nset output {}\n",
                              terminal(output), in_quotes(output.string()));
  const bool has_frames = run.has("frames") && !run.frame_times().empty();
  const bool has_observables =
      run.has("observables") && !run.column("observables", "time").empty();
  if (!has_frames && !has_observables)
    throw InputError(run.path().string() + " has neither frames nor observables to plot");
  s +=
      "set border 3 lc rgb '#404040'\nset tics nomirror out scale 0.6\n"
      "set grid lc rgb '#E4E4E4' lw 1 lt 1\nset key samplen 1 opaque box lc rgb '#E4E4E4'\n"
      "set multiplot\n";
  std::string views_text, heading = run.path().filename().string();
  std::optional<double> frame_time;
  if (has_frames) {
    const Frame frame = run.frame(run.nearest_frame(time));
    const Unit unit = time_unit(frame.time);
    frame_time = frame.time;
    heading += fmt::format(",  t = {:.6g} {},  {} beads", frame.time / unit.size, unit.name,
                           frame.rows());
    views_text =
        views(frame, landed_by(frame.time, run), has_observables ? 0.42 : 0.1, 0.895);
  }
  s += fmt::format("set label 1 {} at screen 0.5,0.968 center font ',20' noenhanced\n",
                   in_quotes(heading));
  s += views_text; // draws the label once and then unsets it
  if (has_observables)
    s += observables(run, frame_time, 0.01, has_frames ? 0.345 : 0.93, has_frames ? 4 : 2);
  return s + "unset multiplot\nunset output\n";
}

} // namespace ehdjet
