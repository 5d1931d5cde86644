#include "ehdjet/scene/schema.hpp"

#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/integrators/make_integrator.hpp"

#include <fmt/format.h>

namespace ehdjet {

bool Range::contains(double value) const {
  return (open ? value > lowest : value >= lowest) && value <= highest;
}

std::string Range::text() const {
  const std::string suffix = unit == "-" ? "" : fmt::format(" {}", unit);
  if (open)
    return fmt::format("greater than {:g} and at most {:g}{}", lowest, highest, suffix);
  return fmt::format("from {:g} to {:g}{}", lowest, highest, suffix);
}

Words integration_method_names() {
  Words words;
  for (const IntegratorDescription& m : integration_methods())
    words.names.push_back(m.name);
  return words;
}

Words coulomb_solver_names() {
  Words words;
  for (const SolverDescription& s : coulomb_solvers()) words.names.push_back(s.name);
  return words;
}

std::string allowed_text(const Range& range) {
  return range.text();
}

std::string allowed_text(const Words& words) {
  std::string text;
  for (std::size_t i = 0; i < words.names.size(); ++i)
    text += fmt::format("{}\"{}\"",
                        i == 0                        ? ""
                        : i + 1 == words.names.size() ? " or "
                                                      : ", ",
                        words.names[i]);
  return text;
}

std::string allowed_text(const Triple& triple) {
  return "three numbers [x, y, z], each " + triple.each.text();
}

std::string allowed_text(const ModeList& modes) {
  return fmt::format("1 to {} pairs [G, lambda], G {} and lambda {}", modes.most,
                     modes.modulus.text(), modes.relaxation_time.text());
}

std::string allowed_text(AnyText) {
  return "text in quotes";
}

std::string allowed_text(YesNo) {
  return "true or false";
}

std::string unit_text(const Range& range) {
  return std::string(range.unit);
}

std::string unit_text(const Triple& triple) {
  return unit_text(triple.each);
}

std::string unit_text(const ModeList& modes) {
  return fmt::format("{}, {}", modes.modulus.unit, modes.relaxation_time.unit);
}

std::string toml_text(double value) {
  return fmt::format("{}", value);
}

std::string toml_text(const std::vector<RelaxationMode>& modes) {
  std::string text;
  for (const RelaxationMode& m : modes)
    text +=
        fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", m.modulus, m.relaxation_time);
  return '[' + text + ']';
}

std::string toml_text(std::string_view value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\')
      text += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      text += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      text += c;
  }
  return text + '"';
}

} // namespace ehdjet
