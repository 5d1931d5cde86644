#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace ehdjet::test {

/// Numbers with named columns, from a CSV file below the test data folder.
class Table {
public:
  explicit Table(const std::string& file) {
    std::ifstream in(EHDJET_TEST_DATA "/" + file);
    EXPECT_TRUE(in) << file;
    std::string line;
    std::getline(in, line);
    std::istringstream header(line);
    for (std::string name; std::getline(header, name, ',');) names_.push_back(name);
    while (std::getline(in, line)) {
      std::istringstream cells(line);
      rows_.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');)
        rows_.back().push_back(std::stod(cell));
      EXPECT_EQ(rows_.back().size(), names_.size()) << file << ": " << line;
    }
    EXPECT_FALSE(rows_.empty()) << file;
  }

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] double at(std::size_t row, const std::string& column) const {
    const auto name = std::ranges::find(names_, column);
    EXPECT_NE(name, names_.end()) << column;
    return rows_.at(row).at(static_cast<std::size_t>(name - names_.begin()));
  }

private:
  std::vector<std::string> names_;
  std::vector<std::vector<double>> rows_;
};

} // namespace ehdjet::test
