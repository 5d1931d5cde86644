#include "deposited_fibre.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "record_columns.hpp"

namespace ehdjet {

DepositedFibre::DepositedFibre(const RunReader& run) {
  const RunTable table = run.table("deposit");
  removal_time = table["removal_time"];
  y = table["y"], z = table["z"];
  radius = table["radius"];
  length = link_lengths(table);
  jet = Values(table.rows());
  if (const auto* dry = table.find("dry_radius")) dry_radius = dry->values;
  if (const auto* column = table.find("jet")) jet = column->values;
}

std::size_t DepositedFibre::landed_by(double time) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(removal_time, time)
                                  - removal_time.begin());
}

Curve DepositedFibre::on_collector(std::size_t beads, const char* colour) const {
  Curve curve{.style = "lines lw 0.7", .colour = colour, .x = {}, .y = {}, .lines = {}};
  std::vector<std::size_t> order(beads);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return jet[k]; });
  for (std::size_t i = 0; i < beads; ++i) {
    if (i == 0 || jet[order[i]] != jet[order[i - 1]]) curve.lines.push_back({i, i});
    curve.lines.back().end = i + 1;
    curve.x.push_back(y[order[i]]), curve.y.push_back(z[order[i]]);
  }
  return curve;
}

Range DepositedFibre::most_radii(const Values& radii) const {
  std::vector<std::size_t> order;
  double total = 0;
  for (std::size_t k = 0; k < radii.size(); ++k)
    if (radii[k] > 0 && std::isfinite(length[k])) order.push_back(k), total += length[k];
  std::ranges::sort(order, {}, [&](std::size_t k) { return radii[k]; });
  Range range;
  double thinner = 0;
  for (const std::size_t k : order) {
    const double middle = thinner + length[k] / 2;
    if (middle >= 0.01 * total && middle <= 0.99 * total) range.include(radii[k]);
    thinner += length[k];
  }
  return range;
}

RadiusBins::RadiusBins(const Range& most)
    : logarithmic_(most.high > 4 * most.low) {
  const double margin = logarithmic_ ? 1.2 : 1.02;
  radii_ = {most.low / margin, most.high * margin};
}

double RadiusBins::edge(std::size_t i) const {
  const double part = static_cast<double>(i) / number;
  return logarithmic_ ? radii_.low * std::pow(radii_.high / radii_.low, part)
                      : radii_.low + (radii_.high - radii_.low) * part;
}

Values RadiusBins::lengths(const DepositedFibre& fibre, const Values& radius,
                           std::size_t beads) const {
  Values length(number);
  const auto place = [&](double r) { return logarithmic_ ? std::log(r) : r; };
  const double low = place(radii_.low), width = place(radii_.high) - low;
  for (std::size_t k = 0; k < beads; ++k) {
    if (!(radius[k] > 0) || !std::isfinite(fibre.length[k])) continue;
    const double bin = std::floor((place(radius[k]) - low) / width * number);
    length[static_cast<std::size_t>(std::clamp(bin, 0.0, number - 1.0))] += fibre.length[k];
  }
  return length;
}

} // namespace ehdjet
