#include "ehdjet/scene/calibration_file.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/text_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
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
        key,
        fmt::format("{}: {} numbers, must be {}, one for each number of charges (direct) "
                    "and tolerance (fmm)",
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
  const SceneText text(read_text_file(file, "the calibration"), file.string(), {});
  const std::set<std::string, std::less<>> known{"charges", "tolerances", "direct",
                                                 "fmm_jet", "fmm_cloud"};
  for (const auto& entry : text.root()) {
    const std::string key(entry.first.str());
    if (key == "fmm" || key == "treecode")
      text.fail(
          key,
          fmt::format("{} in a calibration: the file is from an earlier version that had "
                      "one table for jets and clouds of charges. Write it anew: "
                      "ehdjet calibrate -o {} --force",
                      key, file.string()));
    if (!known.contains(key))
      text.fail(key, fmt::format("unknown key {} in a calibration", key));
  }
  CostModel model;
  model.charges = grid(text, "charges");
  model.tolerances = grid(text, "tolerances");
  const std::size_t c = model.charges.size(), tc = model.tolerances.size() * c;
  model.direct = positive_numbers(text, "direct", c);
  model.jet = positive_numbers(text, "fmm_jet", tc);
  model.cloud = positive_numbers(text, "fmm_cloud", tc);
  return model;
}

std::string calibration_text(const CostModel& model, const std::string& comment) {
  std::string text = fmt::format(
      "# Seconds per force call of the Coulomb solvers, for each number of charges, and "
      "for "
      "fmm a row\n# for each tolerance; measured by `ehdjet calibrate`.\n# {}\n"
      "charges = [{:g}]\ntolerances = [{:g}]\n",
      comment, fmt::join(model.charges, ", "), fmt::join(model.tolerances, ", "));
  const auto add = [&](const char* key, const std::vector<double>& seconds) {
    text += fmt::format("{} = [\n", key);
    const std::size_t columns = model.charges.size();
    for (std::size_t i = 0; i < seconds.size(); ++i)
      text += fmt::format("{}{:.4g},{}", i % columns == 0 ? "  " : " ", seconds[i],
                          (i + 1) % columns == 0 ? "\n" : "");
    text += "]\n";
  };
  add("direct", model.direct), add("fmm_jet", model.jet), add("fmm_cloud", model.cloud);
  return text;
}

} // namespace ehdjet
