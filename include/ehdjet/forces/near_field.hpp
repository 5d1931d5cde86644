#pragma once

#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/forces/sub_grid.hpp"
#include "ehdjet/jet/nozzle.hpp"

#include <optional>
#include <vector>

namespace ehdjet {

/// How the radius of a thread answers to its stretching, as far as its charge is concerned.
enum class NearFieldKind {
  free_surface, ///< the volume of a link stays: conservative
  fixed ///< the radius stays: for comparison with thin rigid threads; it has no energy
};

/// What point charges at the beads leave out of the electrostatic energy of a thread (model 3.1):
///
///     U_k = k_C (q_k^2/l_k) d(a_k/l_k)
///     P_k = k_C (q_k^2/l_k^2) (d + w e),   w = 3/2 (free surface), 1 (fixed)
///
/// The tension of link k is lower by P_k. With point pairs, d + w e = ln(l_k/a_k) - B with
/// B = 1.3840684843415876 or 0.8840684843415876.
///
/// While bead 1 is an embryo with the share f of its charge, link 2 is the mean of a link of length d and
/// one of length d - l_step, with the weights 1 - f and f.
///
/// source : derived in docs/near_field.md
/// laws   : free surface: F = -grad U; second order in l; with softened pairs also where l < a; O(n)
class NearField final : public ForceTerm {
public:
  struct Options {
    NearFieldKind kind = NearFieldKind::free_surface;
    bool softened = false;             ///< the sub-grid functions of softened pairs
    std::optional<Embryo> embryo = {}; ///< of the inflow, if beads are born that way
  };
  explicit NearField(const Options& options)
      : options_(options) {}
  [[nodiscard]] std::string_view name() const override { return "near field"; }
  void add_force(const Stage& stage, Vec3View force) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override;
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void add_tension(const Stage& stage, std::span<double> tension) override;

private:
  /// P, dP/dl and U of a link.
  struct Push {
    double push = 0, slope = 0, energy = 0; // [N], [N/m], [J]
    Push& add(const Push& o, double weight);
  };
  [[nodiscard]] SubGrid sub_grid(double eta) const {
    return options_.softened ? sub_grid_of_softened(eta) : sub_grid_of_points(eta);
  }
  [[nodiscard]] double weight() const { // w
    return options_.kind == NearFieldKind::free_surface ? 1.5 : 1.0;
  }
  /// Whether link k is the one that an embryo stands on.
  [[nodiscard]] bool is_split(const Stage& stage, std::size_t k) const;
  [[nodiscard]] Push push(double charge, double volume, double length) const;
  [[nodiscard]] Push push_of_link(const Stage& stage, std::size_t k) const;

  Options options_;
  std::vector<double> tension_per_length_; // - P/l [N/m]
};

} // namespace ehdjet
