#include "ehdjet/refinement/refine_jet.hpp"

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/refinement/akima_spline.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace ehdjet {
namespace {

using Values = std::vector<double>;

double sum(std::span<const double> values) {
  CompensatedSum total;
  for (const double v : values) total += v;
  return total;
}

Values cumulative(std::span<const double> values) { // from 0 on
  Values sums(values.size() + 1, 0.0);
  std::partial_sum(values.begin(), values.end(), sums.begin() + 1);
  return sums;
}

constexpr std::size_t volume_column = 0; // of the carried ones

// A jet whose beads 0 ... s are those of another one and whose others are still to be filled in.
JetState with_room(const JetState& old, std::size_t s, std::size_t beads) {
  JetState jet = blank_like(old, beads);
  for (std::size_t c = 0; c < old.table->integrated().size(); ++c)
    std::ranges::copy(old.columns().column(c).first(s + 1),
                      jet.columns().column(c).begin());
  for (std::size_t c = 0; c < old.table->carried().size(); ++c)
    std::copy_n(old.carried(c).begin(), s + 1, jet.carried(c).begin());
  for (const LandedBead& b : old.landed) {
    if (b.bead <= s) jet.landed.push_back(b);
    if (b.bead == old.links())
      jet.landed.push_back({.bead = beads - 1, .time = b.time, .radius = b.radius});
  }
  return jet;
}

// One refinement: an old jet, its string and new mesh, and the jet on that mesh.
class Remeshing {
public:
  Remeshing(const JetState& old, const JetString& string, const Mesh& mesh,
            const RefinementRule& rule)
      : old_(old)
      , string_(string)
      , rule_(rule)
      , mesh_(mesh)
      , s_(string.bead(mesh.kept))
      , jet_(with_room(old, s_, s_ + 1 + mesh.arc_length.size()))
      , spline_(string.arc_length) {}

  JetState run() {
    const auto integrated = old_.table->integrated(), carried = old_.table->carried();
    for (std::size_t c = 0; c < integrated.size(); ++c) {
      Values values = string_.at_knots(old_.columns().column(c));
      if (integrated[c].owner == Owner::link) values[0] = values[1]; // bead 0 owns none
      spline_.interpolate(values, mesh_.arc_length, fresh(jet_.columns().column(c)));
    }
    keep_end();
    // What links carry needs the places of the new beads (the paper's way), or is shared out along
    // the old arc length.
    if (rule_.remap == LinkRemap::paper) {
      remap_radius();
    } else {
      const Remap remap = behind_kept();
      for (std::size_t c = 0; c < carried.size(); ++c)
        if (carried[c].remap == ColumnRemap::share)
          std::ranges::copy(remap(behind_s(old_.carried(c))),
                            fresh(jet_.carried(c)).begin());
    }
    for (std::size_t c = 0; c < carried.size(); ++c)
      if (carried[c].remap == ColumnRemap::label) inherit(c);
    for (std::size_t c = 0; c < integrated.size(); ++c)
      if (integrated[c].remap == ColumnRemap::conservative)
        average(c, *old_.table->weight_of(c));
    keep_landed_record();
    return std::move(jet_);
  }

private:
  // The entries of the new beads, those behind s.
  [[nodiscard]] std::span<double> fresh(std::span<double> column) const {
    return column.subspan(s_ + 1);
  }
  [[nodiscard]] std::span<const double> behind_s(std::span<const double> column) const {
    return column.subspan(s_ + 1);
  }
  // From the old links behind s to the new ones.
  [[nodiscard]] Remap behind_kept() const {
    const auto start = string_.arc_length.begin() + static_cast<std::ptrdiff_t>(mesh_.kept);
    Values to{*start};
    to.insert(to.end(), mesh_.arc_length.begin(), mesh_.arc_length.end());
    return {Values(start, string_.arc_length.end()), to};
  }

  // The leading bead stays where it is, to the last bit; no other one lies beyond the collector.
  void keep_end() {
    restore_end(0);
    if (!rule_.collector) return;
    for (double& x : fresh(jet_.columns().position().x)) x = std::min(x, *rule_.collector);
  }
  // A bead that rests keeps what it had at its landing, however the columns are remapped.
  void keep_landed_record() {
    if (jet_.is_landed(jet_.links())) restore_end(3); // no remap moves it
  }
  void restore_end(std::size_t first_column) {
    for (std::size_t c = first_column; c < old_.table->integrated().size(); ++c)
      jet_.columns().column(c).back() = old_.columns().column(c).back();
  }

  // A new link has the value of the old link in which its middle lies.
  void inherit(std::size_t carried) {
    std::size_t i = mesh_.kept + 1;
    double before = string_.arc_length[mesh_.kept];
    const auto label = fresh(jet_.carried(carried));
    for (std::size_t j = 0; j < mesh_.arc_length.size(); ++j) {
      const double middle = (before + mesh_.arc_length[j]) / 2;
      while (i + 1 < string_.knots() && string_.arc_length[i] < middle) ++i;
      label[j] = old_.carried(carried)[string_.bead(i)];
      before = mesh_.arc_length[j];
    }
  }

  // A column as the average of itself weighted with what the links carry: shared out along the
  // carried quantity, so that the sum of the product is kept however that was remapped.
  void average(std::size_t c, std::size_t carried) {
    const auto column = behind_s(old_.columns().column(c));
    const auto weight = behind_s(old_.carried(carried));
    const auto new_weight = fresh(jet_.carried(carried));
    Values product(column.size());
    std::ranges::transform(column, weight, product.begin(), std::multiplies{});
    Values from = cumulative(weight), to = cumulative(new_weight);
    to.back() = from.back();
    const Values moved = Remap(from, to)(product);
    std::ranges::transform(moved, new_weight, fresh(jet_.columns().column(c)).begin(),
                           std::divides{});
  }

  // The paper's way. Akima's curve may dip below zero where radii change fast; a radius stays
  // between those of the two beads it lies between.
  void remap_radius() {
    Values radius(string_.knots());
    for (std::size_t i = 1; i < radius.size(); ++i)
      radius[i] = link_radius(old_.volume[string_.bead(i)], string_.link(i));
    radius[0] = radius[1]; // bead 0 owns no link
    Values a(mesh_.arc_length.size());
    spline_.interpolate(radius, mesh_.arc_length, a);
    std::size_t i = mesh_.kept + 1;
    const auto r = std::as_const(jet_).columns().position();
    const auto volume = fresh(jet_.volume);
    for (std::size_t j = 0; j < a.size(); ++j) {
      while (i + 1 < string_.knots() && string_.arc_length[i] < mesh_.arc_length[j]) ++i;
      const auto [low, high] = std::minmax(radius[i - 1], radius[i]);
      const double within = std::clamp(a[j], low, high);
      const double length = (r[s_ + 1 + j] - r[s_ + j]).norm();
      volume[j] = std::numbers::pi * within * within * length;
    }
    const double old_volume = sum(behind_s(old_.volume));
    const double factor = old_volume / sum(volume);
    for (double& v : volume) v *= factor;
    const auto carried = old_.table->carried();
    for (std::size_t c = 0; c < carried.size(); ++c) {
      if (c == volume_column || carried[c].remap != ColumnRemap::share) continue;
      const double density = sum(behind_s(old_.carried(c))) / old_volume;
      std::ranges::transform(volume, fresh(jet_.carried(c)).begin(),
                             [density](double v) { return density * v; });
    }
  }

  const JetState& old_;
  const JetString& string_;
  const RefinementRule& rule_;
  const Mesh& mesh_;
  std::size_t s_; // bead of knot s
  JetState jet_;
  AkimaSpline spline_;
};

// max |l/l* - 1| over the new links.
double worst_link(const JetState& jet, std::size_t s, const JetString& string,
                  const Mesh& mesh) {
  const auto r = jet.columns().position();
  double worst = 0, before = string.arc_length[mesh.kept];
  for (std::size_t j = 0; j < mesh.arc_length.size(); ++j) {
    const double chord = (r[s + 1 + j] - r[s + j]).norm();
    worst = std::max(worst, std::abs(chord / (mesh.arc_length[j] - before) - 1));
    before = mesh.arc_length[j];
  }
  return worst;
}

} // namespace

std::optional<MeshChange> refine_jet(JetState& jet, const RefinementRule& rule) {
  if (jet.links() < jet.first()) return std::nullopt;
  const JetString string(jet);
  const auto mesh = plan_mesh(string, rule.first_knot(), rule.length);
  if (!mesh) return std::nullopt;
  const std::size_t s = string.bead(mesh->kept);
  JetState refined = Remeshing(jet, string, *mesh, rule).run();
  const MeshChange change{.kept = s,
                          .before = jet.links(),
                          .after = refined.links(),
                          .worst_link = worst_link(refined, s, string, *mesh)};
  jet = std::move(refined);
  return change;
}

} // namespace ehdjet
