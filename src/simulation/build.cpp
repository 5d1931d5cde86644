#include "ehdjet/simulation/build.hpp"

#include "ehdjet/budget/balance.hpp"
#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/events/field_switch.hpp"
#include "ehdjet/events/insertion.hpp"
#include "ehdjet/events/landing.hpp"
#include "ehdjet/events/pump.hpp"
#include "ehdjet/events/refinement.hpp"
#include "ehdjet/forces/air_drag.hpp"
#include "ehdjet/forces/coulomb_force.hpp"
#include "ehdjet/forces/evaporation.hpp"
#include "ehdjet/forces/external_field.hpp"
#include "ehdjet/forces/feed_momentum.hpp"
#include "ehdjet/forces/gravity.hpp"
#include "ehdjet/forces/hencky_elasticity.hpp"
#include "ehdjet/forces/herschel_bulkley.hpp"
#include "ehdjet/forces/images.hpp"
#include "ehdjet/forces/mat_force.hpp"
#include "ehdjet/forces/maxwell.hpp"
#include "ehdjet/forces/near_field.hpp"
#include "ehdjet/forces/nozzle_thread.hpp"
#include "ehdjet/forces/shared_coulomb.hpp"
#include "ehdjet/forces/softened_pairs.hpp"
#include "ehdjet/forces/surface_tension.hpp"
#include "ehdjet/forces/tensor_stress.hpp"
#include "ehdjet/forces/viscous_stress.hpp"
#include "ehdjet/integrators/make_integrator.hpp"
#include "ehdjet/scene/dimensionless.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace ehdjet {
namespace {

Nozzle nozzle_of(const NozzleConfig& c) {
  return {.fluid_velocity = c.fluid_velocity(),
          .amplitude = c.amplitude,
          .angular_frequency = c.angular_frequency,
          .phase = c.phase};
}

Plate plate_of(const CollectorConfig& c) {
  Plate plate{.distance = c.distance};
  if (c.velocity) plate.velocity = Vec3(c.velocity->data());
  return plate;
}

std::optional<Varicosity> varicosity_of(const SceneConfig& c) {
  if (!c.varicosity) return std::nullopt;
  const VaricosityConfig& v = *c.varicosity;
  return Varicosity{.every = v.every,
                    .volume = v.volume ? v.factor : 1,
                    .mass = v.mass ? v.factor : 1,
                    .charge = v.charge ? v.factor : 1};
}

RefinementRule refinement_rule(const SceneConfig& c) {
  const RefinementConfig& r = *c.refinement;
  RefinementRule rule{.length = r.length,
                      .remap = r.remap,
                      .coarsen = r.coarsen,
                      .shortest = r.shortest,
                      .collector = {},
                      .has_nozzle = c.nozzle.has_value()};
  if (c.collector) rule.collector = c.collector->distance;
  return rule;
}

std::shared_ptr<const InflowRule> build_inflow(const SceneConfig& c) {
  if (!c.nozzle) return nullptr;
  const NozzleConfig& n = *c.nozzle;
  if (n.inflow == InflowKind::pump)
    return std::make_shared<PumpInflow>(
        nozzle_of(n), PumpInflow::Rule{.link_length = n.link_length,
                                       .feed = {.flow_rate = *n.flow_rate,
                                                .density = n.density,
                                                .section = n.section(),
                                                .stress = n.nozzle_stress.value_or(0)},
                                       .charge_density = n.fluid_charge_density()});
  return std::make_shared<EmbryoInflow>(
      nozzle_of(n),
      EmbryoInflow::Rule{.link_length = n.link_length,
                         .born = LinkContent::of_cylinder(
                             n.radius, n.link_length, n.density, n.fluid_charge_density()),
                         .varicosity = varicosity_of(c),
                         .release = n.insertion_velocity == InsertionVelocity::half
                                        ? ReleaseVelocity::half
                                        : ReleaseVelocity::nozzle});
}

std::unique_ptr<Event> build_refinement(const SceneConfig& c, const JetDynamics& dynamics) {
  Refinement::Totals totals;
  if (c.output.refinements != RefinementRecords::none)
    totals = [balance = std::make_shared<Balance>(
                  dynamics, std::span<const std::unique_ptr<Event>>{}),
              with_coulomb = c.output.refinements == RefinementRecords::energies](
                 const JetState& jet) { return balance->totals(jet, with_coulomb); };
  if (c.refinement->mesh == RefinedMesh::cut)
    return std::make_unique<LinkCuts>(refinement_rule(c), c.refinement->interval,
                                      std::move(totals),
                                      c.integrator.events == EventPlacement::step_end);
  return std::make_unique<Refinement>(refinement_rule(c), *c.refinement->interval,
                                      std::move(totals),
                                      c.integrator.events == EventPlacement::step_end);
}

/// l_step, or the shortest link of a given chain [m].
double shortest_link_at_start(const Scene& scene) {
  if (scene.config.nozzle) return scene.config.nozzle->link_length;
  const ConstVec3View r{scene.chain.x, scene.chain.y, scene.chain.z};
  double length = (r[1] - r[0]).norm();
  for (std::size_t k = 2; k < r.size(); ++k)
    length = std::min(length, (r[k] - r[k - 1]).norm());
  return length;
}

/// Below this no force of a link means anything; without such forces beads may pass each other.
double shortest_link(const Scene& scene) {
  const SceneConfig& c = scene.config;
  if (!c.coulomb && !carries_stress(c) && !c.surface_tension) return 0;
  constexpr double vanished = 1e-6; // of its length at birth
  return vanished * shortest_link_at_start(scene);
}

/// Links of a chain without reference lengths have no elastic stress at the start.
void rest_where_not_given(const ChainBeads& beads, JetState& jet, std::size_t reference) {
  const BeadColumn& column = jet.table->carried()[reference];
  const std::string name = csv_name(column.name, column.unit);
  const bool given = beads.others.contains(name);
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    double& length = jet.carried(reference)[k];
    if (!given) length = link_length(jet, k);
    if (!(length > 0))
      throw InputError(fmt::format(
          "chain.file: {} = {} m of bead {}: must be greater than 0 m", name, length, k));
  }
}

