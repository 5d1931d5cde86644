#pragma once

#include "ehdjet/forces/force_term.hpp"

#include <vector>

namespace ehdjet {

/// The paper's surface tension, on beads with a link on either side.
///
///     F_k = alpha pi ((a_k + a_(k+1))/2)^2 K_k                          (model 2)
///
/// laws   : depends on the mesh (it acts like a line tension pi a^2 alpha / l) and does not sum
///          to zero; kept because published results rest on it
/// source : Lauricella et al., J. Comput. Sci. (2016)
class BendingSurfaceTension final : public ForceTerm {
public:
  explicit BendingSurfaceTension(double coefficient) // alpha [N/m]
      : coefficient_(coefficient) {}
  void add_force(const Stage& stage, Vec3View force) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] std::string_view name() const override { return "surface tension (paper)"; }
  [[nodiscard]] TermAccount account() const override;

private:
  double coefficient_;
  std::vector<double> radius_;
};

/// Surface tension of a slender thread: a tension pi a alpha along every link (model 2).
///
/// laws   : internal forces sum to zero; independent of the mesh
class LineSurfaceTension final : public ForceTerm {
public:
  explicit LineSurfaceTension(double coefficient) // alpha [N/m]
      : coefficient_(coefficient) {}
  void add_force(const Stage& stage, Vec3View force) override;
  void add_derivatives(const Stage& stage, LinkDerivatives& links) override;
  [[nodiscard]] std::string_view name() const override { return "surface tension (line)"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< sum 2 alpha sqrt(pi V l)
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void add_tension(const Stage& stage, std::span<double> tension) override;

private:
  double coefficient_;
  std::vector<double> tension_per_length_;
};

} // namespace ehdjet
