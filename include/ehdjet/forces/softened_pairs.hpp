#pragma once

#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/forces/near_field.hpp"
#include "ehdjet/jet/nozzle.hpp"

#include <optional>
#include <vector>

namespace ehdjet {

/// By how much charges that are closer than their radii repel each other less than points: the difference of the
/// softened pair and the pair that the Coulomb solver sums (model 3.1),
///
///     U = k_C sum q_i q_j D(r_ij),   D(r) = (g(x) - g(C) - (x - C) g'(C))/eps,   x = r/eps < C,
///     g(x) = (1 + x^2)^(-1/2) - 1/x,   eps^2 = (a_i^2 + a_j^2)/2
///
/// over neighbours along the chain. The shift makes energy and force continuous where the sum ends.
/// Bead 0 has the radius of the first link. Radii follow the links, a_k^2 = V_k/(pi l_k), unless the
/// near field is `fixed`.
///
/// source : docs/near_field.md
/// laws   : free surface: F = -grad U; nothing acts between beads farther apart than C eps
/// cost   : O(n) comparisons; pairs only where links are shorter than C eps
class SoftenedPairs final : public ForceTerm {
public:
  struct Options {
    NearFieldKind kind = NearFieldKind::free_surface;
    double range = 40;                 ///< C
    std::optional<Embryo> embryo = {}; ///< of the inflow, if beads are born that way
  };
  explicit SoftenedPairs(const Options& options);
  [[nodiscard]] std::string_view name() const override { return "softened pairs"; }
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override;
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void add_tension(const Stage& stage, std::span<double> tension) override;

private:
  /// D, dD/dr and dD/d(eps^2) of a pair.
  struct Kernel {
    double value = 0, slope = 0, by_square = 0;
  };
  [[nodiscard]] Kernel kernel(double distance, double square) const;
  [[nodiscard]] bool is_free_surface() const {
    return options_.kind == NearFieldKind::free_surface;
  }
  void set_radii(const Stage& stage);
  template <class Visit>
  void for_each_pair(const Stage& stage, std::size_t begin, std::size_t end,
                     const Visit& visit) const;
  void set_link_tension(const Stage& stage);

  Options options_;
  double end_value_, end_slope_;     // g(C), g'(C)
  std::vector<double> square_;       // a^2 of every bead [m^2]
  std::vector<double> square_slope_; // da_k^2/dl_k [m]
  std::vector<double> energy_slope_; // dU/da_k^2 [J/m^2]
  std::vector<double> tension_per_length_;
};

} // namespace ehdjet