JetState chain_jet(const ChainBeads& beads, std::shared_ptr<const BeadTable> table) {
  JetState jet = blank_jet(std::move(table), beads.size());
  for (std::size_t c = 0; c < jet.table->integrated().size(); ++c)
    beads.copy_to(jet.table->integrated()[c], jet.columns().column(c));
  for (std::size_t c = 0; c < jet.table->carried().size(); ++c)
    beads.copy_to(jet.table->carried()[c], jet.carried(c));
  if (const auto reference = jet.table->find_carried("reference_length"))
    rest_where_not_given(beads, jet, *reference);
  return jet;
}

} // namespace

std::shared_ptr<const BeadTable> bead_table(const Scene& scene,
                                            const JetDynamics& dynamics) {
  const SceneConfig& c = scene.config;
  auto table = std::make_shared<BeadTable>();
  for (const auto& term : dynamics.terms())
    for (BeadColumn& column : term->columns()) table->declare(std::move(column));
  const double length = c.integrator.position_scale.value_or(shortest_link_at_start(scene));
  for (const char* name : {"x", "y", "z"}) table->set_error_scale(name, length);
  for (const char* name : {"vx", "vy", "vz"}) {
    table->set_error_scale(name, c.integrator.velocity_scale);
    if (c.refinement) table->set_remap(name, c.refinement->velocity);
  }
  std::vector<BeadColumn> stresses(table->integrated().begin(), table->integrated().end());
  std::erase_if(stresses, [](const BeadColumn& b) { return b.stress_of_one == 0; });
  for (const BeadColumn& stress : stresses) {
    if (c.integrator.stress_scale)
      table->set_error_scale(stress.name,
                             *c.integrator.stress_scale / stress.stress_of_one);
    if (c.refinement && c.refinement->stress)
      table->set_remap(stress.name, *c.refinement->stress);
  }
  return table;
}

