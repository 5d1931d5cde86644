#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

namespace ehdjet {

/// Beads begin, begin + 1, ..., end - 1 of a chain. By default the whole chain, however long.
struct BeadRange {
  std::size_t begin = 0, end = std::numeric_limits<std::size_t>::max();

  /// The part that a chain of that many beads has.
  [[nodiscard]] BeadRange within(std::size_t beads) const {
    return {std::min(begin, beads), std::min(end, beads)};
  }
  [[nodiscard]] bool covers(std::size_t beads) const { return begin == 0 && end >= beads; }
  [[nodiscard]] std::size_t size() const { return end - begin; }
  bool operator==(const BeadRange&) const = default;
};

} // namespace ehdjet
