#pragma once

#include "ehdjet/forces/surface_tension.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/chain.hpp"
#include "support/march.hpp"
#include "support/scenes.hpp"

/// Where the energy of a chain goes.
namespace ehdjet::test {

/// Everything the energy of a chain can be, and what has left or entered it [J].
struct ChainBudget {
  double kinetic = 0, coulomb = 0, field = 0, elastic = 0, line_tension = 0;
  double dissipated = 0, work = 0; // of the fluid; of the paper's surface tension

  [[nodiscard]] double stored() const {
    return kinetic + coulomb + field + elastic + line_tension;
  }
};

/// The equations of motion, with two more unknowns behind them: the dissipated energy
/// sum V sigma^2/mu and the work sum f.v of the paper's surface tension.
class BudgetedChain final : public OdeSystem {
public:
  /// How the chain is moved.
  struct Motion {
    std::string method = "dop853";
    double rtol = 1e-12;
    CoulombConfig coulomb = {};
  };
  /// A chain scene of the PVP fluid with field, charges, viscoelasticity and surface tension.
  explicit BudgetedChain(const Scene& scene)
      : BudgetedChain(scene, Motion()) {}
  BudgetedChain(Scene scene, Motion motion)
      : line_(scene.config.surface_tension->form == SurfaceTensionForm::line)
      , held_(scene.config.chain->fixed == FixedEnds::first)
      , field_(scene.config.field->strength.value())
      , chain_(scene.chain.size())
      , paper_(pvp::surface_tension)
      , motion_(std::move(motion)) {
    scene.config.coulomb = motion_.coulomb;
    dynamics_ = build_dynamics(scene);
    jet_ = initial_jet(scene);
    dynamics_->bind(jet_);
    chain_.mass = jet_.mass, chain_.charge = jet_.charge, chain_.volume = jet_.volume;
  }

  void evaluate(double t, std::span<const double> y, std::span<double> rate) override {
    const std::size_t n = jet_.y.size();
    dynamics_->evaluate(t, y.first(n), rate.first(n));
    std::ranges::copy(y.first(n), chain_.flat.begin());
    double dissipation = 0, power = 0;
    for (std::size_t k = 1; k < jet_.beads(); ++k) {
      const double sigma = stress_of(chain_.columns())[k];
      dissipation += jet_.volume[k] * sigma * sigma / pvp::viscosity;
    }
    if (!line_) {
      const std::vector<Vec3> f = chain_.force(paper_);
      for (std::size_t k = 0; k < jet_.beads(); ++k)
        power += f[k].dot(chain_.columns().velocity()[k]);
    }
    rate[n] = dissipation, rate[n + 1] = power;
  }

  [[nodiscard]] ChainBudget budget_at(double t) {
    std::vector<double> y = jet_.y;
    y.resize(y.size() + 2, 0.0);
    ErrorScale scale{.rtol = motion_.rtol,
                     .column_scale = std::vector<double>(y.size(), 1e-4)};
    for (std::size_t i = 0; i < jet_.y.size(); ++i) { // metres, metres per second, pascals
      const std::size_t column = i / jet_.beads();
      scale.column_scale[i] = column < 3   ? pvp::link_length
                              : column < 6 ? 1
                                           : 0.1 * pvp::modulus;
    }
    scale.column_scale[jet_.y.size()] = scale.column_scale[jet_.y.size() + 1] = 0.1 * erg;
    if (t > 0) y = march_adaptively(motion_.method, *this, y, 0, t, scale);
    return measure(y);
  }

private:
  ChainBudget measure(const std::vector<double>& y) {
    const JetColumns<const double> c{std::span(y).first(jet_.y.size()), jet_.beads()};
    const auto r = c.position(), v = c.velocity();
    ChainBudget b;
    for (std::size_t k = 0; k < jet_.beads(); ++k) {
      if (k > 0 || !held_) {
        b.kinetic += jet_.mass[k] * v[k].squaredNorm() / 2;
        b.field -= jet_.charge[k] * field_ * r[k].x();
      }
      for (std::size_t j = 0; j < k; ++j)
        b.coulomb +=
            constants::coulomb * jet_.charge[k] * jet_.charge[j] / (r[k] - r[j]).norm();
      if (k == 0) continue;
      const double sigma = stress_of(c)[k], length = (r[k] - r[k - 1]).norm();
      b.elastic += jet_.volume[k] * sigma * sigma / (2 * pvp::modulus);
      if (line_) // the lateral surface 2 pi a l
        b.line_tension += 2 * pvp::surface_tension
                          * std::sqrt(std::numbers::pi * jet_.volume[k] * length);
    }
    b.dissipated = y[jet_.y.size()], b.work = y[jet_.y.size() + 1];
    return b;
  }

  bool line_, held_;
  double field_; // [V/m]
  Chain chain_;
  BendingSurfaceTension paper_;
  Motion motion_;
  std::unique_ptr<JetDynamics> dynamics_;
  JetState jet_;
};

} // namespace ehdjet::test
