#pragma once

#include "ehdjet/coulomb/solver_options.hpp"
#include "ehdjet/scene/config.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <memory>

namespace ehdjet {

/// Composes a simulation from a scene: the only place that asks what a scene has. From then on
/// presence is structure: a term, event or column that the scene does not name does not exist.
/// Observers are added by the caller.
///
/// errors : InputError for names that no solver or method has
std::unique_ptr<Simulation> build_simulation(const Scene& scene);

/// The right-hand side alone.
std::unique_ptr<JetDynamics> build_dynamics(const Scene& scene);

/// What a scene asks of the Coulomb solver.
SolverOptions solver_options(const SceneConfig& config,
                             const std::optional<CostModel>& costs);

/// The jet at t = 0: nozzle and one bead (model 4), or the given chain.
JetState initial_jet(const Scene& scene);

} // namespace ehdjet
