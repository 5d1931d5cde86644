#pragma once

#include "ehdjet/coulomb/make_solver.hpp"
#include "ehdjet/forces/air_drag.hpp"
#include "ehdjet/forces/evaporation.hpp"
#include "ehdjet/forces/fluid.hpp"
#include "ehdjet/jet/jet_axis.hpp"
#include "ehdjet/refinement/refine_jet.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// A scene as plain data, SI units. An absent optional is a feature that does not exist in
/// the run: no object, no state column, no branch, no output column.
///
/// Units, ranges, defaults and meaning of every member stand in one place, the schema
/// (scene/schema.hpp), which also reads, prints and documents them. Symbols are those of the
/// model (src/MODEL.md, cited as "model N").
namespace ehdjet {

/// Ways a bead chain can be held at its ends (chain scenes only).
enum class FixedEnds { none, first, last, both };
/// Velocity that a released bead starts with (model 4.2).
enum class InsertionVelocity { half, nozzle };
/// Force law of the surface tension (model 2).
enum class SurfaceTensionForm { paper, line };
/// Where events are applied: at their root inside a step, or at the end of the step.
enum class EventPlacement { located, step_end };
/// Whether steps go on through landings while those are frequent (model 5).
enum class LandingSteps { automatic, located };
/// In which plates charges have images (model 3.2).
enum class CollectorImages { none, collector, plates };
/// How the external field changes in time (model 2.6).
enum class FieldWaveform { constant, square, rc };
/// How fluid enters a jet at its nozzle (model 4).
enum class InflowKind { embryo, pump };
/// What the charge of a bead does once it rests on the collector (model 5).
enum class CollectorCharge { grounded, kept, kept_on_mat };
/// How the nozzles of an array move: all alike, or with phases spread over a turn (model 9).
enum class ArrayPhases { equal, spread };
/// What is added to the forces between the beads so that they act like a thread (model 3.1).
enum class NearFieldForm { point, free_surface, fixed };
/// How links that have become too long are refined (model 7).
enum class RefinedMesh { redistribute, cut };
/// Laws of the stress in the fluid (model 2, 2.3 to 2.5).
enum class Rheology {
  maxwell,
  upper_convected_maxwell,
  oldroyd_b,
  giesekus,
  fene_p,
  kelvin_voigt,
  herschel_bulkley
};
/// What is recorded of each refinement.
enum class RefinementRecords { none, sums, energies };
/// Norm over the components of the scaled error estimate.
enum class ErrorNorm { max, rms };

/// The jet is born at a nozzle (model 2 and 4). Excludes `ChainConfig`.
struct NozzleConfig {
  double radius = 0;                         ///< a0 [m]
  double link_length = 0;                    ///< l_step [m]
  std::optional<double> velocity = {};       ///< v_s [m/s]
  double density = 0;                        ///< rho [kg/m^3]
  std::optional<double> charge_density = {}; ///< rho_q [C/m^3]
  double amplitude = 0;                      ///< A [m]
  double angular_frequency = 0;              ///< omega [rad/s]
  double phase = 0;                          ///< [rad]
  InsertionVelocity insertion_velocity = InsertionVelocity::half;
  InflowKind inflow = InflowKind::embryo;
  // Of a pump (model 4.3).
  std::optional<double> flow_rate = {};            ///< Q [m^3/s]
  std::optional<double> current = {};              ///< I = rho_q Q [A]
  std::optional<double> nozzle_stress = {};        ///< sigma_in [Pa]
  std::optional<double> nozzle_charge_length = {}; ///< L_n [m]
  std::optional<double> conductivity = {};         ///< K, only for `ehdjet check` [S/m]
  bool operator==(const NozzleConfig&) const = default;