ErrorScale error_scale(const Scene& scene, const BeadTable& table) {
  const IntegratorConfig& c = scene.config.integrator;
  ErrorScale scale{.rtol = c.rtol.value_or(1),
                   .column_scale = {},
                   .root_mean_square = c.norm == ErrorNorm::rms};
  for (const BeadColumn& column : table.integrated())
    scale.column_scale.push_back(column.error_scale);
  return scale;
}

JetState initial_jet(const Scene& scene, std::shared_ptr<const BeadTable> table) {
  if (const auto inflow = build_inflow(scene.config))
    return inflow->start(std::move(table));
  return chain_jet(scene.chain, std::move(table));
}

JetState initial_jet(const Scene& scene) {
  return initial_jet(scene, bead_table(scene, *build_dynamics(scene)));
}

SolverOptions solver_options(const SceneConfig& scene,
                             const std::optional<CostModel>& costs) {
  const CoulombConfig& c = *scene.coulomb;
  SolverOptions options{
      .solver = c.solver,
      .tolerance = c.tolerance,
      .norm = c.norm.value_or(scene.nozzle ? ToleranceNorm::moving : ToleranceNorm::global),
      .order = {},
      .opening = c.opening,
      .leaf = c.leaf,
      .costs = costs,
      .check_every = c.check_every};
  if (c.order) options.order = static_cast<int>(*c.order);
  return options;
}

