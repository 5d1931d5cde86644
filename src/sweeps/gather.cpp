#include "ehdjet/sweeps/gather.hpp"

#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/run_files/run_reader.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/schema.hpp"
#include "ehdjet/sweeps/time_mean.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <map>
#include <span>
#include <string_view>
#include <utility>

namespace ehdjet {
namespace {

using Cell = GatheredRuns::Cell;

/// Observables that count from the start of the run: their last value is a cost.
constexpr std::array<std::string_view, 5> counters{"evaluations", "steps", "rejected",
                                                   "inner_evaluations", "full_sums"};
/// Observables of the last released or landed bead, which are 0 before the first one.
constexpr std::array<std::string_view, 3> of_beads{"nozzle_speed", "impact_speed",
                                                   "collector_radius"};

bool is_in(const auto& list, std::string_view name) {
  return std::ranges::find(list, name) != list.end();
}

/// Cells by the names of their columns, in the order of the first run that has them.
using Cells = std::vector<std::pair<std::string, Cell>>;

struct Run {
  std::string status, message;
  std::map<std::string, std::string> scene; ///< `resolved_values`
  Cells window, means, cost;
};

struct Rows {
  std::size_t first = 0, last = 0; ///< exclusive
};

Rows rows_in(const std::vector<double>& time, const MeanWindow& window) {
  if (time.empty()) return {};
  const double from = window.from.value_or(window.to ? time.front() : time.back() / 2);
  const auto first = std::ranges::lower_bound(time, from);
  const auto last = window.to ? std::ranges::upper_bound(time, *window.to) : time.end();
  return {.first = static_cast<std::size_t>(first - time.begin()),
          .last = static_cast<std::size_t>(std::max(first, last) - time.begin())};
}

void add_means(Run& run, const RunTable& observables, const MeanWindow& window) {
  const std::vector<double>& time = observables["time"];
  const Rows rows = rows_in(time, window);
  const std::size_t number = rows.last - rows.first;
  if (number > 0)
    run.window = {{"from_s", time[rows.first]}, {"to_s", time[rows.last - 1]}};
  run.window.emplace_back("rows", static_cast<double>(number));
  for (const RunTable::Column& column : observables.columns) {
    if (column.name == "time") continue;
    if (is_in(counters, column.name)) {
      if (!time.empty())
        run.cost.emplace_back(csv_name(column.name, column.unit), column.values.back());
      continue;
    }
    std::span<const double> values = std::span(column.values).subspan(rows.first, number);
    if (is_in(of_beads, column.name))
      while (!values.empty() && values.front() == 0) values = values.subspan(1);
    if (values.empty()) continue;
    const TimeMean mean = time_mean(values);
    run.means.emplace_back(csv_name(column.name, column.unit), mean.mean);
    if (mean.standard_error)
      run.means.emplace_back(csv_name(column.name + "_error", column.unit),
                             *mean.standard_error);
  }
}

/// Replaces a cell, or adds it at the end.
void put(Cells& cells, const std::string& name, double value) {
  const auto found = std::ranges::find(cells, name, &Cells::value_type::first);
  if (found == cells.end())
    cells.emplace_back(name, value);
  else
    found->second = value;
}

void read_run(Run& run, const std::filesystem::path& file, const MeanWindow& window) {
  const RunReader reader(file);
  run.scene = resolved_values(reader.scene("resolved"));
  if (reader.has("observables")) add_means(run, reader.table("observables"), window);
  // What the run says at its end is later than its last row.
  constexpr std::array others{std::pair{"landings", "landings"},
                              std::pair{"refinements", "refinements"},
                              std::pair{"coincident_pairs", "coincident_pairs"},
                              std::pair{"wall_time", "wall_time_s"}};
  const std::map<std::string, double> statistics = reader.statistics();
  const auto take = [&](const std::string& name, const std::string& column) {
    if (const auto s = statistics.find(name); s != statistics.end())
      put(run.cost, column, s->second);
  };
  for (const std::string_view name : counters) take(std::string(name), std::string(name));
  for (const auto& [name, column] : others) take(name, column);
  run.message = reader.attribute("message");
  run.status = reader.attribute("status");
}

Run read_or_explain(const std::filesystem::path& file, const MeanWindow& window) {
  try {
    Run run;
    read_run(run, file, window);
    return run;
  } catch (const std::exception& e) { // nothing of a file that is damaged somewhere
    Run unreadable;
    unreadable.status = "unreadable", unreadable.message = e.what();
    return unreadable;
  }
}

/// Keys of the scenes that are not the same in all runs.
std::vector<std::string> differing_keys(const std::vector<Run>& runs) {
  std::map<std::string, std::map<std::string, std::size_t>> values;
  std::size_t scenes = 0;
  for (const Run& run : runs) {
    if (run.scene.empty()) continue;
    ++scenes;
    for (const auto& [key, value] : run.scene) ++values[key][value];
  }
  std::vector<std::string> keys;
  for (const auto& [key, uses] : values)
    if (uses.begin()->second != scenes) keys.push_back(key);
  return keys;
}

/// A value in TOML syntax as a number or a text.
Cell cell_of(const std::string& value) {
  if (value.size() >= 2 && value.front() == '"') return value.substr(1, value.size() - 2);
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  if (*end == '\0') return number;
  return value;
}

/// Adds the columns of a part of every run, each in its place after the one before it.
void add_columns(GatheredRuns& table, const std::vector<Run>& runs, Cells Run::*part) {
  std::vector<std::string> names;
  for (const Run& run : runs) {
    auto place = names.begin();
    for (const auto& [name, cell] : run.*part) {
      const auto found = std::ranges::find(names, name);
      place = (found != names.end() ? found : names.insert(place, name)) + 1;
    }
  }
  table.columns.insert(table.columns.end(), names.begin(), names.end());
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const std::string& name : names) {
      const Cells& cells = runs[r].*part;
      const auto found = std::ranges::find(cells, name, &Cells::value_type::first);
      table.rows[r].push_back(found == cells.end() ? Cell() : found->second);
    }
}

std::string csv_cell(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell))
    return fmt::format("{:.17g}", *number);
  if (const auto* text = std::get_if<std::string>(&cell)) return csv_field(*text);
  return {};
}

