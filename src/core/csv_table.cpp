#include "ehdjet/core/csv_table.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

namespace ehdjet {

std::string csv_name(std::string_view name, std::string_view unit) {
  std::string full(name);
  if (unit.empty() || unit == "1") return full;
  full += '_';
  for (const char c : unit)
    if (c == '/' || c == ' ')
      full += '_';
    else if (c != '^')
      full += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return full;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

CsvTable::CsvTable(const std::filesystem::path& file, std::vector<std::string> required,
                   const std::vector<std::string>& optional, bool others)
    : name_(file.string())
    , file_(file)
    , in_(&file_) {
  std::error_code error;
  if (const bool folder = std::filesystem::is_directory(file, error); folder || !file_)
    throw InputError(name_ + ": cannot be read ("
                     + (folder ? "it is a folder" : std::generic_category().message(errno))
                     + ")");
  read_header(std::move(required), optional, others);
}

CsvTable::CsvTable(std::istream& in, std::string name, std::vector<std::string> required,
                   const std::vector<std::string>& optional, bool others)
    : name_(std::move(name))
    , in_(&in) {
  read_header(std::move(required), optional, others);
}

void CsvTable::read_header(std::vector<std::string> required,
                           const std::vector<std::string>& optional, bool others) {
  wanted_ = std::move(required);
  const std::size_t required_count = wanted_.size();
  wanted_.insert(wanted_.end(), optional.begin(), optional.end());
  position_.assign(wanted_.size(), absent);

  Line comment;
  if (!next_line(&comment)) refuse(1, "no header line with the names of the columns");
  split();
  take_header_from(comment);
  if (fields_.size() == 1) refuse_other_separators();
  columns_ = fields_.size();
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const auto column = static_cast<std::size_t>(std::ranges::find(wanted_, fields_[i].text)
                                                 - wanted_.begin());
    if (column == wanted_.size()) {
      if (!others || fields_[i].text.empty()) continue;
      wanted_.emplace_back(fields_[i].text), position_.push_back(absent);
    }
    std::size_t& position = position_[column];
    if (position != absent)
      refuse(fields_[i].start, "column " + std::string(fields_[i].text) + " appears twice");
    position = i;
  }
  for (std::size_t c = 0; c < required_count; ++c)
    if (!has(c)) refuse_missing(wanted_[c]);
}

// numpy.savetxt writes the names as a comment: "# x,y,z". The line after it is then the first row.
void CsvTable::take_header_from(Line comment) {
  const auto is_number = [](const Field& f) {
    double ignored = 0;
    return parse(f.text, ignored) == Number::finite;
  };
  const auto is_wanted = [&](const Field& f) {
    return std::ranges::find(wanted_, f.text) != wanted_.end();
  };
  const std::size_t columns = fields_.size();
  if (comment.number == 0 || !std::ranges::all_of(fields_, is_number)) return;
  std::swap(line_, comment);
  split();
  if (fields_.size() == columns && std::ranges::any_of(fields_, is_wanted)) {
    first_row_ = std::move(comment);
  } else {
    std::swap(line_, comment);
    split();
  }
}

void CsvTable::refuse_other_separators() const {
  const std::string_view text = fields_[0].text;
  for (const auto& [separator, name] :
       {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}, std::pair{' ', "spaces"}})
    if (text.find(separator) != std::string_view::npos)
      refuse(1,
             std::string("the columns are separated by ") + name
                 + ": they must be separated by commas, and numbers have a decimal point");
}

void CsvTable::refuse_missing(const std::string& column) const {
  double ignored = 0;
  const bool no_names = parse(fields_[0].text, ignored) == Number::finite;
  refuse(1, "column " + column + " is missing from the header"
                + (no_names ? ": the first line that is not a comment (#) has the names "
                              "of the columns"
                            : ""));
}

bool CsvTable::next_row() {
  if (first_row_.number > 0)
    line_ = std::exchange(first_row_, {});
  else if (!next_line())
    return false;
  split();
  if (fields_.size() != columns_)
    refuse(1, std::to_string(fields_.size()) + " fields, but the header has "
                  + std::to_string(columns_));
  return true;
}

double CsvTable::value(std::size_t column) const {
  if (!has(column)) return 0;
  const std::string_view text = fields_[position_[column]].text;
  const std::size_t start = fields_[position_[column]].start;
  const auto refuse_value = [&](const char* quote, const char* why) {
    refuse(start, (wanted_[column] + " = ")
                      .append(quote)
                      .append(text)
                      .append(quote)
                      .append(": ")
                      .append(why));
  };
  double value = 0;
  switch (parse(text, value)) {
  case Number::finite:
    break;
  case Number::out_of_range:
    refuse_value("", "too large or too small");
    break;
  case Number::not_finite:
    refuse_value("", "must be finite");
    break;
  case Number::with_exponent_d:
    refuse_value("\"", "must be a number; write E instead of D before its exponent");
    break;
  case Number::no_number:
    refuse_value("\"", "must be a number");
    break;
  }
  return value;
}

CsvTable::Number CsvTable::parse(std::string_view text, double& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.begin(), text.end(), value);
  if (error == std::errc::result_out_of_range) return Number::out_of_range;
  if (error != std::errc()) return Number::no_number;
  if (end == text.end()) return std::isfinite(value) ? Number::finite : Number::not_finite;
  if (*end != 'D' && *end != 'd') return Number::no_number;
  std::string with_e(text);
  with_e[static_cast<std::size_t>(end - text.begin())] = 'e';
  double ignored = 0;
  const auto [all, no] =
      std::from_chars(with_e.data(), with_e.data() + with_e.size(), ignored);
  return no == std::errc() && all == with_e.data() + with_e.size() ? Number::with_exponent_d
                                                                   : Number::no_number;
}

std::size_t CsvTable::start(std::size_t column) const {
  return has(column) ? fields_[position_[column]].start : 0;
}

void CsvTable::refuse(std::size_t start, const std::string& why) const {
  throw InputError(name_ + ":" + std::to_string(std::max<std::size_t>(line_.number, 1))
                   + ":" + std::to_string(start) + ": " + why);
}

bool CsvTable::next_line(Line* comment) {
  std::string& text = line_.text;
  while (std::getline(*in_, text)) {
    ++line_.number;
    if (line_.number == 1 && text.starts_with("\xef\xbb\xbf"))
      text.erase(0, 3); // UTF-8 mark
    if (text.ends_with('\r')) text.pop_back();
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    if (text[first] != '#') return true;
    if (comment != nullptr) *comment = line_, comment->text[first] = ' ';
  }
  return false;
}

void CsvTable::split() {
  fields_.clear();
  const std::string_view line = line_.text;
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t first = std::min(line.find_first_not_of(" \t", begin), line.size());
    std::size_t quoted = first; // to where commas belong to the text
    if (first < line.size() && line[first] == '"')
      quoted = std::min(line.find('"', first + 1), line.size() - 1);
    std::size_t last = std::min(line.find(',', quoted), line.size());
    begin = last + 1;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    if (quoted > first && line[quoted] == '"' && last == quoted + 1) ++first, --last;
    fields_.push_back({line.substr(first, last - first), first + 1});
  }
}

} // namespace ehdjet