namespace {

constexpr double default_nozzle_charge_length = 2e-4; // [m]

void add_near_field(const SceneConfig& c, JetDynamics& dynamics) {
  const NearFieldKind kind = c.coulomb->near_field == NearFieldForm::fixed
                                 ? NearFieldKind::fixed
                                 : NearFieldKind::free_surface;
  std::optional<Embryo> embryo;
  if (c.nozzle && c.nozzle->inflow == InflowKind::embryo)
    embryo = Embryo{.link_length = c.nozzle->link_length};
  dynamics.add(std::make_unique<NearField>(
      NearField::Options{.kind = kind, .softened = softens_pairs(c), .embryo = embryo}));
  if (!softens_pairs(c)) return;
  SoftenedPairs::Options softening{.kind = kind, .embryo = embryo};
  if (c.coulomb->softening_range) softening.range = *c.coulomb->softening_range;
  dynamics.add(std::make_unique<SoftenedPairs>(softening));
}

AirFlow air_flow(const Scene& scene) {
  const AirConfig& c = *scene.config.air;
  if (c.profile) return {c.density, c.kinematic_viscosity, scene.air_profile};
  const auto [x, y, z] = c.velocity.value_or(std::array{0., 0., 0.});
  return {c.density, c.kinematic_viscosity, Vec3(x, y, z)};
}

Vaporisation vaporisation_of(const EvaporationConfig& c) {
  return {.diffusivity = c.diffusivity,
          .saturation = c.saturation,
          .humidity = c.humidity,
          .solid_fraction = c.solid_fraction,
          .still_air_sherwood = c.still_air_sherwood};
}

/// The modes of a tensor law, one term each. What leaves the nozzle of a pump with a stress has been
/// stretched there, all modes alike.
template <class Law, class MakeFluid, class MakeLaw>
void add_modes(const SceneConfig& c, JetDynamics& dynamics, const MakeFluid& make_fluid,
               const MakeLaw& make_law) {
  std::vector<Law> laws;
  for (const RelaxationMode& m : c.viscoelasticity->relaxation_modes())
    laws.push_back(make_law(make_fluid(m.modulus, 1 / m.relaxation_time)));
  typename TensorStress<Law>::Options options;
  if (c.nozzle && !laws.empty())
    options.nozzle_stretch =
        stretch_of_stress<Law>(laws, c.nozzle->nozzle_stress.value_or(0));
  for (const Law& law : laws) {
    if (laws.size() > 1) ++options.mode;
    dynamics.add(std::make_unique<TensorStress<Law>>(law, options));
  }
}

/// Stress tensors of a fluid that `make_fluid` makes of G and 1/lambda.
template <class MakeFluid>
void add_tensors(const SceneConfig& c, JetDynamics& dynamics, const MakeFluid& make_fluid) {
  using Fluid = decltype(make_fluid(1.0, 1.0));
  const ViscoelasticityConfig& f = *c.viscoelasticity;
  if (f.model == Rheology::giesekus)
    add_modes<Giesekus<Fluid>>(
        c, dynamics, make_fluid, [&f](const Fluid& fluid) -> Giesekus<Fluid> {
          return {.fluid = fluid, .mobility = f.mobility.value_or(0)};
        });
  else if (f.model == Rheology::fene_p)
    add_modes<FeneP<Fluid>>(
        c, dynamics, make_fluid, [&f](const Fluid& fluid) -> FeneP<Fluid> {
          return {.fluid = fluid, .extensibility = f.extensibility.value()};
        });
  else
    add_modes<UpperConvected<Fluid>>(
        c, dynamics, make_fluid,
        [](const Fluid& fluid) -> UpperConvected<Fluid> { return {.fluid = fluid}; });
}

void add_kelvin_voigt(const SceneConfig& c, JetDynamics& dynamics) {
  const double modulus = *c.viscoelasticity->elastic_modulus;
  if (!(modulus > 0)) return;
  HenckyElasticity::Options options{.elastic_modulus = modulus};
  if (c.nozzle) {
    options.length_at_birth = c.nozzle->link_length;
    options.nozzle_stretch = std::exp(c.nozzle->nozzle_stress.value_or(0) / modulus);
  }
  dynamics.add(std::make_unique<HenckyElasticity>(options));
}

void add_rheology(const SceneConfig& c, JetDynamics& dynamics) {
  const ViscoelasticityConfig& f = *c.viscoelasticity;
  const auto uniform = [](double modulus, double relaxation) -> UniformFluid {
    return {.elastic_modulus = modulus, .relaxation = relaxation};
  };
  const auto drying = [&c](double modulus, double relaxation) {
    const EvaporationConfig& e = *c.evaporation;
    return DryingFluid(modulus, relaxation,
                       {.solution = e.solution(),
                        .exponent = e.viscosity_exponent.value_or(Thickening{}.exponent),
                        .power = e.viscosity_power.value_or(Thickening{}.power)});
  };
  switch (f.model) {
  case Rheology::maxwell:
    if (c.evaporation)
      dynamics.add(
          std::make_unique<AxialStress<MaxwellLaw<DryingFluid>>>(MaxwellLaw<DryingFluid>{
              drying(*f.elastic_modulus, *f.elastic_modulus / *f.viscosity)}));
    else
      dynamics.add(std::make_unique<Maxwell>(*f.elastic_modulus, *f.viscosity));
    break;
  case Rheology::upper_convected_maxwell:
  case Rheology::oldroyd_b:
  case Rheology::giesekus:
  case Rheology::fene_p:
    if (c.evaporation)
      add_tensors(c, dynamics, drying);
    else
      add_tensors(c, dynamics, uniform);
    break;
  case Rheology::kelvin_voigt:
    add_kelvin_voigt(c, dynamics);
    break;
  case Rheology::herschel_bulkley:
    dynamics.add(std::make_unique<HerschelBulkley>(
        *f.elastic_modulus, *f.viscosity,
        HerschelBulkleyCurve{.consistency = f.consistency.value_or(0),
                             .flow_index = f.flow_index.value_or(1),
                             .yield_stress = f.yield_stress.value_or(0),
                             .regularization = f.regularization.value_or(0)}));
    break;
  }
  if (const double eta = f.instant_viscosity(); eta > 0)
    dynamics.add(std::make_unique<ViscousStress>(eta));
}

void add_mat(const Scene& scene, JetDynamics& dynamics) {
  SolverOptions options = solver_options(scene.config, scene.costs);
  options.check_every.reset();
  const CollectorConfig& c = *scene.config.collector;
  dynamics.insulate_collector();
  dynamics.add(
      std::make_unique<MatForce>(plate_of(c), c.decay_time, make_coulomb_solver(options)));
}

void add_images(const Scene& scene, JetDynamics& dynamics) {
  SolverOptions options = solver_options(scene.config, scene.costs);
  options.check_every.reset();
  const CollectorConfig& c = *scene.config.collector;
  const Mirrors mirrors{.distance = c.distance,
                        .both_plates = c.images == CollectorImages::plates};
  dynamics.add(std::make_unique<ImageForce>(mirrors, make_coulomb_solver(options)));
  dynamics.add(std::make_unique<OwnImages>(mirrors));
}

/// `coulomb`: the Coulomb force on the beads of this jet; none if null.
std::unique_ptr<JetDynamics> compose_dynamics(const Scene& scene,
                                              std::shared_ptr<const Inflow> inflow,
                                              std::shared_ptr<ForceTerm> coulomb) {
  const SceneConfig& c = scene.config;
  auto dynamics = std::make_unique<JetDynamics>();
  dynamics->set_inflow(std::move(inflow));
  if (c.chain)
    dynamics->hold(
        {.first = c.chain->fixed == FixedEnds::first || c.chain->fixed == FixedEnds::both,
         .last = c.chain->fixed == FixedEnds::last || c.chain->fixed == FixedEnds::both});
  if (c.collector && c.collector->charge == CollectorCharge::grounded)
    dynamics->ground_collector();
  if (c.collector) dynamics->move_collector(plate_of(*c.collector).velocity);
  if (c.field)
    dynamics->add(std::make_unique<ExternalField>(
        ExternalField::Options{.strength = field_strength(c),
                               .is_switched = c.field->waveform == FieldWaveform::square,
                               .charging_time = c.field->time_constant}));
  if (c.gravity) dynamics->add(std::make_unique<Gravity>(c.gravity->acceleration));
  if (coulomb) dynamics->add(std::move(coulomb));
  if (c.collector && c.collector->charge == CollectorCharge::kept_on_mat)
    add_mat(scene, *dynamics);
  if (has_images(c)) add_images(scene, *dynamics);
  if (has_near_field(c)) add_near_field(c, *dynamics);
  if (c.nozzle && c.nozzle->inflow == InflowKind::pump) {
    dynamics->add(std::make_unique<FeedMomentum>());
    if (has_nozzle_charge(c))
      dynamics->add(std::make_unique<NozzleThread>(
          c.nozzle->fluid_charge_density() * c.nozzle->section(),
          c.nozzle->nozzle_charge_length.value_or(default_nozzle_charge_length),
          c.nozzle->radius));
  }
  if (c.surface_tension && c.surface_tension->form == SurfaceTensionForm::paper)
    dynamics->add(std::make_unique<BendingSurfaceTension>(c.surface_tension->coefficient));
  if (c.surface_tension && c.surface_tension->form == SurfaceTensionForm::line)
    dynamics->add(std::make_unique<LineSurfaceTension>(c.surface_tension->coefficient));
  if (c.air) dynamics->add(std::make_unique<AirDrag>(air_flow(scene), c.air->drag));
  if (c.air && c.air->lift) dynamics->add(std::make_unique<AirLift>(air_flow(scene)));
  if (c.evaporation)
    dynamics->add(std::make_unique<Evaporation>(air_flow(scene), c.evaporation->solution(),
                                                vaporisation_of(*c.evaporation)));
  if (carries_stress(c)) add_rheology(c, *dynamics);
  return dynamics;
}

std::unique_ptr<CoulombSolver> build_solver(const Scene& scene) {
  return make_coulomb_solver(solver_options(scene.config, scene.costs));
}

std::shared_ptr<ForceTerm> build_coulomb(const Scene& scene) {
  if (!scene.config.coulomb) return nullptr;
  return std::make_shared<CoulombForce>(build_solver(scene));
}

/// The inner beads as a simulation of their own, and the equations of motion of the others: the terms of
/// the whole jet, except that the inner beads have their own Coulomb force.
std::unique_ptr<TwoRate> build_two_rate(const Scene& scene, const JetDynamics& whole,
                                        const std::shared_ptr<const InflowRule>& inflow,
                                        const std::shared_ptr<const BeadTable>& table,
                                        StepLimits limits) {
  const SceneConfig& c = scene.config;
  const auto part = [&] {
    auto dynamics = std::make_unique<JetDynamics>();
    dynamics->set_inflow(inflow);
    if (whole.constraints().grounded_collector) dynamics->ground_collector();
    if (whole.constraints().insulating_collector) dynamics->insulate_collector();
    dynamics->move_collector(whole.constraints().plate_velocity);
    return dynamics;
  };
  TwoRate::Parts parts;
  parts.inflow = inflow;
  parts.field = std::make_shared<ExtrapolatedField>();
  parts.projected = std::make_shared<ProjectedField>();
  parts.predictor = std::make_shared<Predictor>();
  parts.record = std::make_shared<InnerRecord>(inflow);
  auto inner = part();
  parts.downstream = part();
  for (const auto& term : whole.terms()) {
    parts.downstream->add(term);
    // The inner beads feel the mat with all that is distant.
    if (dynamic_cast<const CoulombForce*>(term.get()) == nullptr
        && dynamic_cast<const MatForce*>(term.get()) == nullptr)
      inner->add(term);
  }
  inner->add(std::make_unique<CoulombForce>(make_coulomb_solver({.solver = "direct"})));
  inner->add(parts.field);
  parts.downstream->add(parts.projected);

  ErrorScale scale = error_scale(scene, *table);
  limits.even_at_end = true;
  parts.inner_dynamics = inner.get();
  parts.inner =
      std::make_unique<Simulation>(initial_jet(scene, table), std::move(inner),
                                   make_integrator(c.integrator.method, scale), limits);
  for (auto& event : inflow->events()) parts.inner->add(std::move(event));
  scale.rtol = c.integrator.downstream_rtol.value_or(scale.rtol);
  parts.integrator = make_integrator(c.integrator.method, scale);
  parts.scale = scale;
  parts.inward = make_coulomb_solver({.solver = "direct"});
  parts.outward = make_coulomb_solver({.solver = "direct"});

  constexpr std::size_t default_inner_beads = 24, possible = 64, worth_it = 200;
  TwoRate::Options options{
      .inner_beads = c.integrator.inner_beads.value_or(default_inner_beads),
      .rtol = std::min(*c.integrator.rtol, scale.rtol),
      .adapts = !c.integrator.inner_beads,
      .fewest_beads = c.integrator.method == "auto" ? worth_it : possible};
  if (c.collector) options.collector = c.collector->distance;
  if (c.collector) options.decay_time = c.collector->decay_time;
  return std::make_unique<TwoRate>(std::move(parts), options);
}

} // namespace

