#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// What a quantity is called in CSV files: "vx" in "m/s" is vx_m_s; one without unit has its name.
std::string csv_name(std::string_view name, std::string_view unit);

/// A text as a field of a CSV file: in quotes if it needs them (RFC 4180).
std::string csv_field(std::string_view text);

/// Numbers in a CSV file, read row by row and by the names of their columns.
///
/// The first line that is neither empty nor a comment (#) is the header; if it has only numbers, the
/// comment before it is, which is how numpy.savetxt writes names. Columns may stand in any order;
/// those that were not asked for are ignored.
/// errors : InputError "file:line:column: ..." for a missing file or column, a row of the wrong
///          length, and a field that was asked for and is not a finite number
class CsvTable {
public:
  /// Columns are known by their position in `required` followed by `optional` and, if `others`
  /// are asked for too, all further columns of the file.
  CsvTable(const std::filesystem::path& file, std::vector<std::string> required,
           const std::vector<std::string>& optional, bool others = false);
  /// Reads from a stream, which messages call `name`.
  CsvTable(std::istream& in, std::string name, std::vector<std::string> required,
           const std::vector<std::string>& optional, bool others = false);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  [[nodiscard]] const std::vector<std::string>& columns() const { return wanted_; }

  bool next_row();
  [[nodiscard]] bool has(std::size_t column) const { return position_[column] != absent; }
  /// Value in the present row; 0 for an optional column that the file does not have.
  [[nodiscard]] double value(std::size_t column) const;

  [[nodiscard]] std::size_t line() const { return line_.number; }
  /// Where the column's field starts in the present row, from 1; 0 if the file does not have it.
  [[nodiscard]] std::size_t start(std::size_t column) const;
  [[noreturn]] void refuse(std::size_t start, const std::string& why) const;

private:
  struct Line {
    std::string text;
    std::size_t number = 0;
  };
  struct Field {
    std::string_view text;
    std::size_t start = 0;
  };
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);

  enum class Number { finite, not_finite, out_of_range, with_exponent_d, no_number };
  static Number parse(std::string_view text, double& value);

  void read_header(std::vector<std::string> required,
                   const std::vector<std::string>& optional, bool others);
  void take_header_from(Line comment);
  void refuse_other_separators() const;
  [[noreturn]] void refuse_missing(const std::string& column) const;
  bool next_line(Line* comment = nullptr);
  void split();

  std::string name_;
  std::ifstream file_;
  std::istream* in_;
  Line line_, first_row_; // a first row was read already if the header was a comment
  std::size_t columns_ = 0;
  std::vector<std::string> wanted_;
  std::vector<std::size_t> position_; // of each wanted column in a row
  std::vector<Field> fields_;         // of the present row
};

} // namespace ehdjet
