#include "scenes.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <system_error>
#include <toml++/toml.h>

#include "commands.hpp"
#include "options.hpp"
#include "standard_streams.hpp"
#include "words.hpp"

namespace ehdjet::cli {
namespace {

namespace fs = std::filesystem;

/// File by name, without .toml. A name that several folders have is that of the first one.
std::map<std::string, fs::path> named_scenes() {
  std::map<std::string, fs::path> scenes;
  for (const fs::path& folder : scene_folders()) {
    std::error_code error; // a folder that is not there has no scenes
    for (fs::directory_iterator i(folder, error), end; !error && i != end;
         i.increment(error))
      if (i->path().extension() == ".toml")
        scenes.emplace(i->path().stem().string(), i->path());
  }
  return scenes;
}

std::string title_of(const fs::path& file) {
  try {
    return toml::parse_file(file.string())["title"].value_or(std::string());
  } catch (const toml::parse_error& e) {
    return fmt::format("(cannot be read: {})", e.description());
  }
}

void list_scenes() {
  const auto scenes = named_scenes();
  if (scenes.empty()) {
    std::string folders;
    for (const fs::path& folder : scene_folders())
      folders += (folders.empty() ? "" : ", ") + folder.string();
    throw InputError("no scenes in " + folders
                     + ": set EHDJET_SCENES to the folder that has them");
  }
  std::size_t width = 0;
  for (const auto& [name, file] : scenes) width = std::max(width, name.size());
  for (const auto& [name, file] : scenes)
    print_result("{:<{}}  {}\n", name, width, title_of(file));
}

/// Where a scene file is, for who wants to copy it.
void print_path(const std::string& name) {
  print_result("{}\n", find_scene(name).string());
}

} // namespace

std::vector<fs::path> scene_folders() {
  std::vector<fs::path> folders;
  if (const char* given = std::getenv("EHDJET_SCENES"); given != nullptr) {
    std::istringstream list(given);
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) folders.emplace_back(folder);
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error)
    folders.push_back(
        (program.parent_path() / "../share/ehdjet/scenes").lexically_normal());
  return folders;
}

bool is_run_file(const fs::path& file) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, signature.size()> start{};
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false; // nothing is taken out of a pipe
  std::ifstream in(file, std::ios::binary);
  in.read(start.data(), start.size());
  return in && std::string_view(start.data(), start.size()) == signature;
}

fs::path find_scene(const std::string& given) {
  std::error_code ignored;
  const auto is_file = [&](const fs::path& p) {
    return fs::exists(p, ignored) && !fs::is_directory(p, ignored);
  };
  const fs::path path(given);
  if (is_file(path) || path.has_parent_path()) return path;
  if (const fs::path here = given + ".toml"; is_file(here)) return here;
  const auto scenes = named_scenes();
  const std::string name = path.extension() == ".toml" ? path.stem().string() : given;
  if (const auto found = scenes.find(name); found != scenes.end()) return found->second;
  if (fs::is_directory(path, ignored)) return path; // its reader refuses it
  std::vector<std::string> names;
  names.reserve(scenes.size());
  for (const auto& [known, file] : scenes) names.push_back(known);
  throw InputError(
      fmt::format("there is no scene file {0} here and no scene of that name{1}; "
                  "ehdjet scenes lists them",
                  given, nearest_name(name, names)));
}

std::string origin_of(const fs::path& file) {
  return is_run_file(file) ? RunReader(file).attribute("scene_file") : file.string();
}

Scene read_scene_or_run(const fs::path& file, const std::vector<std::string>& overrides) {
  if (!is_run_file(file)) return read_scene(file, overrides);
  const RunReader run(file);
  // Other files of the scene are named relative to it.
  const fs::path folder = fs::path(run.attribute("scene_file")).parent_path();
  return read_scene_text(run.scene("resolved"), file.string() + ": scene/resolved", folder,
                         overrides);
}

void add_scenes_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("scenes", "List the scenes that come with the program, by name");
  auto path = std::make_shared<std::string>();
  command->add_option("--path", *path, "Print where the file of a scene is instead")
      ->type_name("NAME");
  command->callback([path] {
    if (path->empty())
      list_scenes();
    else
      print_path(*path);
  });
}

} // namespace ehdjet::cli