std::unique_ptr<JetDynamics> build_dynamics(const Scene& scene) {
  return compose_dynamics(scene, build_inflow(scene.config), build_coulomb(scene));
}

namespace {

StepLimits step_limits(const Scene& scene) {
  const IntegratorConfig& i = scene.config.integrator;
  return {.fixed = i.step,
          .initial = i.initial_step,
          .longest = i.max_step.value_or(StepLimits{}.longest),
          .shortest = i.min_step,
          .shortest_link = shortest_link(scene)};
}

/// What happens to a jet, in the order in which events at the same instant are applied (model 5).
/// `jets`: how many of them take common steps.
std::vector<std::unique_ptr<Event>> build_events(const SceneConfig& c,
                                                 const InflowRule* inflow,
                                                 const JetDynamics& dynamics,
                                                 std::size_t jets) {
  std::vector<std::unique_ptr<Event>> events;
  const bool first_is_free =
      c.chain && c.chain->fixed != FixedEnds::first && c.chain->fixed != FixedEnds::both;
  // With fixed steps, for studies of convergence, every landing ends a step.
  const bool may_pass = c.integrator.rtol.has_value()
                        && c.integrator.events == EventPlacement::located
                        && c.integrator.landings == LandingSteps::automatic;
  if (c.collector)
    events.push_back(std::make_unique<Landing>(
        plate_of(*c.collector),
        Landing::Options{.first_bead = first_is_free ? std::size_t{0} : std::size_t{1},
                         .may_pass = may_pass,
                         .charges_mat = c.collector->charge == CollectorCharge::kept_on_mat,
                         .decay_time = c.collector->decay_time,
                         .jets = jets}));
  if (inflow != nullptr)
    for (auto& event : inflow->events()) events.push_back(std::move(event));
  if (c.field && c.field->frequency)
    events.push_back(std::make_unique<FieldSwitch>(*c.field->frequency));
  if (c.refinement) events.push_back(build_refinement(c, dynamics));
  return events;
}

} // namespace

