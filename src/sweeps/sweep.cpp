#include "ehdjet/sweeps/sweep.hpp"

#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/io/text_output.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "sweep_plan.hpp"

namespace ehdjet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_runs = 100'000, longest_id = 200;
constexpr const char* index_name = "index.csv";

/// Makes the paths in a scene, which are relative to `from`, relative to `to`.
void move_files(SceneConfig& config, const fs::path& from, const fs::path& to) {
  const auto move = [&](std::string& file) {
    if (fs::path(file).is_relative())
      file = fs::proximate(fs::absolute(from) / file, fs::absolute(to)).string();
  };
  if (config.chain) move(config.chain->file);
  if (config.air && config.air->profile) move(*config.air->profile);
  if (config.coulomb && config.coulomb->calibration) move(*config.coulomb->calibration);
}

/// A scene of the plan: one level of each factor.
struct Point {
  std::string id;
  std::vector<Override> changes;
};

Point point_of(const SweepPlan& plan, std::size_t number) {
  std::vector<const SweepFactor::Level*> levels;
  for (auto factor = plan.factors.rbegin(); factor != plan.factors.rend(); ++factor) {
    levels.push_back(&factor->levels[number % factor->levels.size()]);
    number /= factor->levels.size();
  }
  Point point{.id = plan.name, .changes = {}};
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    point.id += '_' + (*level)->name;
    std::ranges::copy((*level)->overrides, std::back_inserter(point.changes));
  }
  return point;
}

std::string value_of(const Override& change) {
  return change.assignment.substr(change.assignment.find('=') + 1);
}

Scene read_point(const SweepPlan& plan, const Point& point) {
  std::vector<Override> all = plan.settings;
  std::ranges::copy(point.changes, std::back_inserter(all));
  Scene scene = read_scene(plan.scene, Overrides(std::move(all)));
  try { // finds errors that only appear when the objects are built
    if (scene.config.array)
      build_array_simulation(scene);
    else
      build_simulation(scene);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", point.id, e.what()));
  }
  return scene;
}

/// Comments that say what the scene is, and the scene with every key.
std::string scene_text(const Sweep& sweep, const SweepPlan& plan, const Point& point,
                       const SceneConfig& config) {
  std::string text = fmt::format("# {} of {} (ehdjet sweep), from {} with\n", point.id,
                                 sweep.plan, plan.scene.filename().string());
  for (const Override& change : point.changes)
    text += fmt::format("#   {} = {}\n",
                        change.assignment.substr(0, change.assignment.find('=')),
                        value_of(change));
  return text + '\n' + resolved_toml(config);
}

std::optional<std::string> text_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

/// Creates or replaces a file: it has the old text or the new one at any time.
void write_file(const fs::path& file, const std::string& text) {
  TextOutput output(file, true);
  output.print("{}", text);
  output.close();
}

/// Scene files in an index.
std::set<std::string> scenes_in(const std::string& index) {
  std::set<std::string> scenes;
  for (std::size_t line = index.find('\n'); line + 1 < index.size();
       line = index.find('\n', line + 1)) {
    const std::size_t first = index.find(',', line), second = index.find(',', first + 1);
    if (second == std::string::npos) break;
    scenes.insert(index.substr(first + 1, second - first - 1));
  }
  return scenes;
}

} // namespace

std::string Sweep::index() const {
  std::string text = "id,scene,run";
  for (const std::string& key : keys) text += ',' + csv_name(key, key_unit(key));
  text += '\n';
  for (const SweepRun& run : runs) {
    text += fmt::format("{0},{0}.toml,{0}.h5", run.id);
    for (const std::string& value : run.values) text += ',' + csv_field(value);
    text += '\n';
  }
  return text;
}

Sweep read_sweep(const fs::path& file, const fs::path& folder) {
  const SweepPlan plan = read_plan(file);
  std::size_t points = 1;
  for (const SweepFactor& factor : plan.factors)
    if ((points *= factor.levels.size()) * plan.repeats > most_runs)
      throw InputError(fmt::format("{}: has more than {} runs", file.string(), most_runs));
  Sweep sweep;
  sweep.plan = file.filename().string();
  for (const SweepFactor& factor : plan.factors)
    std::ranges::copy(factor.keys, std::back_inserter(sweep.keys));
  std::set<std::string> ids;
  for (std::size_t p = 0; p < points; ++p) {
    const Point point = point_of(plan, p);
    if (point.id.size() > longest_id || !ids.insert(point.id).second)
      throw InputError(fmt::format(
          "{}: the name of a run, {}, {}. Give the values short names with `label` in a "
          "[[together]]",
          file.string(), point.id,
          point.id.size() > longest_id ? "is too long" : "stands for two runs"));
    Scene scene = read_point(plan, point);
    move_files(scene.config, plan.scene.parent_path(), folder);
    SweepRun run{.id = point.id,
                 .scene = scene_text(sweep, plan, point, scene.config),
                 .values = {}};
    for (const Override& change : point.changes) run.values.push_back(value_of(change));
    for (std::size_t r = 1; r <= plan.repeats; ++r) {
      if (plan.repeats > 1) run.id = fmt::format("{}_repeat-{}", point.id, r);
      sweep.runs.push_back(run);
    }
  }
  return sweep;
}

SweepFiles write_sweep(const Sweep& sweep, const fs::path& folder, bool overwrite) {
  std::vector<std::pair<fs::path, const std::string*>> wanted;
  const std::string index = sweep.index();
  for (const SweepRun& run : sweep.runs)
    wanted.emplace_back(folder / (run.id + ".toml"), &run.scene);
  wanted.emplace_back(folder / index_name, &index);

  const std::optional<std::string> former_index = text_in(folder / index_name);
  std::erase_if(wanted, [&](const auto& file) {
    const auto present = text_in(file.first);
    if (present && *present != *file.second && !overwrite)
      throw InputError(fmt::format(
          "{} is not what {} makes: the plan, its scene or ehdjet has changed, or the "
          "file. "
          "Choose another folder with -o or overwrite with --force. Runs are never touched",
          file.first.string(), sweep.plan));
    return present == *file.second;
  });

  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw InputError(fmt::format("cannot create the folder {}: {}", folder.string(),
                                 error ? error.message() : "a file has that name"));
  for (const auto& [file, text] : wanted) write_file(file, *text);

  const std::size_t written =
      wanted.size()
      - static_cast<std::size_t>(!wanted.empty() && wanted.back().second == &index);
  SweepFiles files{
      .written = written, .unchanged = sweep.runs.size() - written, .dropped = {}};
  if (former_index) {
    const std::set<std::string> now = scenes_in(index);
    for (const std::string& scene : scenes_in(*former_index))
      if (!now.contains(scene)) files.dropped.push_back(scene);
  }
  return files;
}

} // namespace ehdjet
