#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/core/printable.hpp"
#include "ehdjet/io/export.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "record_columns.hpp"

namespace ehdjet {
namespace {

void print_csv(const RunTable& table, TextOutput& output) {
  const auto& columns = table.columns;
  for (std::size_t c = 0; c < columns.size(); ++c)
    output.print("{}{}", c == 0 ? "" : ",",
                 printable(csv_name(columns[c].name, columns[c].unit)));
  output.print("\n");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      output.print("{}{:.17g}", c == 0 ? "" : ",", columns[c].values[row]);
    output.print("\n");
  }
  output.close();
}

/// Sorts the columns of a table into the order of `list`. Columns that are not in the list follow.
template <class List>
RunTable in_order(RunTable table, const List& list) {
  auto next = table.columns.begin();
  for (const ColumnInfo& info : list) {
    const auto found =
        std::find_if(next, table.columns.end(),
                     [&](const RunTable::Column& c) { return c.name == info.name; });
    if (found != table.columns.end()) std::rotate(next++, found, found + 1);
  }
  return table;
}

// Of the fibre of each jet.
std::vector<double> arc_length(const RunTable& deposit) {
  const RunTable::Column* jet = deposit.find("jet");
  std::vector<double> lengths = link_lengths(deposit);
  std::map<double, double> end;
  for (std::size_t k = 0; k < lengths.size(); ++k)
    lengths[k] = end[jet != nullptr ? jet->values[k] : 0] += lengths[k];
  return lengths;
}

// Every jet counts its beads from its nozzle on.
std::vector<double> bead_numbers(const Frame& frame) {
  std::vector<double> numbers;
  for (const BeadRange& jet : jets_of(frame))
    for (std::size_t k = jet.begin; k < jet.end; ++k)
      numbers.push_back(static_cast<double>(k - jet.begin));
  return numbers;
}

} // namespace

void export_table(const RunReader& run, const std::string& part, TextOutput& output) {
  RunTable table = run.table(part);
  if (part == "observables") table = in_order(table, observable_columns());
  if (part == "refinements") table = in_order(table, refinement_columns());
  if (part == "deposit") {
    table = in_order(table, deposit_columns(exported_table()));
    table.columns.push_back({"arc_length", "m", arc_length(table)});
  }
  print_csv(table, output);
}

void export_beads(const RunReader& run, std::optional<double> time, TextOutput& output) {
  const Frame frame = run.frame(run.nearest_frame(time));
  RunTable table{{{"bead", "1", bead_numbers(frame)}}};
  for (const FrameColumn& c : frame_columns(*exported_table()))
    table.columns.push_back({c.name, c.unit, column_or_zeros(frame, c.name)});
  for (RunTable::Column& c : further_columns(frame)) table.columns.push_back(std::move(c));
  print_csv(table, output);
}

void export_resolving_power(const RunReader& run, std::optional<double> from,
                            TextOutput& output) {
  const ResolvingPowerTable t = run.resolving_power();
  const std::size_t places = t.lambda.size();
  const double start = from.value_or(t.time.empty() ? 0 : t.time.back() / 2);
  const auto first =
      static_cast<std::size_t>(std::ranges::lower_bound(t.time, start) - t.time.begin());
  if (first == t.time.size())
    throw InputError(fmt::format("{} has no sample of the resolving power from {} s on",
                                 run.path().string(), start));
  output.print("lambda,mean_r,min_r\n");
  for (std::size_t i = 0; i < places; ++i) {
    double sum = 0, least = std::numeric_limits<double>::infinity();
    for (std::size_t k = first; k < t.time.size(); ++k) {
      sum += t.r[k * places + i];
      least = std::min(least, t.r[k * places + i]);
    }
    output.print("{:.17g},{:.17g},{:.17g}\n", t.lambda[i],
                 sum / static_cast<double>(t.time.size() - first), least);
  }
  output.close();
}

} // namespace ehdjet
