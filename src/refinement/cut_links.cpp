#include "ehdjet/core/error.hpp"
#include "ehdjet/refinement/akima_spline.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

namespace ehdjet {
namespace {

constexpr double most_links = 1e7;

std::size_t upstream(const JetState& jet, std::size_t bead) {
  return bead <= jet.first() ? 0 : bead - 1;
}

std::size_t first_to_cut(const JetState& jet, const RefinementRule& rule) {
  return jet.first() + rule.first_knot();
}

bool is_too_long(const JetState& jet, std::size_t bead, double length) {
  const ConstVec3View r = jet.columns().position();
  const std::size_t up = upstream(jet, bead);
  if (!((r[bead] - r[up]).squaredNorm() > length * length)) return false;
  return !(jet.is_landed(bead) && jet.is_landed(up)); // nothing moves there any more
}

/// A link that is to be cut into equal parts.
struct Cut {
  std::size_t bead = 0, parts = 0;
};

std::vector<Cut> find_cuts(const JetState& jet, const RefinementRule& rule) {
  std::vector<Cut> cuts;
  auto links = static_cast<double>(jet.links());
  for (std::size_t k = first_to_cut(jet, rule); k < jet.beads(); ++k) {
    if (!is_too_long(jet, k, rule.length)) continue;
    const double parts = std::max(std::ceil(link_length(jet, k) / rule.length), 2.0);
    links += parts - 1;
    if (!(links <= most_links))
      throw RunError(fmt::format("refinement would make more than {:.0e} links: link {} is "
                                 "{:.3g} m long",
                                 most_links, k, link_length(jet, k)));
    cuts.push_back({.bead = k, .parts = static_cast<std::size_t>(parts)});
  }
  return cuts;
}

/// Akima's curve near one link. A value acts on three intervals to either side: with three knots above
/// the link and two below it the curve in the link is the one through all beads.
class LocalCurve {
public:
  LocalCurve(const JetState& jet, const Cut& cut)
      : beads_(beads_near(jet, cut.bead))
      , arc_length_(chords(jet, beads_))
      , spline_(arc_length_)
      , values_(beads_.size()) {
    const auto end =
        static_cast<std::size_t>(std::ranges::find(beads_, cut.bead) - beads_.begin());
    const double start = arc_length_[end - 1], length = arc_length_[end] - start;
    for (std::size_t i = 1; i < cut.parts; ++i)
      at_.push_back(start
                    + length * static_cast<double>(i) / static_cast<double>(cut.parts));
  }

  /// out (parts - 1): a column at the new beads.
  void interpolate(std::span<const double> column, std::span<double> out) {
    std::ranges::transform(beads_, values_.begin(),
                           [&](std::size_t k) { return column[k]; });
    spline_.interpolate(values_, at_, out);
  }

private:
  static std::vector<std::size_t> beads_near(const JetState& jet, std::size_t bead) {
    std::vector<std::size_t> above;
    for (std::size_t k = bead; above.size() < 3 && k > 0;)
      above.push_back(k = upstream(jet, k));
    std::vector<std::size_t> beads(above.rbegin(), above.rend());
    for (std::size_t k = bead; k < std::min(bead + 3, jet.beads()); ++k) beads.push_back(k);
    return beads;
  }
  static std::vector<double> chords(const JetState& jet,
                                    const std::vector<std::size_t>& beads) {
    std::vector<double> arc_length{0};
    for (std::size_t i = 1; i < beads.size(); ++i) {
      const double length = link_length(jet, beads[i]);
      if (!(length > 0))
        throw RunError(fmt::format("bead {} coincides with bead {} or is nowhere: no curve "
                                   "goes through them",
                                   beads[i], beads[i - 1]));
      arc_length.push_back(arc_length.back() + length);
    }
    return arc_length;
  }

  std::vector<std::size_t> beads_;
  std::vector<double> arc_length_, at_;
  AkimaSpline spline_;
  std::vector<double> values_;
};

/// The same jet with room for the new beads of the cuts, whose values are still zero.
JetState make_room(const JetState& jet, const std::vector<Cut>& cuts,
                   std::vector<std::size_t>& place) {
  place.resize(jet.beads());
  auto cut = cuts.begin();
  std::size_t next = 0;
  for (std::size_t k = 0; k < jet.beads(); ++k) {
    if (cut != cuts.end() && cut->bead == k) next += cut++->parts - 1;
    place[k] = next++;
  }
  JetState roomy = blank_like(jet, next);
  roomy.landed = jet.landed;
  for (LandedBead& b : roomy.landed) b.bead = place[b.bead];
  const auto spread = [&](std::span<const double> from, std::span<double> to) {
    for (std::size_t k = 0; k < from.size(); ++k) to[place[k]] = from[k];
  };
  for (std::size_t c = 0; c < jet.table->integrated().size(); ++c)
    spread(jet.columns().column(c), roomy.columns().column(c));
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c)
    spread(jet.carried(c), roomy.carried(c));
  return roomy;
}

/// The change of a quantity of links over one link, between its ends: linear, from the two neighbours,
/// and within them at both ends.
///
/// Where a jet thins, the parts of a link differ. Equal parts would make a staircase of the thickness,
/// from which capillary necking grows.
struct LinkSlope {
  double above = 0, here = 0,
         below = 0; // lengths of the link above, of this one, of the one below

