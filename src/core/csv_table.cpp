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

CsvTable::CsvTable(const std::filesystem::path& file, std::vector<std::string> required,
                   const std::vector<std::string>& optional, bool others)
    : name_(file.string())
    , in_(file)
    , wanted_(std::move(required)) {
  const std::size_t required_count = wanted_.size();
  wanted_.insert(wanted_.end(), optional.begin(), optional.end());
  position_.assign(wanted_.size(), absent);

  std::error_code error;
  if (!in_ || std::filesystem::is_directory(file, error))
    throw InputError(name_ + ": cannot be read (" + std::generic_category().message(errno)
                     + ")");
  if (!next_line()) refuse(1, "no header line with the names of the columns");
  split();
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
    if (!has(c)) refuse(1, "column " + wanted_[c] + " is missing from the header");
}

bool CsvTable::next_row() {
  if (!next_line()) return false;
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
  double value = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), value);
  const auto refuse_value = [&](const char* quote, const char* why) {
    refuse(start, (wanted_[column] + " = ")
                      .append(quote)
                      .append(text)
                      .append(quote)
                      .append(": ")
                      .append(why));
  };
  if (error == std::errc::result_out_of_range) refuse_value("", "too large or too small");
  if (error != std::errc() || end != text.end()) refuse_value("\"", "must be a number");
  if (!std::isfinite(value)) refuse_value("", "must be finite");
  return value;
}

std::size_t CsvTable::start(std::size_t column) const {
  return has(column) ? fields_[position_[column]].start : 0;
}

void CsvTable::refuse(std::size_t start, const std::string& why) const {
  throw InputError(name_ + ":" + std::to_string(line_number_) + ":" + std::to_string(start)
                   + ": " + why);
}

bool CsvTable::next_line() {
  while (std::getline(in_, line_)) {
    ++line_number_;
    if (line_number_ == 1 && line_.starts_with("\xef\xbb\xbf"))
      line_.erase(0, 3); // UTF-8 mark
    if (line_.ends_with('\r')) line_.pop_back();
    if (line_.find_first_not_of(" \t") != std::string::npos && line_[0] != '#') return true;
  }
  return false;
}

void CsvTable::split() {
  fields_.clear();
  const std::string_view line = line_;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::size_t first = begin, last = end;
    while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    fields_.push_back({line.substr(first, last - first), first + 1});
    begin = end + 1;
  }
}

} // namespace ehdjet
