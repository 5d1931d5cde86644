#include "close_pairs.hpp"

#include "ehdjet/core/constants.hpp"

#include <array>
#include <bit>
#include <cmath>

#include "pair_kernel.hpp"

namespace ehdjet::detail {
namespace {

constexpr std::uint32_t none = 0xffffffffU;

/// Cells per scaled length. A cell is a million close distances wide, so that close charges are
/// rarely in different cells.
constexpr double cells = 0x1p-20 / close_distance;
/// Beyond so many cells from the origin, two coordinates are either equal or not close.
constexpr double far_cell = 0x1p34;
/// In this distance from the next cell [cells], a close charge may be there, rounding included.
constexpr double at_edge = 0x1p-18;

using Cell = std::array<double, 3>;

std::size_t hash(const Cell& cell) {
  std::uint64_t h = 0;
  for (const double c : cell) {
    h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9e3779b97f4a7c15U; // -0 becomes 0
    h ^= h >> 29U;
  }
  return static_cast<std::size_t>(h);
}

double in_cells(double scaled) {
  return scaled * cells + 0.5; // the origin is in the middle of a cell
}

Cell cell_of(const Vec3& r, double scale) {
  Cell cell;
  for (std::size_t k = 0; k < 3; ++k)
    cell[k] = std::floor(in_cells(scale * r[static_cast<int>(k)]));
  return cell;
}

/// Calls `visit` for each cell that may contain places close to r.
template <class Visit>
void for_cells_around(const Vec3& r, double scale, const Visit& visit) {
  std::array<std::array<double, 2>, 3> choice;
  std::array<std::size_t, 3> choices{1, 1, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    const double t = in_cells(scale * r[static_cast<int>(k)]), cell = std::floor(t);
    choice[k] = {cell, cell};
    if (std::abs(t) > far_cell) continue;
    if (t - cell < at_edge) choice[k][1] = cell - 1, choices[k] = 2;
    if (cell + 1 - t < at_edge) choice[k][1] = cell + 1, choices[k] = 2;
  }
  for (std::size_t a = 0; a < choices[0]; ++a)
    for (std::size_t b = 0; b < choices[1]; ++b)
      for (std::size_t c = 0; c < choices[2]; ++c)
        visit(Cell{choice[0][a], choice[1][b], choice[2][c]});
}

/// k_C q_1 q_2 d/d^3 without overflow of intermediate results.
Vec3 force_of_pair(const Vec3& d, double q1, double q2) {
  const double size = d.cwiseAbs().maxCoeff();
  const Vec3 u = d / size;
  return (constants::coulomb * (q1 / size)) * (q2 / size) / (u.squaredNorm() * u.norm())
         * u;
}

bool are_close(const Vec3& a, const Vec3& b, double scale) {
  bool close = true;
  for (int k = 0; k < 3; ++k)
    close = close && std::abs(scale * a[k] - scale * b[k]) < close_distance;
  return close;
}

} // namespace

std::uint32_t& ClosePairs::list_of(const Cell& cell) {
  return lists_[hash(cell) & (lists_.size() - 1)];
}

void ClosePairs::collect_places(const PointCharges& sources, double scale) {
  lists_.assign(std::bit_ceil(2 * sources.size()), none);
  places_.clear();
  places_.reserve(sources.size());
  for (std::size_t j = 0; j < sources.size(); ++j) {
    const Vec3 r = sources.r[j];
    std::uint32_t& first = list_of(cell_of(r, scale));
    std::uint32_t at = first;
    while (at != none && places_[at].r != r) at = places_[at].next;
    if (at == none) {
      at = static_cast<std::uint32_t>(places_.size());
      places_.push_back({r, 0, 0, first});
      first = at;
    }
    places_[at].charge += sources.q[j], ++places_[at].number;
  }
}

std::size_t ClosePairs::add_forces(const PointCharges& sources, const PointCharges& targets,
                                   double scale, Vec3View force) {
  collect_places(sources, scale);
  std::size_t coincident = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Vec3 r = targets.r[i];
    for_cells_around(r, scale, [&](const Cell& cell) {
      for (std::uint32_t at = list_of(cell); at != none; at = places_[at].next) {
        const Place& place = places_[at];
        if (cell_of(place.r, scale) != cell) continue; // another cell has the same hash
        const bool is_same = place.r == r;
        if (is_same) coincident += place.number;
        const bool acts =
            !is_same && targets.q[i] != 0 && place.charge != 0; // avoids 0 * inf
        if (acts && are_close(r, place.r, scale))
          force.add(i, force_of_pair(r - place.r, targets.q[i], place.charge));
      }
    });
  }
  return coincident;
}

} // namespace ehdjet::detail
