#include "ehdjet/refinement/mesh.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/jet/curvature.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ehdjet {
namespace {

// ceil would make sixteen links of 15 x 0.2 = 3.0000000000000004.
constexpr double round_off = 1e-12;

// A weight is estimated on the mesh that it makes: links that it finds a little too long right
// after a remesh are no reason for the next one.
constexpr double slack_of_weighted_links = 1.25;

double observable(const JetString& string, const JetState& jet, MeshWeight weight,
                  std::size_t knot) { // of the link that ends at the knot
  const auto r = jet.columns().position();
  const auto bead = [&](std::size_t i) { return string.bead(i); };
  const auto curvature = [&](std::size_t i) { // an end bends like its neighbour
    if (string.knots() < 3) return 0.0;
    i = std::clamp<std::size_t>(i, 1, string.knots() - 2);
    const Vec3 at = r[bead(i)];
    return curvature_vector(r[bead(i - 1)] - at, r[bead(i + 1)] - at).norm();
  };
  switch (weight) {
  case MeshWeight::curvature:
    return (curvature(knot - 1) + curvature(knot)) / 2;
  case MeshWeight::radius:
    return link_radius(jet.volume[bead(knot)], string.link(knot));
  case MeshWeight::stress:
    return jet.columns().has_stress() ? std::abs(jet.columns().stress()[bead(knot)]) : 0.0;
  case MeshWeight::uniform:
    break;
  }
  return 0;
}

// Links per length that a weighted mesh should have along each link [1/m]; entry 0 is unused.
std::vector<double> link_density(const JetString& string, const JetState& jet,
                                 std::size_t first_knot, const MeshRule& rule) {
  std::vector<double> density(string.knots());
  double mean = 0;
  for (std::size_t i = first_knot + 1; i < string.knots(); ++i) {
    density[i] = observable(string, jet, rule.weight, i);
    mean += density[i] * string.link(i);
  }
  mean /= string.length() - string.arc_length[first_knot];
  for (std::size_t i = first_knot + 1; i < string.knots(); ++i) {
    const double relative = mean > 0 ? density[i] / mean : 1.0;
    const double weight = (1 + rule.strength * relative) / (1 + rule.strength);
    const double length = std::clamp(rule.length / weight, rule.shortest, rule.longest);
    density[i] = 1 / length;
  }
  return density;
}

std::size_t links_needed(double number) {
  constexpr double countable = 1e18;
  return static_cast<std::size_t>(std::ceil(std::min(number, countable) * (1 - round_off)));
}

void refuse_slips(std::size_t links, const MeshRule& rule) {
  if (links <= rule.refused_above) return;
  constexpr double per_bead = 1.2e-6; // [GB], state and stages of an integrator
  const auto number = static_cast<double>(links);
  throw RunError(fmt::format(
      "refinement.length = {:g} m would cut the jet into {:.3g} links, more than {:.0e}, "
      "and take about {:.2g} GB: give "
      "a larger length (in metres), or bound the number by refinement.max_beads",
      rule.length, number, static_cast<double>(rule.refused_above), per_bead * number));
}

std::optional<std::size_t> new_links(double number, std::size_t kept,
                                     const JetString& string, const MeshRule& rule) {
  const std::size_t present = string.knots() - 1 - kept;
  // An embryo takes a place, too.
  const std::size_t before = string.bead(kept);
  const std::size_t room = rule.most_links > before ? rule.most_links - before : 0;
  const std::size_t links = std::min(links_needed(number), room);
  if (links <= present) return std::nullopt;
  refuse_slips(links, rule);
  return links;
}

std::optional<Mesh> uniform_mesh(const JetString& string, std::size_t first_knot,
                                 const MeshRule& rule) {
  std::size_t s = first_knot;
  while (s + 1 < string.knots() && string.link(s + 1) <= rule.length * (1 + round_off)) ++s;
  if (s + 1 >= string.knots()) return std::nullopt;
  const double start = string.arc_length[s], length = string.length() - start;
  const auto links = new_links(length / rule.length, s, string, rule);
  if (!links) return std::nullopt;

  Mesh mesh{.kept = s, .arc_length = std::vector<double>(*links)};
  for (std::size_t j = 1; j < *links; ++j)
    mesh.arc_length[j - 1] =
        start + length * (static_cast<double>(j) / static_cast<double>(*links));
  mesh.arc_length.back() = string.length();
  return mesh;
}

std::optional<Mesh> weighted_mesh(const JetString& string, const JetState& jet,
                                  std::size_t first_knot, const MeshRule& rule) {
  if (first_knot + 1 >= string.knots()) return std::nullopt;
  const auto density = link_density(string, jet, first_knot, rule);
  const auto links_along = [&](std::size_t i) { return density[i] * string.link(i); };
  std::size_t s = first_knot;
  while (s + 1 < string.knots() && links_along(s + 1) <= slack_of_weighted_links) ++s;
  double number = 0;
  for (std::size_t i = s + 1; i < string.knots(); ++i) number += links_along(i);
  if (number == 0) return std::nullopt;
  const auto links = new_links(number, s, string, rule);
  if (!links) return std::nullopt;

  Mesh mesh{.kept = s, .arc_length = std::vector<double>(*links)};
  std::size_t i = s + 1; // the link in which the next knot lies
  double before = 0;     // links up to its start
  for (std::size_t j = 1; j < *links; ++j) {
    const double target = number * (static_cast<double>(j) / static_cast<double>(*links));
    while (i + 1 < string.knots() && before + links_along(i) < target)
      before += links_along(i), ++i;
    mesh.arc_length[j - 1] = std::min(
        string.arc_length[i - 1] + (target - before) / density[i], string.arc_length[i]);
  }
  mesh.arc_length.back() = string.length();
  return mesh;
}

} // namespace

std::optional<Mesh> plan_mesh(const JetString& string, const JetState& jet,
                              std::size_t first_knot, const MeshRule& rule) {
  EHDJET_EXPECTS(rule.length > 0 && rule.shortest <= rule.longest);
  const bool weighted = rule.weight != MeshWeight::uniform && rule.strength > 0;
  return weighted ? weighted_mesh(string, jet, first_knot, rule)
                  : uniform_mesh(string, first_knot, rule);
}

} // namespace ehdjet