  [[nodiscard]] double section() const;              ///< A0 = pi a0^2 [m^2]
  [[nodiscard]] double fluid_velocity() const;       ///< v_s, or Q/A0 of a pump [m/s]
  [[nodiscard]] double fluid_charge_density() const; ///< rho_q, or I/Q [C/m^3]
};

/// Several jets from equal nozzles on a grid in the plane x = 0 (model 9). Needs `NozzleConfig`.
struct ArrayConfig {
  std::size_t rows = 1, columns = 1; ///< along z and along y
  double spacing = 0;                ///< between neighbouring nozzles [m]
  ArrayPhases phases = ArrayPhases::equal;
  bool operator==(const ArrayConfig&) const = default;

  [[nodiscard]] std::size_t jets() const { return rows * columns; }
  /// Jet j = row columns + column. The grid is centred on the axis.
  [[nodiscard]] JetAxis axis(std::size_t j) const;
  /// What is added to the phase of its nozzle [rad].
  [[nodiscard]] double phase(std::size_t j) const;
};

/// The jet is a given chain of beads; nothing is inserted. Excludes `NozzleConfig`.
struct ChainConfig {
  std::string file; ///< CSV, or HDF5 written by a run; relative to the scene file
  std::optional<double>
      time; ///< frame of an HDF5 file nearest to this time [s]; default: last
  FixedEnds fixed = FixedEnds::none;
  bool operator==(const ChainConfig&) const = default;
};

/// Uniform external field along +x: Phi0/h, or given directly. Exactly one of the two.
struct FieldConfig {
  std::optional<double> potential; ///< Phi0 [V]; needs a collector
  std::optional<double> strength;  ///< E [V/m]
  FieldWaveform waveform = FieldWaveform::constant;
  std::optional<double> frequency = {};     ///< f of the square wave [1/s]
  std::optional<double> time_constant = {}; ///< tau of the RC circuit [s]
  bool operator==(const FieldConfig&) const = default;
};

struct GravityConfig {
  double acceleration = 0; ///< g along +x [m/s^2]
  bool operator==(const GravityConfig&) const = default;
};

struct CoulombConfig {
  std::string solver = "direct";
  double tolerance = 1e-6; ///< of the net force, what all but the direct sum keep [-]
  std::optional<ToleranceNorm> norm = {}; ///< moving with a nozzle, global for chains
  NearFieldForm near_field = NearFieldForm::point;
  std::optional<bool> softened_pairs = {};    ///< default: see `softens_pairs`
  std::optional<double> softening_range = {}; ///< C [-]
  // For studies; otherwise they follow from the tolerance.
  std::optional<std::size_t> order = {};
  std::optional<double> opening = {};
  std::optional<std::size_t> leaf = {};
  std::optional<std::size_t> check_every = {}; ///< evaluations between checks of the error
  std::optional<std::string> calibration = {}; ///< file written by `ehdjet calibrate`
  bool operator==(const CoulombConfig&) const = default;
};

/// A spring of a polymer and how fast its stress relaxes (model 2.3).
struct RelaxationMode {
  double modulus = 0;         ///< G [Pa]
  double relaxation_time = 0; ///< lambda [s]
  bool operator==(const RelaxationMode&) const = default;
};

/// The rheology of the fluid (model 2).
struct ViscoelasticityConfig {
  std::optional<double> elastic_modulus =
      {};                               ///< G [Pa]; like mu always there without modes
  std::optional<double> viscosity = {}; ///< mu [Pa s]
  Rheology model = Rheology::maxwell;
  std::optional<std::vector<RelaxationMode>> modes = {}; ///< instead of G and mu
  std::optional<double> mobility = {};                   ///< alpha_G of Giesekus [-]
  std::optional<double> solvent_viscosity = {};          ///< mu_s [Pa s]
  std::optional<double> extensibility = {};              ///< L2 of FENE-P [-]
  // Of Herschel-Bulkley.
  std::optional<double> consistency = {};    ///< K [Pa s^n]
  std::optional<double> flow_index = {};     ///< n [-]
  std::optional<double> yield_stress = {};   ///< tau_Y [Pa]
  std::optional<double> regularization = {}; ///< m [s]
  bool operator==(const ViscoelasticityConfig&) const = default;

