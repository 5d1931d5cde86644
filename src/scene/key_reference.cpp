#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/schema.hpp"

#include <fmt/format.h>

namespace ehdjet {
namespace {

std::string range_of(const Range& range) {
  return Range{"-", range.lowest, range.highest, range.open}
      .text(); // unit has its own column
}
std::string range_of(const Triple& triple) {
  return "three numbers, each " + range_of(triple.each);
}
std::string range_of(const auto& allowed) {
  return allowed_text(allowed);
}

std::string default_of(double value, const auto&) {
  return toml_text(value);
}
std::string default_of(const std::string& value, const auto&) {
  return toml_text(std::string_view(value));
}
std::string default_of(bool value, YesNo) {
  return value ? "true" : "false";
}
template <class Enum, std::size_t N>
std::string default_of(Enum value, const Choices<Enum, N>& choices) {
  return toml_text(name_of(value, choices));
}

/// Schema visitor: one Markdown table per TOML table.
struct Reference {
  std::string text;

  template <class T, class Allowed>
  void required(std::string_view name, const T&, const Allowed& allowed,
                std::string_view meaning) {
    row(name, allowed, "**required**", meaning);
  }
  template <class T, class Allowed>
  void optional(std::string_view name, const T& value, const Allowed& allowed,
                std::string_view meaning) {
    row(name, allowed, default_of(value, allowed), meaning);
  }
  template <class T, class Allowed>
  void optional(std::string_view name, const std::optional<T>&, const Allowed& allowed,
                std::string_view meaning, std::string_view otherwise) {
    row(name, allowed, otherwise, meaning);
  }
  template <class Config>
  void table(std::string_view name, std::optional<Config>& config,
             std::string_view meaning) {
    table(name, config.emplace(), meaning);
  }
  template <class Config>
  void table(std::string_view name, Config& config, std::string_view meaning) {
    heading(fmt::format("[{}]", name), meaning);
    describe(*this, config);
  }

  void heading(std::string_view title, std::string_view meaning) {
    text += fmt::format("\n## {}\n\n{}\n\n| key | unit | allowed | default | meaning |\n"
                        "|---|---|---|---|---|\n",
                        title, meaning);
  }
  template <class Allowed>
  void row(std::string_view name, const Allowed& allowed, std::string_view otherwise,
           std::string_view meaning) {
    std::string cells;
    // A bar would end the cell of a Markdown table.
    for (const char c : meaning) cells += c == '|' ? std::string("\\|") : std::string(1, c);
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", name, unit_text(allowed),
                        range_of(allowed), otherwise, cells);
  }
};

} // namespace

std::string key_reference() {
  Reference reference;
  reference.text =
      "# Keys of a scene file\n\nScene files are TOML, in SI units. If a table is "
      "absent, the run does not have that feature.\n";
  reference.heading("(top level)", "Before the first table.");
  SceneConfig config;
  describe(reference, config);
  return reference.text;
}

} // namespace ehdjet
