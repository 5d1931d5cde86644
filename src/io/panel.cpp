#include "panel.hpp"

#include "ehdjet/core/printable.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace ehdjet {
namespace {

// A step of 1, 2 or 5 times a power of ten, with which a range has at most `most` ticks. One tick alone shows no
// scale: where it would be the only one, the longest step with two, if their labels have some room.
double tick_step(const Range& r, double most) {
  const double extent = r.high - r.low, least = extent / std::max(most, 1.0);
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  const auto ticks = [&](double step) {
    return 1 + std::floor(r.high / step + 1e-9) - std::ceil(r.low / step - 1e-9);
  };
  double usual = 10 * power;
  for (const double step : {5.0, 2.0, 1.0})
    if (step * power >= least) usual = step * power;
  if (ticks(usual) >= 2) return usual;
  for (const double ten : {10.0, 1.0, 0.1})
    for (const double step : {8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.5, 1.0})
      if (const double shorter = step * ten * power;
          shorter < usual && shorter > 0.6 * least && ticks(shorter) >= 2)
        return shorter;
  return usual;
}

// Ticks of a logarithmic axis: as many of 1, 2 and 5 times powers of ten as there is room for.
std::string logarithmic_ticks(const Range& r, double most) {
  const int first = static_cast<int>(std::floor(std::log10(r.low))),
            last = static_cast<int>(std::ceil(std::log10(r.high)));
  std::vector<double> ticks, next;
  for (const auto& mantissas : {std::vector{1., 2., 3., 5., 7.}, std::vector{1., 2., 5.},
                                std::vector{1., 3.}, std::vector{1.}}) {
    next.clear();
    for (int e = first; e <= last; ++e)
      for (const double m : mantissas)
        if (const double t = m * std::pow(10.0, e); t >= r.low && t <= r.high)
          next.push_back(t);
    if (!ticks.empty() && next.size() < 2) break; // one alone shows no scale
    ticks = next;
    if (static_cast<double>(ticks.size()) <= most) break;
  }
  auto every = static_cast<std::size_t>(
      std::ceil(static_cast<double>(ticks.size()) / std::max(most, 1.0)));
  if (most >= 1.5 && ticks.size() >= 2) every = std::min(every, ticks.size() - 1);
  std::string text;
  for (std::size_t i = 0; i < ticks.size(); i += every)
    text += fmt::format("{}{:g}", text.empty() ? "" : ",", ticks[i]);
  return '(' + text + ')';
}

// `label`: the room that a tick's label needs along the axis [px].
std::string axis_commands(char name, const Axis& axis, const Range& shown, double length,
                          double label) {
  const double most = std::min(length / label, 12.0);
  const Range r{shown.low / axis.unit.size, shown.high / axis.unit.size};
  // Within less than half a decade, a logarithmic axis would have one tick or none.
  const bool as_logarithm = axis.logarithmic && r.high > 3 * r.low;
  return fmt::format(
      "{} logscale {}\nset {}range [{:.9g}:{:.9g}]\nset {}tics {}\n",
      axis.logarithmic ? "set" : "unset", name, name, r.low, r.high, name,
      as_logarithm ? logarithmic_ticks(r, most)
                   : fmt::format("{:.9g}", std::max(tick_step(r, most), axis.least_step)));
}

// A range in which a pixel is `scale` wide, with the same middle.
Range with_scale(const Range& range, double scale, double pixels) {
  const double middle = (range.low + range.high) / 2, half = scale * pixels / 2;
  return {middle - half, middle + half};
}

// The rows that are drawn: of many, every so many or the extremes of those in one pixel.
void append_rows(std::string& block, const Curve& c, BeadRange line, double pixels,
                 const Unit& x, const Unit& y) {
  const auto append = [&](std::size_t i) {
    block += fmt::format("{:.7g} {:.7g}\n", c.x[i] / x.size, c.y[i] / y.size);
  };
  constexpr std::size_t most_rows = 20000; // more than the page has pixels
  const auto group = std::max<std::size_t>(
      1, c.function ? line.size() / static_cast<std::size_t>(4 * pixels + 1)
                    : line.size() / most_rows + 1);
  for (std::size_t i = line.begin; i < line.end; i += group) {
    const std::size_t end = std::min(i + group, line.end);
    if (!c.function || end - i < 3) {
      append(i);
      if (c.function && end - i == 2) append(i + 1);
      continue;
    }
    const auto first = c.y.begin() + static_cast<std::ptrdiff_t>(i);
    const auto [low, high] =
        std::minmax_element(first, c.y.begin() + static_cast<std::ptrdiff_t>(end));
    append(static_cast<std::size_t>(std::min(low, high) - c.y.begin()));
    append(static_cast<std::size_t>(std::max(low, high) - c.y.begin()));
  }
}

std::string with_unit(const std::string& name, const Unit& unit) {
  return *unit.name == '\0' ? name : fmt::format("{} ({})", name, unit.name);
}

} // namespace

