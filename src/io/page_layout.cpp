#include "page_layout.hpp"

#include <algorithm>

namespace ehdjet {
namespace {

struct Rows {
  std::size_t views, diagrams, most; // numbers of rows; of diagrams in one
  double view_height, diagram_height;
  bool have_room;
};

Rows rows_of(const Canvas& page, double top, const PanelNumbers& numbers) {
  const auto [views, diagrams, with_side] = numbers;
  const double letters = page.width / page.letter;
  const auto most = static_cast<std::size_t>(std::clamp(letters / 20, 1.0, 4.0));
  Rows rows{.views = views > 0 ? 1U : 0U,
            .diagrams = (diagrams + most - 1) / most,
            .most = most,
            .view_height = 0,
            .diagram_height = 0,
            .have_room = true};
  // On a narrow page the view from the side has a row of its own.
  if (with_side && views > 1 && letters < 15 * static_cast<double>(views + 1))
    rows.views = 2;
  const double share = 1.8; // height of a view in those of a diagram
  const auto below = static_cast<double>(rows.diagrams),
             above = share * static_cast<double>(rows.views);
  rows.diagram_height = top / std::max(above + below, 1.0);
  rows.view_height = rows.views > 0 ? share * top / (above + below) : 0;
  rows.have_room = (rows.views == 0 || rows.view_height >= 14 * page.letter)
                   && (rows.diagrams == 0 || rows.diagram_height >= 10 * page.letter);
  return rows;
}

} // namespace

bool have_room(const Canvas& page, double top, const PanelNumbers& numbers) {
  return rows_of(page, top, numbers).have_room;
}

std::string arranged(const Canvas& page, double top, const std::vector<Drawing>& views,
                     bool with_side, const std::vector<Drawing>& diagrams) {
  const Rows rows = rows_of(page, top, {views.size(), diagrams.size(), with_side});
  std::string s;
  const auto add = [&](const std::string& drawn) {
    s += drawn + "unset label\n"; // every panel would draw the head again
  };
  std::size_t i = 0;
  for (std::size_t row = 0; row < rows.views; ++row) {
    top -= rows.view_height;
    const bool side_alone = row == 0 && rows.views == 2;
    const std::size_t end = side_alone ? 1 : views.size();
    const bool twice = with_side && i == 0 && !side_alone;
    const double part = page.width / static_cast<double>(end - i + (twice ? 1 : 0));
    for (double left = 0; i < end; ++i) {
      const double width = twice && i == 0 ? 2 * part : part;
      add(views[i]({left, top, width, rows.view_height}));
      left += width;
    }
  }
  i = 0;
  for (std::size_t row = 0; row < rows.diagrams; ++row) {
    top -= rows.diagram_height;
    // Rows have equally many panels, or the upper ones have one more.
    const std::size_t left = rows.diagrams - row,
                      panels = (diagrams.size() - i + left - 1) / left;
    const double width = page.width / static_cast<double>(panels);
    for (std::size_t k = 0; k < panels; ++k, ++i)
      add(diagrams[i]({width * static_cast<double>(k), top, width, rows.diagram_height}));
  }
  return s;
}

} // namespace ehdjet
