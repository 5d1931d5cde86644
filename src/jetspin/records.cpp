#include "records.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <system_error>

namespace ehdjet {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::size_t end_of_digits(std::string_view text, std::size_t begin) {
  while (begin < text.size() && is_digit(text[begin])) ++begin;
  return begin;
}

} // namespace

Record::Record(std::string_view line, std::size_t number)
    : line_(number)
    , text_(line.substr(0, longest))
    , cut_(line.size() > longest
           && line.find_first_not_of(' ', longest) != std::string_view::npos) {
  text_.erase(0, std::min(text_.find_first_not_of(' '), text_.size()));
  text_.erase(text_.find_last_not_of(' ') + 1);
  std::ranges::transform(text_, text_.begin(), lower);
}

bool Record::is_comment() const {
  return text_.empty() || text_.front() == '#' || text_.front() == '!';
}

bool Record::has(std::string_view keyword) const {
  for (std::size_t at = text_.find(keyword); at != std::string::npos;
       at = text_.find(keyword, at + 1))
    if (at == 0 || text_[at - 1] == ' ') return true;
  return false;
}

bool Record::has_word(std::string_view word) const {
  return fmt::format(" {} ", text_).find(fmt::format(" {} ", word)) != std::string::npos;
}

std::optional<RecordNumber> Record::number(std::size_t from) const {
  const std::string_view text = text_;
  const std::size_t begin = text.find_first_of(".0123456789", from);
  if (begin == std::string_view::npos) return {};
  std::size_t end = end_of_digits(text, begin);
  RecordNumber n{.is_integer = true};
  if (end < text.size() && text[end] == '.')
    end = end_of_digits(text, end + 1), n.is_integer = false;
  std::string digits(text.substr(begin, end - begin));
  if (digits == "." || (end < text.size() && text[end] == '.')) return {};
  if (end < text.size() && (text[end] == 'd' || text[end] == 'e')) {
    n.is_integer = false;
    const std::size_t mark = end;
    const std::size_t exponent =
        std::min(text.find_first_of("0123456789", mark), text.size());
    const bool negative = text[exponent - 1] == '-';
    end = end_of_digits(text, exponent);
    digits += (negative ? "e-" : "e+")
              + (exponent < end ? std::string(text.substr(exponent, end - exponent)) : "0");
    const bool has_sign = negative || text[exponent - 1] == '+';
    n.distant_exponent = exponent < end && exponent - (has_sign ? 1 : 0) != mark + 1;
  }
  const char* last = digits.data() + digits.size();
  if (const auto read = std::from_chars(digits.data(), last, n.value);
      read.ec != std::errc{} || read.ptr != last)
    return {};
  if (begin > from && text[begin - 1] == '-') n.value = -n.value;
  n.end = end;
  return n;
}

std::string Record::shown() const {
  constexpr std::size_t most = 60;
  std::string text = text_.substr(0, most);
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text_.size() > most ? text + "..." : text;
}

std::vector<std::string_view> Record::words(std::size_t count) const {
  std::vector<std::string_view> found;
  const std::string_view text = text_;
  for (std::size_t at = 0; at < text.size() && found.size() < count;) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    if (!word.empty() && word.front() >= 'a' && word.front() <= 'z') found.push_back(word);
    at = end + 1;
  }
  return found;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

} // namespace ehdjet
