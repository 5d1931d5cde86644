#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/nozzle.hpp"
#include "ehdjet/jet/stage.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ehdjet {

/// What a scene has that can hold or move energy.
struct BudgetTerms {
  struct Source {
    Nozzle nozzle;
    Embryo embryo;
  };
  struct Fluid {
    double elastic_modulus = 0; ///< G [Pa]
    double viscosity = 0;       ///< mu [Pa s]
  };
  std::optional<Source> source;                 ///< bead 0 is a nozzle
  bool first_held = false, last_held = false;   ///< ends of a given chain
  std::optional<double> field;                  ///< E along +x [V/m]
  std::optional<double> gravity;                ///< g along +x [m/s^2]
  std::optional<Fluid> fluid;                   ///< links carry stress
  std::optional<double> line_tension;           ///< alpha of a tension pi a alpha [N/m]
  std::unique_ptr<ForceTerm> surface_tension{}; ///< the paper's, which has no energy
  std::unique_ptr<CoulombSolver> coulomb{};     ///< for energies
  bool lands = false, refines = false;
};

/// Where energy and momentum come from or go to.
enum class Channel {
  dissipation, ///< viscosity
  surface,     ///< the paper's surface tension
  field,       ///< momentum only: its energy is the jet's
  gravity,     ///< likewise
  nozzle,      ///< what moves bead 0 and feeds its link
  held,        ///< the held ends of a chain
  insertion,   ///< embryo: charging, leading, release
  landing,     ///< beads stopped and removed, links of landed beads that still pull
  refinement
};
inline constexpr std::size_t channels = 9;

/// What a channel brings into the jet, or brings per second.
struct Flow {
  double energy = 0;            ///< [J] or [W]
  Vec3 momentum = Vec3::Zero(); ///< [kg m/s] or [N]
};
struct Flows {
  std::array<Flow, channels> flow;
  Flow& operator[](Channel c) { return flow[static_cast<std::size_t>(c)]; }
  const Flow& operator[](Channel c) const { return flow[static_cast<std::size_t>(c)]; }
};

/// Energies and momentum of a jet.
struct JetEnergies {
  double kinetic = 0;           ///< of beads that move freely [J]
  double coulomb = 0;           ///< of all pairs of charges as they act [J]
  double field = 0;             ///< -sum q E x, charges as they act [J]
  double gravity = 0;           ///< -sum m g x, without an embryo [J]
  double elastic = 0;           ///< sum V sigma^2/(2 G) [J]
  double surface = 0;           ///< line tension: sum 2 alpha sqrt(pi V l) [J]
  Vec3 momentum = Vec3::Zero(); ///< sum m v of beads that move freely [kg m/s]
  double momentum_size = 0;     ///< sum m |v| of the same [kg m/s]

  [[nodiscard]] double total() const {
    return kinetic + coulomb + field + gravity + elastic + surface;
  }
};

/// The balance of a jet at one instant while its chain stays (model 8):
///
///     dE/dt = sum of the channels' energies,  dP/dt = sum of their momenta
///
/// It is worked out from the model, not from the forces that move the jet, and so a check on
/// them. Beads that do not move freely (nozzle, embryo, landed, held) exert forces and do work.
///
/// cost : `flows` O(n), and O(n) per bead that does not move freely; `energies` what the Coulomb
///        solver's energy costs
class JetBalance {
public:
  explicit JetBalance(BudgetTerms terms)
      : terms_(std::move(terms)) {}

  [[nodiscard]] const BudgetTerms& terms() const { return terms_; }
  /// Puts the nozzle and an embryo in their places at the jet's time.
  void prescribe(JetState& jet) const;
  [[nodiscard]] JetEnergies energies(const JetState& jet);
  [[nodiscard]] Flows flows(const JetState& jet);
  /// What an event has brought in. O(n) if it has left nearly all beads where they were.
  [[nodiscard]] Flow jump(const JetState& before, const JetState& after);

private:
  void look_at(const JetState& jet);
  [[nodiscard]] JetEnergies all_but_coulomb(const JetState& jet);
  [[nodiscard]] double coulomb_jump(const JetState& before, const JetState& after);
  [[nodiscard]] Channel support(std::size_t bead) const;
  [[nodiscard]] Vec3 motion(std::size_t held) const;
  void add_fluid(Flows& flows) const;
  void add_line_tension(Flows& flows) const;
  void add_surface_tension(Flows& flows);
  void add_coulomb(Flows& flows) const;
  void add_embryo(Flows& flows) const;

  BudgetTerms terms_;
  Stage stage_;
  std::vector<double> charge_; // as they act
  std::vector<double> charge_before_;
  std::vector<char> free_;
  std::vector<char> landed_;
  std::vector<std::size_t> held_; // beads that do not move freely
  std::vector<double> force_;
  bool has_embryo_ = false;
  double embryo_charge_ = 0; // its full charge [C]
};

} // namespace ehdjet