  /// Whether the stress is a tensor (model 2.3).
  [[nodiscard]] bool is_tensorial() const;
  /// Those with a stress; without `modes` G and mu/G are the only one.
  [[nodiscard]] std::vector<RelaxationMode> relaxation_modes() const;
  /// eta of the stress eta e that follows the strain rate at once [Pa s].
  [[nodiscard]] double instant_viscosity() const;
};

/// Air around the jet (model 2.1).
struct AirConfig {
  double density = 1.21;                         ///< rho_air [kg/m^3]
  double kinematic_viscosity = 1.511e-5;         ///< nu [m^2/s]
  std::optional<std::array<double, 3>> velocity; ///< u [m/s]; still air without
  std::optional<std::string> profile;            ///< file with u over x; excludes velocity
  DragLaw drag = DragLaw::anisotropic;
  bool lift = false;
  bool operator==(const AirConfig&) const = default;
};

/// The solvent evaporates, the jet dries and becomes a fibre (model 2.2).
struct EvaporationConfig {
  double solvent_density = 0;                                    ///< rho_s [kg/m^3]
  double polymer_density = 0;                                    ///< rho_p [kg/m^3]
  double polymer_fraction = 0;                                   ///< c_0, of the mass [-]
  double diffusivity = 0;                                        ///< D [m^2/s]
  double saturation = 0;                                         ///< C_sat [kg/m^3]
  double humidity = 0;                                           ///< phi [-]
  double solid_fraction = 0.9;                                   ///< c_solid [-]
  double still_air_sherwood = Vaporisation{}.still_air_sherwood; ///< [-]
  std::optional<double> viscosity_exponent = {};                 ///< B [-]
  std::optional<double> viscosity_power = {};                    ///< m [-]
  bool operator==(const EvaporationConfig&) const = default;