std::unique_ptr<Simulation> build_simulation(const Scene& scene, Extras extras) {
  const SceneConfig& c = scene.config;
  if (c.array)
    throw InputError("a scene with [array] is no single jet: build_array_simulation");
  const std::shared_ptr<const InflowRule> inflow = build_inflow(c);
  auto dynamics = compose_dynamics(scene, inflow, build_coulomb(scene));
  for (auto& force : extras.forces) dynamics->add(std::move(force));
  const auto table = bead_table(scene, *dynamics);
  auto integrator = make_integrator(c.integrator.method, error_scale(scene, *table));
  const StepLimits limits = step_limits(scene);
  if (c.integrator.method == "two-rate" && !extras.forces.empty())
    throw InputError(
        "integrator.method = \"two-rate\" cannot be used with force terms that a "
        "program adds: they may couple beads that are far apart. Take \"auto\"");
  std::unique_ptr<TwoRate> two_rate;
  if (can_have_two_rates(c) && extras.forces.empty())
    two_rate = build_two_rate(scene, *dynamics, inflow, table, limits);
  auto simulation = std::make_unique<Simulation>(
      initial_jet(scene, table), std::move(dynamics), std::move(integrator), limits);
  if (two_rate) simulation->use_two_rates(std::move(two_rate));
  if (c.integrator.events == EventPlacement::step_end)
    simulation->snap_events_to_step_ends();

  for (auto& event : build_events(c, inflow.get(), simulation->dynamics(), 1))
    simulation->add(std::move(event));
  for (auto& event : extras.events) simulation->add(std::move(event));
  for (auto& observer : extras.observers) simulation->add(std::move(observer));
  return simulation;
}

