#pragma once

#include "ehdjet/scene/config.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

/// Every table and key of a scene file, described once: name, allowed values with unit,
/// default, meaning. Reading, printing and documenting are visitors of this description.
///
/// A visitor has three members:
///
///     required(name, value, allowed, meaning)            the scene must give this key
///     optional(name, value, allowed, meaning, otherwise) default: the value as constructed;
///                                                        for a std::optional: `otherwise`
///     table(name, config, meaning)                       calls describe(*this, config); a
///                                                        std::optional table may be absent
///
/// A new key is one member in config.hpp and one line here.
namespace ehdjet {

/// Numbers a key accepts, in its unit. Upper ends are far beyond any jet: they are there to
/// catch a value in centimetres, grams or statcoulombs.
struct Range {
  std::string_view unit; ///< "-" for a pure number
  double lowest = 0, highest = 0;
  bool open = false; ///< `lowest` itself is not allowed

  [[nodiscard]] bool contains(double value) const; ///< false for NaN
  [[nodiscard]] std::string text() const;          ///< "greater than 0 and at most 0.01 m"
};
constexpr Range positive(std::string_view unit, double highest) {
  return {unit, 0, highest, true};
}
constexpr Range non_negative(std::string_view unit, double highest) {
  return {unit, 0, highest};
}
constexpr Range between(std::string_view unit, double lowest, double highest) {
  return {unit, lowest, highest};
}

template <class Enum>
struct Named {
  std::string_view name;
  Enum value;
};
/// Strings that stand for the values of an enumeration.
template <class Enum, std::size_t N>
using Choices = std::array<Named<Enum>, N>;

/// Strings that are kept as strings.
struct Words {
  std::vector<std::string_view> names;
};
/// Three numbers in square brackets, each in the range.
struct Triple {
  Range each;
};
/// Pairs of a modulus and a relaxation time.
struct ModeList {
  Range modulus, relaxation_time;
  std::size_t most = 0;
};
struct AnyText {};
struct YesNo {};

inline constexpr Choices<FixedEnds, 4> fixed_ends{{{"none", FixedEnds::none},
                                                   {"first", FixedEnds::first},
                                                   {"last", FixedEnds::last},
                                                   {"both", FixedEnds::both}}};
inline constexpr Choices<InsertionVelocity, 2> insertion_velocities{
    {{"half", InsertionVelocity::half}, {"nozzle", InsertionVelocity::nozzle}}};
inline constexpr Choices<SurfaceTensionForm, 2> surface_tension_forms{
    {{"paper", SurfaceTensionForm::paper}, {"line", SurfaceTensionForm::line}}};
inline constexpr Choices<InflowKind, 2> inflow_kinds{
    {{"embryo", InflowKind::embryo}, {"pump", InflowKind::pump}}};
inline constexpr Choices<ArrayPhases, 2> array_phases{
    {{"equal", ArrayPhases::equal}, {"spread", ArrayPhases::spread}}};
inline constexpr Choices<CollectorCharge, 3> collector_charges{
    {{"grounded", CollectorCharge::grounded},
     {"kept", CollectorCharge::kept},
     {"kept-on-mat", CollectorCharge::kept_on_mat}}};
inline constexpr Choices<CollectorImages, 3> collector_images{
    {{"none", CollectorImages::none},
     {"collector", CollectorImages::collector},
     {"plates", CollectorImages::plates}}};
inline constexpr Choices<FieldWaveform, 3> field_waveforms{
    {{"constant", FieldWaveform::constant},
     {"square", FieldWaveform::square},
     {"rc", FieldWaveform::rc}}};
inline constexpr Choices<NearFieldForm, 3> near_field_forms{
    {{"point", NearFieldForm::point},
     {"free-surface", NearFieldForm::free_surface},
     {"fixed", NearFieldForm::fixed}}};
inline constexpr Choices<DragLaw, 2> drag_laws{
    {{"anisotropic", DragLaw::anisotropic}, {"tangential", DragLaw::tangential}}};
inline constexpr Choices<RefinedMesh, 2> refined_meshes{
    {{"redistribute", RefinedMesh::redistribute}, {"cut", RefinedMesh::cut}}};
inline constexpr Choices<EventPlacement, 2> event_placements{
    {{"located", EventPlacement::located}, {"step-end", EventPlacement::step_end}}};
inline constexpr Choices<ToleranceNorm, 3> tolerance_norms{
    {{"moving", ToleranceNorm::moving},
     {"global", ToleranceNorm::global},
     {"per-bead", ToleranceNorm::per_bead}}};
inline constexpr Choices<LandingSteps, 2> landing_steps{
    {{"auto", LandingSteps::automatic}, {"located", LandingSteps::located}}};
inline constexpr Choices<ErrorNorm, 2> error_norms{
    {{"max", ErrorNorm::max}, {"rms", ErrorNorm::rms}}};

inline constexpr Choices<LinkRemap, 2> refinement_remaps{
    {{"conservative", LinkRemap::conservative}, {"paper", LinkRemap::paper}}};
inline constexpr Choices<ColumnRemap, 2> column_remaps{
    {{"spline", ColumnRemap::spline}, {"conservative", ColumnRemap::conservative}}};
inline constexpr Choices<Rheology, 7> rheologies{
    {{"maxwell", Rheology::maxwell},
     {"upper-convected-maxwell", Rheology::upper_convected_maxwell},
     {"oldroyd-b", Rheology::oldroyd_b},
     {"giesekus", Rheology::giesekus},
     {"fene-p", Rheology::fene_p},
     {"kelvin-voigt", Rheology::kelvin_voigt},
     {"herschel-bulkley", Rheology::herschel_bulkley}}};
inline constexpr Choices<RefinementRecords, 3> refinement_records{
    {{"none", RefinementRecords::none},
     {"sums", RefinementRecords::sums},
     {"energies", RefinementRecords::energies}}};

template <class Enum, std::size_t N>
std::string_view name_of(Enum value, const Choices<Enum, N>& choices) {
  for (const auto& c : choices)
    if (c.value == value) return c.name;
  return {};
}

[[nodiscard]] Words integration_method_names();
[[nodiscard]] Words coulomb_solver_names();

/// What an allowed-values object says of itself, for messages and the reference page.
[[nodiscard]] std::string allowed_text(const Range& range); ///< with unit
[[nodiscard]] std::string allowed_text(const Words& words); ///< "a" or "b"
[[nodiscard]] std::string allowed_text(const Triple& triple);
[[nodiscard]] std::string allowed_text(const ModeList& modes);
[[nodiscard]] std::string allowed_text(AnyText);
[[nodiscard]] std::string allowed_text(YesNo);
template <class Enum, std::size_t N>
std::string allowed_text(const Choices<Enum, N>& choices) {
  Words words;
  for (const auto& c : choices) words.names.push_back(c.name);
  return allowed_text(words);
}

/// The unit of what is allowed: "m", "-", "Pa, s" for pairs; empty for all that is no number.
[[nodiscard]] std::string unit_text(const Range& range);
[[nodiscard]] std::string unit_text(const Triple& triple);
[[nodiscard]] std::string unit_text(const ModeList& modes);
[[nodiscard]] std::string unit_text(const auto&) {
  return "";
}

/// A value as TOML reads it back: shortest digits that give the same bits, quoted strings.
[[nodiscard]] std::string toml_text(double value);
[[nodiscard]] std::string toml_text(std::string_view value);
[[nodiscard]] std::string toml_text(const std::vector<RelaxationMode>& modes);

inline constexpr double longest_time = 1e6; // [s]
inline constexpr Range elastic_moduli = non_negative("Pa", 1e12);
inline constexpr Range viscosities = non_negative("Pa s", 1e6);

template <class V>
void describe(V& v, RunConfig& c) {
  v.required("end_time", c.end_time, positive("s", longest_time), "simulated time");
  v.optional("threads", c.threads, between("-", 1, 4096), "number of threads",
             "all processors");
  v.optional("max_wall_time", c.max_wall_time, positive("s", 1e8),
             "the run stops after so much time of the clock, as it does on a signal",
             "none");
}

template <class V>
void describe(V& v, NozzleConfig& c) {
  v.required("radius", c.radius, positive("m", 2e-3), "jet radius at the nozzle, a0");
  v.required(
      "link_length", c.link_length, positive("m", 1e-2),
      "length of a link when it leaves the nozzle, l_step; at least the radius, unless "
      "pairs are softened");
  v.optional("velocity", c.velocity, non_negative("m/s", 1e3),
             "fluid velocity at the nozzle, v_s",
             "required; with a pump flow_rate is given");
  v.required("density", c.density, between("kg/m^3", 1, 1e5), "density of the fluid, rho");
  v.optional("charge_density", c.charge_density, between("C/m^3", -1e4, 1e4),
             "charge per volume of the fluid, rho_q",
             "required; with a pump `current` may be given instead");
  v.optional("amplitude", c.amplitude, non_negative("m", 1e-2),
             "radius of the circle on which the nozzle moves, A");
  v.optional("angular_frequency", c.angular_frequency, between("rad/s", -1e9, 1e9),
             "angular frequency of the nozzle, omega");
  v.optional("phase", c.phase, between("rad", -100, 100),
             "angle of the nozzle at t = 0, from +y towards +z");
  v.optional(
      "insertion_velocity", c.insertion_velocity, insertion_velocities,
      "velocity of a released bead: half-way to that of the bead downstream, or that of "
      "the nozzle");
  v.optional("inflow", c.inflow, inflow_kinds,
             "how fluid enters: beads are born as fast as the forces pull them out (the "
             "paper), or a pump feeds the first link at a given rate");
  v.optional("flow_rate", c.flow_rate, positive("m^3/s", 1e-3),
             "volume that the pump feeds per second, Q; 1 mL/h = 2.7778e-10 m^3/s",
             "required with a pump");
  v.optional("current", c.current, between("A", -1, 1),
             "charge that the pump feeds per second, I = charge_density Q",
             "charge_density is given");
  v.optional("nozzle_stress", c.nozzle_stress, between("Pa", -1e9, 1e9),
             "stress with which the fluid leaves a pump's nozzle", "0 with a pump");
  v.optional("nozzle_charge_length", c.nozzle_charge_length, positive("m", 1),
             "length of the charged fluid in a pump's nozzle that acts on the jet",
             "0.0002 with a pump");
  v.optional("conductivity", c.conductivity, positive("S/m", 1e7),
             "conductivity of a pumped fluid; `ehdjet check` says how thick a jet is where "
             "conduction ends. A run does not use it",
             "`ehdjet check` says nothing about it");
}

template <class V>
void describe(V& v, ArrayConfig& c) {
  v.required("rows", c.rows, between("-", 1, 1000), "number of nozzles along z");
  v.required("columns", c.columns, between("-", 1, 1000), "number of nozzles along y");
  v.required("spacing", c.spacing, positive("m", 10),
             "distance between neighbouring nozzles");
  v.optional(
      "phases", c.phases, array_phases,
      "the nozzles move alike, or with phases that are spread over a turn, jet after "
      "jet");
}

template <class V>
void describe(V& v, ChainConfig& c) {
  v.required("file", c.file, AnyText{},
             "beads: CSV, or HDF5 written by a run; relative to the scene file");
  v.optional("time", c.time, non_negative("s", longest_time),
             "take the frame nearest to this time (HDF5 only)", "the last frame");
  v.optional("fixed", c.fixed, fixed_ends, "ends of the chain that do not move");
}

template <class V>
void describe(V& v, CollectorConfig& c) {
  v.required("distance", c.distance, positive("m", 10),
             "distance from the nozzle, h; more than two link lengths");
  v.optional("charge", c.charge, collector_charges,
             "the charge of a bead that rests on the grounded collector acts on no other "
             "bead, it is kept until the bead leaves (the paper), or it stays on the "
             "insulating collector and acts from there");
  v.optional(
      "images", c.images, collector_images,
      "charges have images in the grounded collector, or in it and in the plate of a "
      "pump's nozzle");
  v.optional("decay_time", c.decay_time, positive("s", longest_time),
             "charges on an insulating collector decay as exp(-t/decay_time)",
             "they do not");
  v.optional("velocity", c.velocity, Triple{between("m/s", -1e3, 1e3)},
             "velocity of the collector in its plane, [0, vy, vz]; the deposit is then in "
             "coordinates that move with it",
             "it is at rest");
}

template <class V>
void describe(V& v, FieldConfig& c) {
  v.optional("potential", c.potential, between("V", -1e8, 1e8),
             "voltage between nozzle and collector, Phi0: the field is Phi0/h",
             "`strength` is given");
  v.optional("strength", c.strength, between("V/m", -1e8, 1e8), "field along +x, E",
             "`potential` is given");
  v.optional(
      "waveform", c.waveform, field_waveforms,
      "the field is constant, is switched on and off and on for sin(2 pi frequency t) > "
      "0, or rises as 1 - exp(-t/time_constant), as if an RC circuit charged the nozzle");
  v.optional("frequency", c.frequency, positive("1/s", 1e9), "of the square wave, f",
             "required with waveform = \"square\"");
  v.optional("time_constant", c.time_constant, positive("s", longest_time),
             "of the RC circuit, tau", "required with waveform = \"rc\"");
}

template <class V>
void describe(V& v, GravityConfig& c) {
  v.required("acceleration", c.acceleration, between("m/s^2", -100, 100),
             "gravity along +x, g; on Earth 9.80665");
}

template <class V>
void describe(V& v, CoulombConfig& c) {
  v.optional("solver", c.solver, coulomb_solver_names(),
             "how the mutual forces are summed");
  v.optional("tolerance", c.tolerance, between("-", 1e-13, 0.1),
             "largest relative error of the force, in the norm; the direct sum is exact");
  v.optional(
      "norm", c.norm, tolerance_norms,
      "what the error is relative to: for the beads that move their root mean square net "
      "force without the strongest tenth, for all beads |F|, or for each bead the sum of "
      "the magnitudes that act on it",
      "moving with a nozzle, global for a chain");
  v.optional(
      "near_field", c.near_field, near_field_forms,
      "charges act as points at the beads (the paper), or what they leave out of the "
      "field of a thread is added along each link: for a liquid thread, or for one "
      "whose radius is fixed");
  v.optional(
      "softened_pairs", c.softened_pairs, YesNo{},
      "charges closer than their radii repel less than points; for links that are not "
      "long against their radius",
      "with a near field, if the first links are shorter than 4 nozzle.radius");
  v.optional("softening_range", c.softening_range, between("-", 5, 1000),
             "distance up to which pairs are softened, in radii",
             "40 if pairs are softened");
  v.optional("order", c.order, between("-", 2, 22), "order of the expansions, for studies",
             "follows from the tolerance");
  v.optional("opening", c.opening, positive("-", 0.99),
             "largest radius over distance at which a cluster acts as one, for studies",
             "0.75, or less if the tolerance needs it");
  v.optional("leaf", c.leaf, between("-", 8, 4096),
             "beads per leaf of the cluster tree, a multiple of 8, for studies",
             "follows from the tolerance");
  v.optional("check_every", c.check_every, between("-", 1, 1e12),
             "evaluations between comparisons with the direct sum on sampled beads",
             "there are no comparisons");
  v.optional(
      "calibration", c.calibration, AnyText{},
      "file of costs by which \"auto\" chooses, written by `ehdjet calibrate`; relative to "
      "the scene file",
      "those that come with the program");
}

template <class V>
void describe(V& v, ViscoelasticityConfig& c) {
  v.optional("model", c.model, rheologies,
             "law of the stress: one axial stress (the paper), a stress tensor, an elastic "
             "body with a dashpot, or a flow curve with a yield stress");
  v.optional("elastic_modulus", c.elastic_modulus, elastic_moduli,
             "elastic modulus, G; with 0 a Maxwell fluid has no stress",
             "required unless modes are given");
  v.optional("viscosity", c.viscosity, viscosities,
             "viscosity, mu; mu/G is the relaxation time; with 0 a Maxwell fluid has no "
             "stress",
             "required unless modes are given");
  v.optional("modes", c.modes,
             ModeList{positive("Pa", 1e12), positive("s", longest_time), 16},
             "moduli and relaxation times of a tensor law whose stresses add up",
             "elastic_modulus and viscosity are the only one");
  v.optional("mobility", c.mobility, between("-", 0, 1),
             "how much faster high stress relaxes, alpha_G", "required with giesekus");
  v.optional("solvent_viscosity", c.solvent_viscosity, non_negative("Pa s", 1e6),
             "viscosity of the solvent, mu_s, which adds 3 mu_s e to the stress",
             "required with oldroyd-b, 0 with giesekus and fene-p");
  v.optional("extensibility", c.extensibility, Range{"-", 3, 1e9, true},
             "largest square of the stretch of the polymer, L2", "required with fene-p");
  v.optional("consistency", c.consistency, non_negative("Pa s^n", 1e9),
             "K of the flow curve tau_Y (1 - exp(-m |e|)) + K |e|^n",
             "required with herschel-bulkley");
  v.optional("flow_index", c.flow_index, positive("-", 3), "n of the flow curve",
             "required with herschel-bulkley");
  v.optional("yield_stress", c.yield_stress, non_negative("Pa", 1e9),
             "tau_Y of the flow curve", "0 with herschel-bulkley");
  v.optional("regularization", c.regularization, positive("s", longest_time),
             "m of the flow curve: below 1/m the fluid creeps",
             "required with a yield_stress");
}

template <class V>
void describe(V& v, SurfaceTensionConfig& c) {
  v.required("coefficient", c.coefficient, non_negative("N/m", 5),
             "surface tension, alpha");
  v.optional("form", c.form, surface_tension_forms,
             "force law: the paper's curvature force on beads, or a tension pi a alpha "
             "along links");
}

template <class V>
void describe(V& v, AirConfig& c) {
  v.optional("density", c.density, positive("kg/m^3", 100), "density of the air");
  v.optional("kinematic_viscosity", c.kinematic_viscosity, positive("m^2/s", 1),
             "kinematic viscosity of the air; 1.511e-05 at 20 C");
  v.optional("velocity", c.velocity, Triple{between("m/s", -100, 100)},
             "velocity of the air along x, y and z; a negative x is a counterflow",
             "the air is still");
  v.optional("profile", c.profile, AnyText{},
             "velocity of the air over x: CSV with the columns x_m, ux_m_s, uy_m_s and "
             "uz_m_s, relative to the scene file; excludes `velocity`",
             "it is the same everywhere");
  v.optional("drag", c.drag, drag_laws,
             "drag across and along each link, or along it only, as JETSPIN has it");
  v.optional("lift", c.lift, YesNo{},
             "a curved thread that moves along itself is pushed outwards");
}

template <class V>
void describe(V& v, EvaporationConfig& c) {
  v.required("solvent_density", c.solvent_density, between("kg/m^3", 100, 1e4),
             "density of the solvent, rho_s");
  v.required("polymer_density", c.polymer_density, between("kg/m^3", 100, 1e4),
             "density of the polymer, rho_p");
  v.required("polymer_fraction", c.polymer_fraction, between("-", 1e-9, 0.99),
             "mass of the polymer over that of the fluid at the nozzle, c_0");
  v.required("diffusivity", c.diffusivity, positive("m^2/s", 1e-2),
             "diffusion coefficient of the vapour in air, D");
  v.required("saturation", c.saturation, positive("kg/m^3", 10),
             "mass of the vapour in a volume of saturated air, C_sat");
  v.optional("humidity", c.humidity, between("-", 0, 1),
             "vapour in the air over that of saturated air, phi");
  v.optional("solid_fraction", c.solid_fraction, between("-", 1e-3, 1),
             "polymer fraction at which evaporation ends; more than polymer_fraction");
  v.optional("still_air_sherwood", c.still_air_sherwood, non_negative("-", 10),
             "Sherwood number of a jet that moves with the air");
  v.optional(
      "viscosity_exponent", c.viscosity_exponent, between("-", 0, 50),
      "B of the viscosity mu_0 10^(B (c^m - c_0^m)); the relaxation time grows like c",
      "7 with [viscoelasticity]");
  v.optional("viscosity_power", c.viscosity_power, positive("-", 10), "m of the viscosity",
             "0.1 with [viscoelasticity]");
}

template <class V>
void describe(V& v, VaricosityConfig& c) {
  v.required("every", c.every, between("-", 1, 1e9),
             "k: every k-th inserted bead differs from the others");
  v.required("factor", c.factor, positive("-", 1e3),
             "factor f for the quantities that are true below");
  v.optional("mass", c.mass, YesNo{}, "the mass of such a bead is multiplied");
  v.optional("volume", c.volume, YesNo{}, "so is its volume; if false, the bead is denser");
  v.optional("charge", c.charge, YesNo{}, "so is its charge");
}

template <class V>
void describe(V& v, RefinementConfig& c) {
  v.required("length", c.length, positive("m", 1), "links longer than this are cut, L~");
  v.optional("interval", c.interval, positive("s", longest_time),
             "time between refinements, which happen at its multiples, t_ref; required to "
             "redistribute links",
             "links are cut at the end of the step in which they become too long");
  v.optional("mesh", c.mesh, refined_meshes,
             "links from the first long one on are redistributed (the paper), or each long "
             "link is cut and all others stay as they are");
  v.optional(
      "remap", c.remap, refinement_remaps,
      "how volume, mass and charge reach the new links: by overlap along the arc length, "
      "which keeps every sum and bump, or as in the paper, from a spline of the radius");
  v.optional("velocity", c.velocity, column_remaps,
             "Akima spline, or average that keeps the momentum");
  v.optional("stress", c.stress, column_remaps,
             "Akima spline, or average that keeps the sum of volume times stress",
             "spline; conservative for stress tensors");
  v.optional("coarsen", c.coarsen, positive("m", 1),
             "join neighbouring links that are together no longer than this",
             "links are never joined");
  v.optional(
      "shortest", c.shortest, positive("-", 100),
      "join a link shorter than so many of its radii with a neighbour: a drop, as at the "
      "end of a jet that capillarity pulls back",
      "links are never joined for that");
}

template <class V>
void describe(V& v, IntegratorConfig& c) {
  v.optional(
      "method", c.method, integration_method_names(),
      "explicit Runge-Kutta method, the linearly implicit ros34pw2 for stiff fluids, or "
      "\"auto\": dormand-prince, and ros34pw2 while stability would limit its steps; with "
      "two rates once a jet from a nozzle has 200 beads. \"two-rate\" does so from 64 on");
  v.optional("rtol", c.rtol, between("-", 1e-14, 0.1),
             "relative tolerance of the adaptive step; excludes `step`",
             "1e-06 unless `step` is given");
  v.optional("step", c.step, positive("s", longest_time),
             "fixed time step; excludes `rtol`", "`rtol` is given");
  v.optional("initial_step", c.initial_step, positive("s", longest_time),
             "first step to try (adaptive only)", "estimated");
  v.optional("max_step", c.max_step, positive("s", longest_time),
             "longest step (adaptive only)", "no limit");
  v.optional("min_step", c.min_step, positive("s", 1),
             "the run stops if a step would be shorter than this");
  v.optional("position_scale", c.position_scale, positive("m", 1e3),
             "the error of a position x is measured against rtol (position_scale + |x|)",
             "link_length (chain: shortest link)");
  v.optional("velocity_scale", c.velocity_scale, positive("m/s", 1e6),
             "the same for velocities");
  v.optional("stress_scale", c.stress_scale, positive("Pa", 1e12), "the same for stresses",
             "0.1 elastic_modulus, of each mode its own");
  v.optional("norm", c.norm, error_norms, "norm over all components of the scaled error");
  v.optional("events", c.events, event_placements,
             "insertion and landing happen at their instants inside a step, or at its end");
  v.optional(
      "landings", c.landings, landing_steps,
      "adaptive steps end at every landing, or only while landings are rare; their times "
      "are located in both cases");
  v.optional("inner_beads", c.inner_beads, between("-", 8, 1e5),
             "two rates: how many beads at the nozzle take short steps",
             "24, and more if they turn out to be too few");
  v.optional("downstream_rtol", c.downstream_rtol, between("-", 1e-14, 0.1),
             "two rates: relative tolerance of the long steps of all other beads", "rtol");
}

template <class V>
void describe(V& v, OutputConfig& c) {
  v.optional("observables", c.observables, positive("s", longest_time),
             "time between rows of observables", "none are written");
  v.optional("frames", c.frames, positive("s", longest_time),
             "time between frames of all beads", "none are written");
  v.optional("deposit", c.deposit, YesNo{},
             "record every bead that leaves at the collector");
  v.optional("refinements", c.refinements, refinement_records,
             "record for each refinement the change of all sums, or also that of the "
             "energy of all "
             "pairs of charges, which costs as much as two force evaluations");
  v.optional("budget", c.budget, positive("s", longest_time),
             "time between rows of energy, momentum and their residual",
             "none are written");
  v.optional("resolving_power", c.resolving_power, positive("s", longest_time),
             "time between samples of the resolving power link_length/l along the jet",
             "none are taken");
  v.optional(
      "checkpoints", c.checkpoints, positive("s", longest_time),
      "simulated time between checkpoints, from the last of which `ehdjet run --resume` or "
      "`--continue` goes on with the same bits",
      "none are made");
  v.optional("checkpoint_wall_time", c.checkpoint_wall_time, non_negative("s", 1e7),
             "wall time between checkpoints; 0: none are made by this clock");
  v.optional("flush", c.flush, positive("s", 3600),
             "longest wall time between flushes to disk");
}

template <class V>
void describe(V& v, SceneConfig& c) {
  v.optional("title", c.title, AnyText{}, "one line that describes the scene");
  v.table("run", c.run, "What is simulated.");
  v.table(
      "nozzle", c.nozzle,
      "The jet is born at a nozzle at the origin. Exactly one of [nozzle] and [chain].");
  v.table("array", c.array,
          "Several jets from equal nozzles on a grid around the axis, which repel each "
          "other. Needs [nozzle] and [coulomb].");
  v.table("chain", c.chain,
          "The jet is a given chain of beads; none is inserted. Excludes [nozzle].");
  v.table("collector", c.collector,
          "Plane x = distance, where beads land; it conducts unless its charge is kept on "
          "a mat.");
  v.table("field", c.field, "Uniform electric field along +x, by exactly one of its keys.");
  v.table("gravity", c.gravity, "Gravity.");
  v.table("coulomb", c.coulomb,
          "Mutual Coulomb force of all beads, the nozzle's included.");
  v.table("viscoelasticity", c.viscoelasticity, "The stress of the fluid: its rheology.");
  v.table("surface_tension", c.surface_tension, "Surface tension.");
  v.table("air", c.air, "Drag of the air on the jet.");
  v.table("evaporation", c.evaporation,
          "The solvent evaporates into the air. Needs [air].");
  v.table("varicosity", c.varicosity,
          "Every k-th bead that is born differs from the others.");
  v.table("refinement", c.refinement,
          "Links that have become too long are cut (dynamic mesh refinement).");
  v.table("integrator", c.integrator,
          "Integration in time, adaptive (`rtol`) or with fixed steps (`step`).");
  v.table("output", c.output, "What is written.");
}

} // namespace ehdjet
