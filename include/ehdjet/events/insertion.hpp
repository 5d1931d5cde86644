#pragma once

#include "ehdjet/events/event.hpp"
#include "ehdjet/jet/nozzle.hpp"

#include <cstdint>
#include <optional>

namespace ehdjet {

/// What every bead that is born at the nozzle carries (model 1):
///
///     V0 = pi a0^2 l_step,   m0 = rho V0,   q0 = rho_q V0
struct NewBead {
  double volume = 0; ///< V0 [m^3]
  double mass = 0;   ///< m0 [kg]
  double charge = 0; ///< q0 [C]

  static NewBead from(double radius, double link_length, double density,
                      double charge_density);
};

/// Every k-th bead differs: an impurity that makes the jet varicose (model 4).
struct Varicosity {
  std::uint64_t every = 1;                 ///< k, counted with the bead of the start
  double volume = 1, mass = 1, charge = 1; ///< factors f
};

/// Velocity that a released bead starts with (model 4.2).
enum class ReleaseVelocity {
  half,  ///< ((v_2x - v_s)/2 + v_s, v_2y/2, v_2z/2), the paper's
  nozzle ///< (v_s, 0, 0)
};

/// An embryo is created between nozzle and bead 1 when |r_1 - r_0| reaches 1.5 l_step (model 4.1).
/// Nothing jumps: its charge grows from zero and it carries no stress.
class Insertion final : public Event {
public:
  Insertion(const Nozzle& nozzle, const Embryo& embryo, const NewBead& born,
            std::optional<Varicosity> varicosity = {})
      : nozzle_(nozzle)
      , embryo_(embryo)
      , born_(born)
      , varicosity_(varicosity) {}
  [[nodiscard]] std::string_view name() const override { return "insertion"; }
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;
  [[nodiscard]] bool restarts_motion() const override { return true; }

private:
  [[nodiscard]] double excess(const DenseStep& step,
                              double theta) const; // [m], >= 0: happens

  Nozzle nozzle_;
  Embryo embryo_;
  NewBead born_;
  std::optional<Varicosity> varicosity_;
};

/// The embryo becomes a free bead when |r_2 - r_0| reaches 2 l_step: stress 0, full charge. Bead 2
/// keeps its stress and volume while its link shrinks from 2 l_step to l_step (model 4.2).
class Release final : public Event {
public:
  Release(const Nozzle& nozzle, const Embryo& embryo, ReleaseVelocity velocity)
      : nozzle_(nozzle)
      , embryo_(embryo)
      , velocity_(velocity) {}
  [[nodiscard]] std::string_view name() const override { return "release"; }
  [[nodiscard]] bool due(const JetState& jet) const override;
  [[nodiscard]] std::optional<double> locate(const DenseStep& step) override;
  [[nodiscard]] std::optional<double> predict(const DenseStep& step) const override;
  void apply(EventContext& context) override;
  [[nodiscard]] bool restarts_motion() const override { return true; }

private:
  [[nodiscard]] double excess(const DenseStep& step, double theta) const;

  Nozzle nozzle_;
  Embryo embryo_;
  ReleaseVelocity velocity_;
};

} // namespace ehdjet
