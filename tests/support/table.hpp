#pragma once

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace ehdjet::test {

/// Numbers with named columns, from a CSV file below the test data folder.
class Table {
public:
  explicit Table(const std::string& file) {
    std::ifstream in(EHDJET_TEST_DATA "/" + file);
    require(in.good(), file);
    std::string line;
    std::getline(in, line);
    std::istringstream header(line);
    for (std::string name; std::getline(header, name, ',');) names_.push_back(name);
    while (std::getline(in, line)) {
      std::istringstream cells(line);
      rows_.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');)
        rows_.back().push_back(std::stod(cell));
      require(rows_.back().size() == names_.size(), file + ": " + line);
    }
    require(!rows_.empty(), file);
  }

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] double at(std::size_t row, const std::string& column) const {
    const auto name = std::ranges::find(names_, column);
    require(name != names_.end(), column);
    return rows_.at(row).at(static_cast<std::size_t>(name - names_.begin()));
  }

private:
  static void require(bool ok, const std::string& what) {
    if (!ok) throw std::runtime_error("bad table: " + what);
  }

  std::vector<std::string> names_;
  std::vector<std::vector<double>> rows_;
};

} // namespace ehdjet::test
