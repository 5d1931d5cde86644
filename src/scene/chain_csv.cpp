#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"

#include <array>
#include <fmt/format.h>
#include <string_view>
#include <vector>

#include "chain_formats.hpp"

namespace ehdjet {
namespace {

constexpr std::size_t columns = chain_columns.size();

std::vector<std::string_view> columns_that_are(bool required) {
  std::vector<std::string_view> names;
  for (const ChainColumn& c : chain_columns)
    if (c.csv_required == required) names.emplace_back(c.csv);
  return names;
}

// CsvTable knows columns by their place in the list of required, then optional ones.
std::array<const ChainColumn*, columns> in_table_order() {
  std::array<const ChainColumn*, columns> order{};
  std::size_t i = 0;
  for (const bool required : {true, false})
    for (const ChainColumn& c : chain_columns)
      if (c.csv_required == required) order[i++] = &c;
  return order;
}

constexpr std::size_t bead_column = columns, embryo_column = columns + 1;

void check_order(const CsvTable& table, std::size_t expected) {
  const double bead = table.value(bead_column);
  if (bead == static_cast<double>(expected)) return;
  table.refuse(
      table.start(bead_column),
      expected == 0
          ? fmt::format("the first bead is {}: beads must be in order from bead 0", bead)
          : fmt::format("bead {} after bead {}: beads must be in order from bead 0", bead,
                        expected - 1));
}

} // namespace

ChainBeads read_chain_csv(const std::filesystem::path& file) {
  auto optional = columns_that_are(false);
  optional.emplace_back("bead");
  optional.emplace_back("embryo");
  CsvTable table(file, columns_that_are(true), optional);
  const auto order = in_table_order();

  struct Row {
    std::size_t line = 0;
    std::array<std::size_t, columns> start{}; // where its fields start, in table order
  };
  std::vector<Row> rows;
  ChainBeads beads;
  while (table.next_row()) {
    Row row{.line = table.line(), .start = {}};
    for (std::size_t c = 0; c < columns; ++c) {
      (beads.*order[c]->values).push_back(table.value(c));
      row.start[c] = table.start(c);
    }
    if (table.has(bead_column)) check_order(table, rows.size());
    if (table.value(embryo_column) != 0)
      table.refuse(table.start(embryo_column),
                   "embryo = 1: a chain has no embryo, remove this line");
    rows.push_back(row);
  }

  check_chain(beads, [&](std::size_t bead, const char* column) {
    if (rows.empty()) return fmt::format("{}:{}", file.string(), table.line());
    const Row& row = rows[bead];
    for (std::size_t c = 0; c < columns; ++c)
      if (order[c]->csv == column && row.start[c] > 0)
        return fmt::format("{}:{}:{}", file.string(), row.line, row.start[c]);
    return fmt::format("{}:{}", file.string(), row.line);
  });
  return beads;
}

} // namespace ehdjet
