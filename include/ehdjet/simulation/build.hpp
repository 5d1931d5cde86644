#pragma once

#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/integrators/error_scale.hpp"
#include "ehdjet/scene/config.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/array_simulation.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <memory>
#include <vector>

namespace ehdjet {

/// What a program adds to a scene: terms of the equations of motion, events, which come after those
/// of the scene at the same instant, and observers.
struct Extras {
  std::vector<std::unique_ptr<ForceTerm>> forces;
  std::vector<std::unique_ptr<Event>> events;
  std::vector<std::shared_ptr<Observer>> observers;
};

/// Composes a simulation from a scene: the only place that asks what a scene has. From then on
/// presence is structure: a term, event or column that the scene does not name does not exist.
/// What writes files is added by `run_scene` (runs/run_scene.hpp).
///
/// errors : InputError for names that no solver or method has, and for a scene with [array]
std::unique_ptr<Simulation> build_simulation(const Scene& scene, Extras extras = {});

/// The same of a scene with [array].
std::unique_ptr<ArraySimulation> build_array_simulation(const Scene& scene);

/// The right-hand side alone, of a single jet.
std::unique_ptr<JetDynamics> build_dynamics(const Scene& scene);

/// What a scene asks of the Coulomb solver.
SolverOptions solver_options(const SceneConfig& config,
                             const std::optional<CostModel>& costs);

/// The columns of a jet: those of every jet and those that the terms add, with the error scales
/// and remaps that the scene asks for.
std::shared_ptr<const BeadTable> bead_table(const Scene& scene,
                                            const JetDynamics& dynamics);

/// The error that the scene allows in each integrated column.
ErrorScale error_scale(const Scene& scene, const BeadTable& table);

/// The jet at t = 0: nozzle and one bead (model 4), or the given chain. Without a table: that of
/// the scene's own terms.
/// errors : InputError if the chain file has a column that is in the table but is not numbers
JetState initial_jet(const Scene& scene, std::shared_ptr<const BeadTable> table);
JetState initial_jet(const Scene& scene);

} // namespace ehdjet