Unit length_unit(double extent) {
  if (!(extent > 0)) return {"mm", 1e-3};
  if (extent >= 1) return {"m", 1};
  if (extent >= 0.01) return {"cm", 1e-2};
  if (extent >= 5e-4) return {"mm", 1e-3};
  return extent >= 5e-7 ? Unit{"µm", 1e-6} : Unit{"nm", 1e-9};
}

Unit time_unit(double extent) {
  if (extent >= 1 || !(extent > 0)) return {"s", 1};
  return extent >= 1e-3 ? Unit{"ms", 1e-3} : Unit{"µs", 1e-6};
}

void Range::include(double value) {
  if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
}

void Range::include(const Values& values) {
  for (const double value : values) include(value);
}

void Range::include(const Range& other) {
  low = std::min(low, other.low), high = std::max(high, other.high);
}

Range Range::padded(double least) const {
  if (empty()) return {0, least};
  const double largest = std::max(std::abs(low), std::abs(high));
  if (largest < 1e-8 * least) return {-least, least};
  // Labels would not tell numbers apart that differ by less.
  const double margin = high - low > 1e-5 * largest ? 0.06 * (high - low) : 0.1 * largest;
  return {low - margin, high + margin};
}

std::string Canvas::quoted(std::string_view text) {
  std::string result(1, '\'');
  for (const char c : printable(text)) result.append(c == '\'' ? 2 : 1, c);
  return result + '\'';
}

std::string Canvas::fitted(const std::string& text, double size, double room) {
  // Roughly 0.6 letters are as wide as the font is high, those of East Asia are as wide as that.
  const auto wide = [&](std::size_t i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    return (byte & 0xC0U) == 0x80U ? 0.0 : size * (byte < 0xE3U ? 0.6 : 1.05);
  };
  double all = 0;
  std::size_t end = 0; // of what there is room for beside the dots
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (all <= room - 1.8 * size && wide(i) > 0) end = i;
    all += wide(i);
  }
  return all <= room ? text : text.substr(0, end) + "...";
}

