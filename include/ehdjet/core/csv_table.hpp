#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// What a quantity is called in CSV files: "vx" in "m/s" is vx_m_s; one without unit has its name.
std::string csv_name(std::string_view name, std::string_view unit);

/// Numbers in a CSV file, read row by row and by the names of their columns.
///
/// The first line that is neither empty nor a comment (#) is the header. Columns may stand in any
/// order; those that were not asked for are ignored.
/// errors : InputError "file:line:column: ..." for a missing file or column, a row of the wrong
///          length, and a field that was asked for and is not a finite number
class CsvTable {
public:
  /// Columns are known by their position in `required` followed by `optional` and, if `others`
  /// are asked for too, all further columns of the file.
  CsvTable(const std::filesystem::path& file, std::vector<std::string> required,
           const std::vector<std::string>& optional, bool others = false);

  [[nodiscard]] const std::vector<std::string>& columns() const { return wanted_; }

  bool next_row();
  [[nodiscard]] bool has(std::size_t column) const { return position_[column] != absent; }
  /// Value in the present row; 0 for an optional column that the file does not have.
  [[nodiscard]] double value(std::size_t column) const;

  [[nodiscard]] std::size_t line() const { return line_number_; }
  /// Where the column's field starts in the present row, from 1; 0 if the file does not have it.
  [[nodiscard]] std::size_t start(std::size_t column) const;
  [[noreturn]] void refuse(std::size_t start, const std::string& why) const;

private:
  struct Field {
    std::string_view text;
    std::size_t start = 0;
  };
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);

  bool next_line();
  void split();

  std::string name_, line_;
  std::ifstream in_;
  std::size_t line_number_ = 0, columns_ = 0;
  std::vector<std::string> wanted_;
  std::vector<std::size_t> position_; // of each wanted column in a row
  std::vector<Field> fields_;         // of the present row
};

} // namespace ehdjet
