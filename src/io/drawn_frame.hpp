#pragma once

#include "ehdjet/run_files/run_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "panel.hpp"
#include "record_columns.hpp"

namespace ehdjet {

/// A frame [SI], with the lines that its jets are, and the arc length of each bead from its nozzle on [m].
struct DrawnFrame {
  Frame frame;
  std::vector<BeadRange> jets;
  Values arc;

  explicit DrawnFrame(Frame f)
      : frame(std::move(f))
      , jets(jets_of(frame))
      , arc(frame.rows()) {
    const Values &x = frame["x"], &y = frame["y"], &z = frame["z"];
    for (const BeadRange& jet : jets)
      for (std::size_t k = jet.begin + 1; k < jet.end; ++k)
        arc[k] = arc[k - 1] + std::hypot(x[k] - x[k - 1], y[k] - y[k - 1], z[k] - z[k - 1]);
  }
};

/// What the axes of some frames have room for [m].
struct Extent {
  Range x, radius, arc;
  double across = 0; ///< largest |y| or |z|

  void include(const DrawnFrame& f) {
    x.include(f.frame["x"]), arc.include(f.arc);
    for (const char* name : {"y", "z"})
      for (const double value : f.frame[name])
        if (std::isfinite(value)) across = std::max(across, std::abs(value));
    for (const double r : f.frame["radius"])
      if (r > 0) radius.include(r);
  }
};

} // namespace ehdjet
