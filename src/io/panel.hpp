#pragma once

#include "ehdjet/jet/bead_range.hpp"

#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// One diagram as gnuplot commands. Values are in SI units; an axis says in which unit it shows them.
namespace ehdjet {

using Values = std::vector<double>;

struct Unit {
  const char* name; ///< empty for a pure number
  double size;      ///< [SI unit]
};
/// The unit in which numbers up to `extent` [m] or [s] are easily read; of zero, millimetres and seconds.
Unit length_unit(double extent);
Unit time_unit(double extent);

/// From the smallest to the largest of the finite numbers that were included.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void include(double value);
  void include(const Values& values);
  void include(const Range& other);
  [[nodiscard]] bool empty() const { return !(low <= high); }
  /// With a margin on both sides. Never empty, because gnuplot refuses an empty range: where all numbers are zero
  /// but for round-off, from -least to least.
  [[nodiscard]] Range padded(double least = 1) const;
};

struct Axis {
  std::string name; ///< empty: the title of the panel says what it is
  Unit unit{"", 1};
  Range range{};
  bool logarithmic = false;
  double least_step = 0; ///< between ticks: 1 for whole numbers
};

/// A line of points, broken between the `lines`.
struct Curve {
  std::string style; ///< gnuplot's `with ...`
  std::string colour;
  Values x, y;
  std::vector<BeadRange> lines;
  std::string name{}; ///< in the key; empty: not there
  /// A function of x: of points that share a pixel only the extremes are drawn.
  bool function = false;
};

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
  bool equal_scales = false; ///< a metre is as long along x as along y
  double marked = std::numeric_limits<double>::quiet_NaN(); ///< x of a dashed line
};

/// In pixels, from the lower left corner of the page.
struct Box {
  double left, bottom, width, height;
};

/// The page: its size and that of its letters [px].
struct Canvas {
  double width, height, letter;

  /// In gnuplot's single quotes, in which it expands nothing.
  static std::string quoted(std::string_view text);
  /// Commands for a point in fractions of the page.
  [[nodiscard]] std::string at(double x, double y) const;
  /// The text, or its start with dots, in letters of this size in so much room [px].
  static std::string fitted(const std::string& text, double size, double room);
  /// Commands for a title around `middle`, within the cell.
  [[nodiscard]] std::string titled(const std::string& title, double middle, double y,
                                   const Box& cell) const;
  /// Draws the panel into its cell, with ticks as far apart as their labels need.
  [[nodiscard]] std::string draw(const Panel& panel, const Box& cell) const;
  /// Draws lines in space; the first axis points down the page.
  struct Line {
    Values x, y, z;
    std::vector<BeadRange> lines;
    std::string colour;
  };
  [[nodiscard]] std::string draw_in_space(const std::vector<Line>& lines, const Range& x,
                                          double across, const Unit& unit,
                                          const Box& cell) const;
};

} // namespace ehdjet