  [[nodiscard]] double change(double upper, double own, double lower) const {
    const double up = own - upper, down = lower - own;
    if (!(up * down > 0)) return 0;
    const double mean = here * (up / (above + here) + down / (here + below));
    const double size = std::min({std::abs(mean), 2 * std::abs(up), 2 * std::abs(down)});
    return std::copysign(size, up);
  }
};

/// What the parts of a link have: shares of its amounts, and their own values of columns of links.
class Parts {
public:
  Parts(const JetState& jet, const Cut& cut, const RefinementRule& rule)
      : cut_(cut)
      , shares_(cut.parts, 1 / static_cast<double>(cut.parts)) {
    const std::size_t k = cut.bead;
    has_neighbours_ =
        k > first_to_cut(jet, rule) && k + 1 < jet.beads() && !jet.is_landed(k);
    if (!has_neighbours_) return;
    slope_ = {.above = link_length(jet, k - 1),
              .here = link_length(jet, k),
              .below = link_length(jet, k + 1)};
    const double own = jet.volume[k] / slope_.here;
    const double change = slope_.change(jet.volume[k - 1] / slope_.above, own,
                                        jet.volume[k + 1] / slope_.below);
    for (std::size_t i = 0; i < cut.parts; ++i) shares_[i] *= 1 + change / own * place(i);
  }
  [[nodiscard]] const std::vector<double>& shares() const { return shares_; }

  /// The sum of share times value is that of the link.
  void values(std::span<const double> column, std::span<double> out) const {
    const std::size_t k = cut_.bead;
    const double change =
        has_neighbours_ ? slope_.change(column[k - 1], column[k], column[k + 1]) : 0;
    double mean = 0;
    for (std::size_t i = 0; i < cut_.parts; ++i) mean += shares_[i] * place(i);
    for (std::size_t i = 0; i < cut_.parts; ++i)
      out[i] = column[k] + change * (place(i) - mean);
  }

private:
  /// Middle of a part, from -1/2 to 1/2 along the link.
  [[nodiscard]] double place(std::size_t i) const {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(cut_.parts) - 0.5;
  }

  Cut cut_;
  bool has_neighbours_ = false;
  LinkSlope slope_;
  std::vector<double> shares_;
};

/// Fills in what the parts of a link have.
void fill_parts(const JetState& jet, const Cut& cut, const RefinementRule& rule,
                std::size_t last, JetState& refined) {
  const BeadTable& table = *jet.table;
  const std::size_t first = last - (cut.parts - 1);
  LocalCurve curve(jet, cut);
  const Parts parts(jet, cut, rule);
  for (std::size_t c = 0; c < table.integrated().size(); ++c) {
    const auto column = refined.columns().column(c).subspan(first, cut.parts);
    if (table.integrated()[c].owner == Owner::link)
      parts.values(jet.columns().column(c), column);
    else
      curve.interpolate(jet.columns().column(c), column.first(cut.parts - 1));
  }
  if (rule.collector)
    for (double& x : refined.columns().position().x.subspan(first, cut.parts - 1))
      x = std::min(x, *rule.collector);
  for (std::size_t c = 0; c < table.carried().size(); ++c) {
    const auto column = std::span(refined.carried(c)).subspan(first, cut.parts);
    const double whole = jet.carried(c)[cut.bead];
    std::ranges::fill(column, whole);
    if (table.carried()[c].remap == ColumnRemap::share)
      std::ranges::transform(parts.shares(), column.begin(),
                             [whole](double share) { return share * whole; });
  }
}

} // namespace

bool has_long_link(const JetState& jet, const RefinementRule& rule) {
  for (std::size_t k = first_to_cut(jet, rule); k < jet.beads(); ++k)
    if (is_too_long(jet, k, rule.length)) return true;
  return false;
}

std::optional<MeshChange> cut_links(JetState& jet, const RefinementRule& rule) {
  const std::vector<Cut> cuts = find_cuts(jet, rule);
  if (cuts.empty()) return std::nullopt;
  std::vector<std::size_t> place;
  JetState refined = make_room(jet, cuts, place);
  MeshChange change{.kept = upstream(jet, cuts.front().bead),
                    .before = jet.links(),
                    .after = refined.links()};
  for (const Cut& cut : cuts) {
    const std::size_t last = place[cut.bead];
    fill_parts(jet, cut, rule, last, refined);
    const double part = link_length(jet, cut.bead) / static_cast<double>(cut.parts);
    for (std::size_t k = last + 1 - cut.parts; k <= last; ++k)
      change.worst_link =
          std::max(change.worst_link, std::abs(link_length(refined, k) / part - 1));
  }
  jet = std::move(refined);
  return change;
}

} // namespace ehdjet
