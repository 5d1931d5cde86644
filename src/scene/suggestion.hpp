#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// " (did you mean b?)" with the nearest of `known`, or nothing if none is near. Paths
/// "table.key" that differ in the table alone are taken as near: the key is in the wrong table.
[[nodiscard]] std::string suggestion(std::string_view wrong,
                                     const std::vector<std::string>& known);

} // namespace ehdjet
