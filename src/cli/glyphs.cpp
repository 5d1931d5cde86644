#include "glyphs.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/printable.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <fcntl.h>
#include <fmt/format.h>
#include <set>
#include <unistd.h>

#include "program.hpp"

namespace ehdjet::cli {
namespace {

/// The character at this place of valid UTF-8, and its length in bytes.
struct Character {
  std::uint32_t code;
  std::size_t length;
};
Character character_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t k) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text.at(at + k)));
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) code = code << 6U | (byte(k) & 0x3FU);
  return {code, length};
}

/// Latin, Greek, Cyrillic, punctuation, arrows, mathematics and lines, which every usual font has.
bool is_usual(std::uint32_t code) {
  return code < 0x250 || (code >= 0x370 && code < 0x530)
         || (code >= 0x2010 && code < 0x2060) || (code >= 0x2190 && code < 0x2300)
         || (code >= 0x2500 && code < 0x2580);
}

/// Whether one font has them all, as fontconfig says.
bool has_font(const std::set<std::uint32_t>& characters) {
  std::string list;
  for (const std::uint32_t code : characters)
    list += fmt::format("{}{:x}", list.empty() ? "" : " ", code);
  Pipe answer = make_pipe();
  const Descriptor nothing(::open("/dev/null", O_RDWR | O_CLOEXEC)); // NOLINT
  Program question({"fc-list", ":charset=" + list, "family"}, "install fontconfig",
                   nothing.get(), answer.in.get(), nothing.get());
  answer.in.close();
  bool any = false;
  std::array<char, 4096> part{};
  for (ssize_t n = 0; (n = ::read(answer.out.get(), part.data(), part.size())) != 0
                      && (n > 0 || errno == EINTR);)
    any = any || n > 0;
  question.wait();
  return any;
}

std::set<std::uint32_t> without_font(const std::set<std::uint32_t>& characters) {
  constexpr std::size_t most = 200; // questions about a title that nobody reads to its end
  std::set<std::uint32_t> without;
  try {
    if (characters.empty() || (characters.size() <= most && has_font(characters)))
      return {};
    std::size_t asked = 0;
    for (const std::uint32_t code : characters)
      if (++asked > most || !has_font({code})) without.insert(code);
  } catch (const RunError&) { // nobody can say
    return characters;
  }
  return without;
}

} // namespace

std::string replace_without_glyphs(std::vector<std::string>& texts) {
  std::set<std::uint32_t> unusual;
  for (std::string& text : texts) {
    text = printable(text);
    for (std::size_t i = 0; i < text.size();) {
      const Character c = character_at(text, i);
      if (!is_usual(c.code)) unusual.insert(c.code);
      i += c.length;
    }
  }
  const std::set<std::uint32_t> without = without_font(unusual);
  if (without.empty()) return {};
  for (std::string& text : texts) {
    std::string shown;
    for (std::size_t i = 0; i < text.size();) {
      const Character c = character_at(text, i);
      shown += without.contains(c.code) ? "?" : text.substr(i, c.length);
      i += c.length;
    }
    text = shown;
  }
  std::string list;
  std::size_t named = 0;
  for (const std::uint32_t code : without) {
    if (++named > 8) return list + ", ...";
    list += fmt::format("{}U+{:04X}", list.empty() ? "" : ", ", code);
  }
  return list;
}

} // namespace ehdjet::cli
