#pragma once

#include <cstddef>
#include <string_view>

namespace ehdjet {

/// Levenshtein distance: insertions, deletions and replacements of single characters.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

} // namespace ehdjet
