#include "ehdjet/scene/calibration_file.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>

#include "scene_text.hpp"

namespace ehdjet {
namespace {

std::vector<double> positive_numbers(const SceneText& text, const std::string& key,
                                     std::size_t expected) {
  const toml::node* node = text.find(key);
  if (node == nullptr || !node->is_array())
    text.fail(key, fmt::format("{}: must be an array of positive numbers", key));
  std::vector<double> values;
  for (const toml::node& entry : *node->as_array()) {
    const auto value = entry.value<double>();
    if (!entry.is_number() || !value || !(*value > 0))
      text.fail(key,
                fmt::format("{}: {} is not a positive number", key, value_text(entry)));
    values.push_back(*value);
  }
  if (expected > 0 && values.size() != expected)
    text.fail(
        key, fmt::format("{}: {} numbers, must be {}, one for each tolerance and number of "
                         "charges",
                         key, values.size(), expected));
  return values;
}

std::vector<double> grid(const SceneText& text, const std::string& key) {
  auto values = positive_numbers(text, key, 0);
  if (values.size() < 2
      || std::ranges::adjacent_find(values, std::greater_equal{}) != values.end())
    text.fail(key, fmt::format("{}: must be at least two ascending numbers", key));
  return values;
}

} // namespace

CostModel read_calibration(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw InputError(fmt::format("cannot read the calibration {}: {}", file.string(),
                                 in ? "it is a folder" : std::strerror(errno)));
  const SceneText text({std::istreambuf_iterator<char>(in), {}}, file.string(), {});
  std::set<std::string, std::less<>> known{"charges", "tolerances"};
  known.insert(priced_solvers.begin(), priced_solvers.end());
  for (const auto& entry : text.root())
    if (!known.contains(entry.first.str()))
      text.fail(entry.first.str(),
                fmt::format("unknown key {} in a calibration", entry.first.str()));
  CostModel model;
  model.charges = grid(text, "charges");
  model.tolerances = grid(text, "tolerances");
  for (std::size_t k = 0; k < priced_solvers.size(); ++k)
    model.seconds[k] = positive_numbers(text, std::string(priced_solvers[k]),
                                        model.charges.size() * model.tolerances.size());
  return model;
}

std::string calibration_text(const CostModel& model, const std::string& comment) {
  std::string text = fmt::format(
      "# Seconds per force call of each Coulomb solver; measured by "
      "`ehdjet calibrate`.\n# {}\n"
      "charges = [{:g}]\ntolerances = [{:g}]\n",
      comment, fmt::join(model.charges, ", "), fmt::join(model.tolerances, ", "));
  for (std::size_t k = 0; k < priced_solvers.size(); ++k) {
    text += fmt::format("{} = [ # a row for each tolerance\n", priced_solvers[k]);
    const std::size_t columns = model.charges.size();
    for (std::size_t i = 0; i < model.seconds[k].size(); ++i)
      text += fmt::format("{}{:.4g},{}", i % columns == 0 ? "  " : " ", model.seconds[k][i],
                          (i + 1) % columns == 0 ? "\n" : "");
    text += "]\n";
  }
  return text;
}

} // namespace ehdjet
