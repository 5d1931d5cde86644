#pragma once

#include <span>
#include <string>

namespace ehdjet {

/// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

} // namespace ehdjet
