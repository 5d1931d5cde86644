#include "words.hpp"

#include "ehdjet/core/edit_distance.hpp"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>

namespace ehdjet::cli {
namespace {

/// Commands below `app`, and groups of its options, which have no name.
std::vector<const CLI::App*> parts_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

} // namespace

std::string nearest_name(std::string_view wrong, const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(2, wrong.size() / 3) + 1;
  for (const std::string& k : known)
    if (const std::size_t distance = edit_distance(wrong, k); distance < least)
      least = distance, nearest = &k;
  return nearest == nullptr ? "" : fmt::format(" (did you mean {}?)", *nearest);
}

std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  const CLI::App* at = &app;
  std::string command = app.get_name();
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with('-')) return {};
    std::vector<std::string> names;
    for (const CLI::App* part : parts_of(*at))
      if (!part->get_name().empty()) names.push_back(part->get_name());
    if (names.empty()) return {};
    if (std::ranges::find(names, word) == names.end())
      return fmt::format("{} has no command {}{}", command, word,
                         nearest_name(word, names));
    at = at->get_subcommand(word);
    command += ' ' + word;
  }
  return {};
}

std::string unknown_options(const CLI::App& app) {
  const CLI::App* at = &app;
  std::string command = app.get_name(), text;
  while (!at->get_subcommands().empty()) {
    at = at->get_subcommands().front();
    command += ' ' + at->get_name();
  }
  std::vector<std::string> names;
  const auto add_names = [&](const CLI::App& group) {
    for (const CLI::Option* option : group.get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  };
  add_names(*at);
  for (const CLI::App* group : parts_of(*at))
    if (group->get_name().empty()) add_names(*group);
  for (const std::string& word : app.remaining(true)) {
    const std::string name = word.substr(0, word.find('='));
    text += text.empty() ? "" : "\n";
    text += name.starts_with("-") ? fmt::format("{} has no option {}{}", command, name,
                                                nearest_name(name, names))
                                  : fmt::format("{} does not expect {}", command, word);
  }
  return text;
}

} // namespace ehdjet::cli