std::string json_cell(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell);
      number != nullptr && std::isfinite(*number))
    return fmt::format("{:.17g}", *number);
  if (const auto* text = std::get_if<std::string>(&cell))
    return toml_text(std::string_view(*text)); // a TOML text is a JSON text
  return "null";
}

} // namespace

GatheredRuns gather_runs(const std::vector<std::filesystem::path>& files,
                         const MeanWindow& window) {
  std::vector<Run> runs;
  runs.reserve(files.size());
  for (const auto& file : files) runs.push_back(read_or_explain(file, window));
  const std::vector<std::string> keys = differing_keys(runs);

  GatheredRuns table{.columns = {"run", "status", "message"}, .rows = {}};
  for (const std::string& key : keys) table.columns.push_back(csv_name(key, key_unit(key)));
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Run& run = runs[r];
    auto& row = table.rows.emplace_back();
    row = {files[r].string(), run.status};
    row.push_back(run.message.empty() ? Cell() : Cell(run.message));
    for (const std::string& key : keys) {
      const auto value = run.scene.find(key);
      row.push_back(value == run.scene.end() ? Cell() : cell_of(value->second));
    }
  }
  for (const auto part : {&Run::window, &Run::means, &Run::cost})
    add_columns(table, runs, part);
  return table;
}

void GatheredRuns::print_csv(TextOutput& output) const {
  for (std::size_t c = 0; c < columns.size(); ++c)
    output.print("{}{}", c == 0 ? "" : ",", csv_field(columns[c]));
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      output.print("{}{}", c == 0 ? "\n" : ",", csv_cell(row[c]));
  output.print("\n");
  output.close();
}

void GatheredRuns::print_json(TextOutput& output) const {
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c)
      output.print("{}{}: {}{}",
                   c > 0    ? ", "
                   : r == 0 ? "[{"
                            : ",\n {",
                   toml_text(std::string_view(columns[c])), json_cell(rows[r][c]),
                   c + 1 == columns.size() ? "}" : "");
  output.print("{}]\n", rows.empty() ? "[" : "");
  output.close();
}

} // namespace ehdjet
