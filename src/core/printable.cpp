#include "ehdjet/core/printable.hpp"

#include <cstddef>

namespace ehdjet {
namespace {

/// Number of bytes of the UTF-8 character at the start of the text; 0 if there is none (RFC 3629).
std::size_t character(std::string_view text) {
  const auto byte = [&](std::size_t k) {
    return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U;
  };
  const auto follows = [&](std::size_t k) { return (byte(k) & 0xC0U) == 0x80; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4 || !follows(1)) return 0;
  if (first < 0xE0) return 2;
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0)
      || (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90))
    return 0; // too long a code, a surrogate, or beyond the last character
  if (!follows(2)) return 0;
  if (first < 0xF0) return 3;
  return follows(3) ? 4 : 0;
}

/// C0 and C1 controls, delete, and the marks that turn the direction of writing.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return first < 0x20 || first == 0x7F;
  const auto second = static_cast<unsigned char>(character[1]);
  if (character.size() == 2) return first == 0xC2 && second < 0xA0;
  return (character >= "\u202A" && character <= "\u202E")
         || (character >= "\u2066" && character <= "\u2069");
}

} // namespace

std::string printable(std::string_view text, std::string_view keep) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character(text);
    const std::string_view next = text.substr(0, length == 0 ? 1 : length);
    text.remove_prefix(next.size());
    if (length > 0 && (!is_control(next) || keep.find(next) != std::string_view::npos)) {
      result += next;
      continue;
    }
    for (const char c : next) {
      const unsigned byte = static_cast<unsigned char>(c);
      result += {'\\', 'x', digits[byte >> 4U], digits[byte & 15U]};
    }
  }
  return result;
}

} // namespace ehdjet
