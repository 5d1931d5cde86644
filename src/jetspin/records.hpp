#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Lines of a JETSPIN input file as JETSPIN reads them: at most 150 characters, lower case, words separated by
/// blanks.
namespace ehdjet {

/// A number in a record.
struct RecordNumber {
  double value = 0;
  std::size_t end = 0;           ///< of its text in the record
  bool is_integer = false;       ///< digits alone
  bool distant_exponent = false; ///< the exponent was found further on in the record
};

class Record {
public:
  static constexpr std::size_t longest = 150;

  Record(std::string_view line, std::size_t number);

  [[nodiscard]] std::size_t line() const { return line_; }
  /// Blank, or begins with # or !.
  [[nodiscard]] bool is_comment() const;
  /// Whether a word begins like that.
  [[nodiscard]] bool has(std::string_view keyword) const;
  [[nodiscard]] bool has_word(std::string_view word) const;
  /// The first number from there on, wherever it is: "nozzle2 3.d-2" has the number 2. The exponent of
  /// "1.d" are the next digits in the record, however far away, or 0 if there are none. None if there is no digit, if the
  /// number has two points or is beyond double precision.
  [[nodiscard]] std::optional<RecordNumber> number(std::size_t from = 0) const;
  /// Whether anything but blanks stands beyond the last character that is read.
  [[nodiscard]] bool is_cut() const { return cut_; }

  [[nodiscard]] const std::string& text() const { return text_; }
  /// For messages: without characters that do not print, at most 60 of them.
  [[nodiscard]] std::string shown() const;
  /// The first `count` words, without numbers.
  [[nodiscard]] std::vector<std::string_view> words(std::size_t count) const;

private:
  std::size_t line_;
  std::string text_;
  bool cut_ = false;
};

/// The lines of a file, without their ends (LF or CR LF).
std::vector<std::string_view> lines_of(std::string_view text);

} // namespace ehdjet