std::string Canvas::titled(const std::string& title, double middle, double y,
                           const Box& cell) const {
  const std::string shown = fitted(title, letter, cell.width);
  // In the middle of the axes, but not beyond the cell.
  const auto letters = static_cast<double>(std::ranges::count_if(
      shown, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
  const double half = std::min(0.3 * letter * letters, cell.width / 2);
  const double x = std::clamp(middle, cell.left + half, cell.left + cell.width - half);
  return fmt::format("unset title\nset label 100 {} at {} center noenhanced\n",
                     quoted(shown), at(x, y));
}

std::string Canvas::at(double x, double y) const {
  return fmt::format("screen {:.5f},{:.5f}", x / width, y / height);
}

std::string Canvas::draw(const Panel& panel, const Box& cell) const {
  const bool named = !panel.y.name.empty();
  const double left = cell.left + (named ? 6 : 4.4) * letter,
               right = cell.left + cell.width - letter, bottom = cell.bottom + 3.7 * letter,
               top = cell.bottom + cell.height - 2.2 * letter;
  Range x = panel.x.range, y = panel.y.range;
  if (panel.equal_scales) {
    const double scale =
        std::max((x.high - x.low) / (right - left), (y.high - y.low) / (top - bottom));
    x = with_scale(x, scale, right - left), y = with_scale(y, scale, top - bottom);
  }
  std::string s =
      fmt::format("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
                  "set bmargin at screen {:.5f}\nset tmargin at screen {:.5f}\n",
                  left / width, right / width, bottom / height, top / height);
  s += titled(panel.title, (left + right) / 2, top + 0.9 * letter, cell);
  s += fmt::format("set xlabel {} offset 0,0.4\n",
                   quoted(fitted(with_unit(panel.x.name, panel.x.unit), letter,
                                 right - left + 4 * letter)));
  s += named ? fmt::format("set ylabel {} offset 0.5,0\n",
                           quoted(with_unit(panel.y.name, panel.y.unit)))
             : "unset ylabel\n";
  s += axis_commands('x', panel.x, x, right - left, 3.5 * letter);
  s += axis_commands('y', panel.y, y, top - bottom, 2 * letter);
  if (std::isfinite(panel.marked))
    s += fmt::format("set arrow 1 from first {0:.7g}, graph 0 to first {0:.7g}, graph 1 "
                     "nohead lc rgb '#999999' dt 2 lw 1.5 back\n",
                     panel.marked / panel.x.unit.size);
  std::string plots;
  bool key = false;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& c = panel.curves[i];
    s += fmt::format("$curve{} << EOD\n", i);
    for (const BeadRange& line : c.lines) {
      append_rows(s, c, line, right - left, panel.x.unit, panel.y.unit);
      s += '\n';
    }
    if (c.lines.empty()) s += "NaN NaN\n";
    s += "EOD\n";
    plots +=
        fmt::format("{}$curve{} with {} lc rgb '{}' {}", i == 0 ? "" : ", ", i, c.style,
                    c.colour, c.name.empty() ? "notitle" : "title " + quoted(c.name));
    key = key || !c.name.empty();
  }
  s += key ? "set key top left Left reverse\n" : "unset key\n";
  return s + "plot " + plots + "\nunset arrow 1\n";
}

std::string Canvas::draw_in_space(const std::vector<Line>& lines, const Range& x,
                                  double across, const Unit& unit, const Box& cell) const {
  // Room for the title above and for labels around the box.
  const double left = cell.left + 4 * letter, right = cell.left + cell.width - 2.2 * letter,
               bottom = cell.bottom + 2.6 * letter,
               top = cell.bottom + cell.height - 2.6 * letter;
  // The box as it is seen, and how many pixels a metre has so that it fits. With a square between the margins gnuplot
  // draws the y axis of a box that is not turned as long as its side, whatever the other axes need.
  const double turn = 40 * std::numbers::pi / 180, tilt = 65 * std::numbers::pi / 180;
  const double base = 2 * across * (std::cos(turn) + std::sin(turn)),
               seen_height = base * std::cos(tilt) + (x.high - x.low) * std::sin(tilt);
  const double scale = std::min((right - left) / base, (top - bottom) / seen_height);
  const double half = scale * across, middle_x = (left + right) / 2,
               middle_y = (bottom + top) / 2;
  // gnuplot does not turn an axis around while scales are equal. The axis is -x, its labels are x.
  const double m = unit.size;
  const Range shown_x{x.low / m, x.high / m}, shown_across{-across / m, across / m};
  const double room = 2 * half / letter; // of the horizontal axes [letters]
  const double step = tick_step(shown_across, std::clamp(room / 3.5, 1.7, 4.0)),
               step_x = tick_step(shown_x, std::clamp((x.high - x.low) * scale
                                                          * std::sin(tilt) / (2 * letter),
                                                      2.0, 6.0));
  std::string labels;
  const auto first = static_cast<int>(std::ceil(shown_x.low / step_x)),
             last = static_cast<int>(std::floor(shown_x.high / step_x));
  for (int i = first; i <= last; ++i)
    labels +=
        fmt::format("{}'{:g}' {:.7g}", labels.empty() ? "" : ",", i * step_x, -i * step_x);
  std::string s =
      fmt::format("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
                  "set bmargin at screen {:.5f}\nset tmargin at screen {:.5f}\n",
                  (middle_x - half) / width, (middle_x + half) / width,
                  (middle_y - half) / height, (middle_y + half) / height);
  s += titled(fmt::format("In space ({})", unit.name), cell.left + cell.width / 2,
              cell.bottom + cell.height - 1.3 * letter, cell);
  s += fmt::format(
      "unset key\nunset logscale\n"
      "set xlabel 'y' offset 0,0\nset ylabel 'z' offset 0,0\nset zlabel 'x' offset 2,0\n"
      "set view 65,40\nset view equal xyz\nset xyplane at -{1:.7g}\n"
      "set border 4095 lc rgb '#C8C8C8'\n"
      "set xrange [-{2:.7g}:{2:.7g}]\nset xtics {3:.7g} offset 0,-0.3\n"
      "set yrange [-{2:.7g}:{2:.7g}]\nset ytics {3:.7g} offset 0,-0.3\n"
      "set zrange [-{1:.7g}:-({0:.7g})]\nset ztics ({4})\nset tics textcolor rgb "
      "'#404040'\n",
      shown_x.low, shown_x.high, shown_across.high, step, labels);
  std::string plots;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& c = lines[i];
    s += fmt::format("$curve{} << EOD\n", i);
    for (const BeadRange& line : c.lines) {
      const std::size_t stride = line.size() / 20000 + 1;
      for (std::size_t k = line.begin; k < line.end; k += stride)
        s += fmt::format("{:.7g} {:.7g} {:.7g}\n", c.y[k] / m, c.z[k] / m, -c.x[k] / m);
      s += "\n\n"; // a single empty line would make a mesh of lines of equal length
    }
    s += "EOD\n";
    plots += fmt::format("{}$curve{} with lines lc rgb '{}' lw 1.3", i == 0 ? "" : ", ", i,
                         c.colour);
  }
  return s + "splot " + plots + "\nset border 3 lc rgb '#404040'\nset tics offset 0,0\n";
}

} // namespace ehdjet
