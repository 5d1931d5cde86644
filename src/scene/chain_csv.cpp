#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"

#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

#include "chain_formats.hpp"

namespace ehdjet {
namespace {

std::vector<std::string> columns_that_are(bool required) {
  std::vector<std::string> names;
  for (const ChainColumn& c : chain_columns())
    if (c.csv_required == required) names.push_back(c.csv);
  return names;
}

void check_order(const CsvTable& table, std::size_t bead_column, std::size_t expected) {
  const double bead = table.value(bead_column);
  if (bead == static_cast<double>(expected)) return;
  table.refuse(
      table.start(bead_column),
      expected == 0
          ? fmt::format("the first bead is {}: beads must be in order from bead 0", bead)
          : fmt::format("bead {} after bead {}: beads must be in order from bead 0", bead,
                        expected - 1));
}

// Text in a column that nobody may want is no reason to refuse the file.
void read_other(const CsvTable& table, std::size_t column, ChainBeads::Other& other) {
  if (!other.fault.empty()) return;
  try {
    other.values.push_back(table.value(column));
  } catch (const InputError& e) {
    other.fault = e.what();
  }
}

} // namespace

ChainBeads read_chain_csv(const std::filesystem::path& file) {
  auto optional = columns_that_are(false);
  optional.emplace_back("bead"), optional.emplace_back("embryo");
  CsvTable table(file, columns_that_are(true), optional, true);
  const std::size_t columns = chain_columns().size();
  const std::size_t bead_column = columns, embryo_column = columns + 1;
  // CsvTable knows columns by their place in the list of required, then optional ones.
  std::vector<const ChainColumn*> order;
  for (const bool required : {true, false})
    for (const ChainColumn& c : chain_columns())
      if (c.csv_required == required) order.push_back(&c);

  struct Row {
    std::size_t line = 0;
    std::vector<std::size_t> start{}; // where its fields start, in table order
  };
  std::vector<Row> rows;
  ChainBeads beads;
  for (std::size_t c = columns + 2; c < table.columns().size(); ++c)
    beads.others[table.columns()[c]] = {};
  while (table.next_row()) {
    Row row{.line = table.line()};
    for (std::size_t c = 0; c < columns; ++c) {
      (beads.*order[c]->values).push_back(table.value(c));
      row.start.push_back(table.start(c));
    }
    for (std::size_t c = columns + 2; c < table.columns().size(); ++c)
      read_other(table, c, beads.others[table.columns()[c]]);
    if (table.has(bead_column)) check_order(table, bead_column, rows.size());
    if (table.value(embryo_column) != 0)
      table.refuse(table.start(embryo_column),
                   "embryo = 1: a chain has no embryo, remove this line");
    rows.push_back(row);
  }

  check_chain(beads, [&](std::size_t bead, std::string_view column) {
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
