#include "ehdjet/refinement/mesh.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ehdjet {
namespace {

// Without it, ceil would make sixteen links of 15 x 0.2 = 3.0000000000000004.
constexpr double round_off = 1e-12;
// So many links are a slip in the scene; they would take gigabytes of memory.
constexpr double most_links = 1e7;

void refuse_slips(double links, double length) {
  if (links <= most_links) return;
  constexpr double per_bead = 1.2e-6; // [GB], state and stages of an integrator
  throw RunError(fmt::format(
      "refinement.length = {:g} m would cut the jet into {:.3g} links, more than {:.0e}, "
      "and take about {:.2g} GB: give a larger length (in metres)",
      length, links, most_links, per_bead * links));
}

} // namespace

std::optional<Mesh> plan_mesh(const JetString& string, std::size_t first_knot,
                              double length) {
  EHDJET_EXPECTS(length > 0);
  std::size_t s = first_knot;
  while (s + 1 < string.knots() && string.link(s + 1) <= length * (1 + round_off)) ++s;
  if (s + 1 >= string.knots()) return std::nullopt;
  const double start = string.arc_length[s], rest = string.length() - start;
  const double needed = std::ceil(rest / length * (1 - round_off));
  if (needed <= static_cast<double>(string.knots() - 1 - s)) return std::nullopt;
  refuse_slips(needed, length);

  const auto links = static_cast<std::size_t>(needed);
  Mesh mesh{.kept = s, .arc_length = std::vector<double>(links)};
  for (std::size_t j = 1; j < links; ++j)
    mesh.arc_length[j - 1] = start + rest * (static_cast<double>(j) / needed);
  mesh.arc_length.back() = string.length();
  return mesh;
}

} // namespace ehdjet
