#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/schema.hpp"

#include <fmt/format.h>

namespace ehdjet {
namespace {

std::string text_of(double value, const Range&) {
  return toml_text(value);
}
std::string text_of(std::size_t value, const Range&) {
  return fmt::format("{}", value);
}
std::string text_of(const std::array<double, 3>& value, const Triple&) {
  return fmt::format("[{}, {}, {}]", toml_text(value[0]), toml_text(value[1]),
                     toml_text(value[2]));
}
std::string text_of(const std::string& value, const auto&) {
  return toml_text(std::string_view(value));
}
std::string text_of(const std::vector<RelaxationMode>& modes, const ModeList&) {
  return toml_text(modes);
}
std::string text_of(bool value, YesNo) {
  return value ? "true" : "false";
}
template <class Enum, std::size_t N>
std::string text_of(Enum value, const Choices<Enum, N>& choices) {
  return toml_text(name_of(value, choices));
}

std::string unit_of(const auto& allowed) {
  const std::string unit = unit_text(allowed);
  return unit.empty() ? "" : fmt::format("[{}] ", unit);
}

/// Schema visitor: writes what the scene has. An absent optional key becomes a comment that says
/// what holds instead; an absent table is left out.
struct Printer {
  std::string text;

  template <class T, class Allowed>
  void required(std::string_view name, const T& value, const Allowed& allowed,
                std::string_view meaning) {
    text += fmt::format("{:<36} # {}{}\n",
                        fmt::format("{} = {}", name, text_of(value, allowed)),
                        unit_of(allowed), meaning);
  }
  template <class T, class Allowed>
  void optional(std::string_view name, const T& value, const Allowed& allowed,
                std::string_view meaning) {
    required(name, value, allowed, meaning);
  }
  template <class T, class Allowed>
  void optional(std::string_view name, const std::optional<T>& value,
                const Allowed& allowed, std::string_view meaning,
                std::string_view otherwise) {
    if (value) return required(name, *value, allowed, meaning);
    text += fmt::format("{:<36} # {}{}\n", fmt::format("# {}: {}", name, otherwise),
                        unit_of(allowed), meaning);
  }
  template <class Config>
  void table(std::string_view name, std::optional<Config>& config,
             std::string_view meaning) {
    if (config) table(name, *config, meaning);
  }
  template <class Config>
  void table(std::string_view name, Config& config, std::string_view) {
    text += fmt::format("\n[{}]\n", name);
    describe(*this, config);
  }
};

} // namespace

std::string resolved_toml(const SceneConfig& config) {
  SceneConfig copy = config; // the description is written for visitors that may change it
  Printer printer;
  describe(printer, copy);
  return printer.text;
}

} // namespace ehdjet
