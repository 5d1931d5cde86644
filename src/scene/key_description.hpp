#pragma once

#include <string>
#include <string_view>

namespace ehdjet {

/// What the schema says of a key, "table.key": "must be from 0 to 1 (meaning)".
std::string key_description(std::string_view path);

} // namespace ehdjet