std::unique_ptr<ArraySimulation> build_array_simulation(const Scene& scene) {
  EHDJET_EXPECTS(scene.config.array && scene.config.nozzle && scene.config.coulomb);
  const ArrayConfig& array = *scene.config.array;
  auto dynamics = std::make_unique<ArrayDynamics>(build_solver(scene));
  std::vector<ArraySimulation::Member> members;
  std::shared_ptr<const BeadTable> table;
  for (std::size_t j = 0; j < array.jets(); ++j) {
    SceneConfig c = scene.config;
    c.nozzle->phase += array.phase(j);
    const std::shared_ptr<const InflowRule> inflow = build_inflow(c);
    const auto coulomb = std::make_shared<SharedCoulomb>();
    auto jet = compose_dynamics(scene, inflow, coulomb);
    if (!table) table = bead_table(scene, *jet);
    members.push_back({.jet = inflow->start(table),
                       .events = build_events(c, inflow.get(), *jet, array.jets())});
    dynamics->add(std::move(jet), coulomb, array.axis(j));
  }
  const IntegratorConfig& i = scene.config.integrator;
  auto simulation = std::make_unique<ArraySimulation>(
      std::move(members), std::move(dynamics),
      make_integrator(i.method, error_scale(scene, *table)), step_limits(scene));
  if (i.events == EventPlacement::step_end) simulation->snap_events_to_step_ends();
  return simulation;
}

} // namespace ehdjet
