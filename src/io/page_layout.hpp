#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "panel.hpp"

/// Where the panels of a page are: views of the jet in the upper rows, the one from the side twice as wide as the
/// others, and diagrams below them.
namespace ehdjet {

/// Numbers of panels.
struct PanelNumbers {
  std::size_t views, diagrams;
  bool with_side; ///< the first view is that from the side
};

/// Whether panels between the lower edge and `top` [px] would be large enough to be read.
bool have_room(const Canvas& page, double top, const PanelNumbers& numbers);

/// Commands that draw a panel into a cell.
using Drawing = std::function<std::string(const Box&)>;

/// Commands that draw all of them below `top` [px].
std::string arranged(const Canvas& page, double top, const std::vector<Drawing>& views,
                     bool with_side, const std::vector<Drawing>& diagrams);

} // namespace ehdjet