  [[nodiscard]] Solution solution() const {
    return {polymer_density, solvent_density, polymer_fraction};
  }
};

struct SurfaceTensionConfig {
  double coefficient = 0; ///< alpha [N/m]
  SurfaceTensionForm form = SurfaceTensionForm::paper;
  bool operator==(const SurfaceTensionConfig&) const = default;
};

/// Plane x = distance where beads land (model 5).
struct CollectorConfig {
  double distance = 0; ///< h [m]
  CollectorCharge charge = CollectorCharge::grounded;
  CollectorImages images = CollectorImages::none;
  std::optional<double> decay_time = {};              ///< of the charges on a mat, tau [s]
  std::optional<std::array<double, 3>> velocity = {}; ///< U, 0 along x [m/s]
  bool operator==(const CollectorConfig&) const = default;
};

/// Every k-th bead that is born differs from the others (model 4).
struct VaricosityConfig {
  std::size_t every = 0;                           ///< k
  double factor = 0;                               ///< f
  bool mass = true, volume = true, charge = false; ///< what it multiplies
  bool operator==(const VaricosityConfig&) const = default;
};

/// Dynamic mesh refinement (model 7).
struct RefinementConfig {
  double length = 0;                   ///< L~ [m]
  std::optional<double> interval = {}; ///< t_ref [s]
  RefinedMesh mesh = RefinedMesh::redistribute;
  LinkRemap remap = LinkRemap::conservative;
  ColumnRemap velocity = ColumnRemap::spline;
  std::optional<ColumnRemap> stress = {}; ///< none: spline; conservative for tensors
  std::optional<double> coarsen = {};     ///< join links together shorter than this [m]
  std::optional<double> shortest = {};    ///< join links shorter than so many radii [-]
  bool operator==(const RefinementConfig&) const = default;
};

/// Time integration (model 6). Either `rtol` (adaptive) or `step` (fixed).
struct IntegratorConfig {
  std::string method = "auto";
  std::optional<double> rtol;         ///< [-]
  std::optional<double> step;         ///< dt [s]
  std::optional<double> initial_step; ///< adaptive only [s]
  std::optional<double> max_step;     ///< adaptive only [s]
  double min_step = 1e-15;            ///< below this the run stops [s]
  /// The error of a component y is measured against rtol (scale + |y|). Defaults (model 6):
  std::optional<double> position_scale; ///< [m], l_step (chain: shortest link)
  double velocity_scale = 1;            ///< [m/s]
  std::optional<double> stress_scale;   ///< [Pa], 0.1 G
  ErrorNorm norm = ErrorNorm::max;
  EventPlacement events = EventPlacement::located;
  LandingSteps landings = LandingSteps::automatic;
  std::optional<std::size_t> inner_beads; ///< of two rates; none: 24, adapted
  std::optional<double> downstream_rtol;  ///< of two rates; none: rtol [-]
  bool operator==(const IntegratorConfig&) const = default;
};

struct RunConfig {
  double end_time = 0;                 ///< [s]
  std::optional<std::size_t> threads;  ///< default: all processors
  std::optional<double> max_wall_time; ///< default: none [s]
  bool operator==(const RunConfig&) const = default;
};

/// What is written; each absent part writes nothing and costs nothing.
struct OutputConfig {
  std::optional<double> observables; ///< time between rows of observables [s]
  std::optional<double> frames;      ///< time between frames of all beads [s]
  bool deposit = false;              ///< record every bead that leaves at the collector
  RefinementRecords refinements = RefinementRecords::none;
  std::optional<double> budget;          ///< time between rows of energy and momentum [s]
  std::optional<double> resolving_power; ///< time between samples of l_step/l [s]
  std::optional<double> checkpoints;     ///< simulated time between checkpoints [s]
  double checkpoint_wall_time = 300;     ///< wall time between others; 0: none [s]
  double flush = 2;                      ///< longest wall time between flushes to disk [s]
  bool operator==(const OutputConfig&) const = default;
};

struct SceneConfig {
  std::string title;
  RunConfig run;
  std::optional<NozzleConfig> nozzle;
  std::optional<ArrayConfig> array;
  std::optional<ChainConfig> chain;
  std::optional<CollectorConfig> collector;
  std::optional<FieldConfig> field;
  std::optional<GravityConfig> gravity;
  std::optional<CoulombConfig> coulomb;
  std::optional<ViscoelasticityConfig> viscoelasticity;
  std::optional<SurfaceTensionConfig> surface_tension;
  std::optional<AirConfig> air;
  std::optional<EvaporationConfig> evaporation;
  std::optional<VaricosityConfig> varicosity;
  std::optional<RefinementConfig> refinement;
  IntegratorConfig integrator;
  OutputConfig output;
  bool operator==(const SceneConfig&) const = default;
};

/// Whether the charge in a pump's nozzle acts on the jet: its plate would screen it (model 3.2).
[[nodiscard]] bool has_nozzle_charge(const SceneConfig& config);
[[nodiscard]] bool has_images(const SceneConfig& config);
/// Whether a scene can be simulated with two rates, and its method allows it (model 6.1).
[[nodiscard]] bool can_have_two_rates(const SceneConfig& config);
[[nodiscard]] bool has_near_field(const SceneConfig& config);
/// Whether pairs of close charges are softened (model 3.1).
[[nodiscard]] bool softens_pairs(const SceneConfig& config);

/// The beads of a chain scene, from bead 0 on. All columns have the same length; those of links
/// belong to the link that ends at the bead (entry 0 belongs to no link).
struct ChainBeads {
  std::vector<double> x, y, z;    ///< [m]
  std::vector<double> vx, vy, vz; ///< [m/s]
  std::vector<double> volume;     ///< [m^3]
  std::vector<double> mass;       ///< [kg]
  std::vector<double> charge;     ///< [C]

  /// Another column of the file. Only columns that some force adds to the jet play a part.
  struct Other {
    std::vector<double> values;
    std::string fault = {}; ///< why it has no numbers, if so
  };
  std::map<std::string, Other> others; ///< by their names in CSV, as stress_pa

  [[nodiscard]] std::size_t size() const { return x.size(); }
  /// Fills a column of a jet, with `unless_given` if the file does not have it.
  /// errors : InputError if what the file has is not numbers
  void copy_to(const BeadColumn& column, std::span<double> out) const;
};

} // namespace ehdjet
