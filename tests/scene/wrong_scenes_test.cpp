#include <ostream>

#include "support.hpp"

namespace ehdjet {
namespace {

/// One line of the good scene broken, and what the message must contain.
struct Wrong {
  const char* name;
  const char* piece;
  const char* by;
  std::vector<std::string> expected;
};
std::ostream& operator<<(std::ostream& os, const Wrong& w) {
  return os << w.name;
}

const Wrong wrong_scenes[] = {
    {"unknown_key",
     "radius = 5e-5",
     "radus = 5e-5", //
     {"s.toml:5: ", "unknown key nozzle.radus", "did you mean nozzle.radius?"}},
    {"key_of_another_table",
     "potential = 9000",
     "potential = 9000\nviscosity = 2",
     {"s.toml:14: ", "unknown key field.viscosity",
      "did you mean viscoelasticity.viscosity?"}},
    {"key_outside_its_table",
     "title = \"good\"",
     "end_time = 1",
     {"s.toml:1: ", "unknown key end_time", "did you mean run.end_time?"}},
    {"unknown_table",
     "[collector]",
     "[colector]", //
     {"s.toml:10: ", "unknown table [colector]", "did you mean [collector]?"}},
    {"nothing_is_near",
     "radius = 5e-5",
     "bananas = 5e-5",
     {"s.toml:5: unknown key nozzle.bananas"}},
    {"table_as_number",
     "[gravity]\nacceleration = 9.80665",
     "[[gravity]]", //
     {"s.toml:14: ", "gravity = an array", "must be a table [gravity]"}},

    {"text_for_a_number",
     "radius = 5e-5",
     "radius = \"thin\"", //
     {"s.toml:5: ", "nozzle.radius = \"thin\"", "a number", "a0"}},
    {"number_for_text",
     "title = \"good\"",
     "title = 3",
     {"s.toml:1: ", "title = 3", "must be text in quotes"}},
    {"number_for_a_choice",
     "coefficient = 0.021",
     "coefficient = 0.021\nform = 2",
     {"s.toml:22: ", "surface_tension.form = 2", "\"paper\" or \"line\""}},
    {"number_for_yes_or_no",
     "observables = 1e-4",
     "deposit = 1",
     {"s.toml:25: ", "output.deposit = 1", "must be true or false"}},
    {"fraction_of_a_thread",
     "end_time = 0.01",
     "end_time = 0.01\nthreads = 1.5",
     {"s.toml:4: ", "run.threads = 1.5", "a whole number from 1 to 4096"}},

    {"negative_radius",
     "radius = 5e-5",
     "radius = -5e-05",
     {"s.toml:5: nozzle.radius = -5e-05 m: must be greater than 0", "0.002 m", "a0"}},
    {"zero_length", "link_length = 2e-4", "link_length = 0", {"nozzle.link_length = 0 m"}},
    {"radius_in_centimetres",
     "radius = 5e-5",
     "radius = 0.005", //
     {"nozzle.radius = 0.005 m", "at most 0.002 m, in SI units"}},
    {"density_in_grams_per_cubic_centimetre",
     "density = 840",
     "density = 0.84",
     {"nozzle.density = 0.84 kg/m^3", "from 1 to 100000 kg/m^3, in SI units"}},
    {"charge_density_in_statcoulombs",
     "charge_density = 14.7",
     "charge_density = 44000",
     {"nozzle.charge_density = 44000 C/m^3", "in SI units"}},
    {"collector_in_centimetres",
     "distance = 0.16",
     "distance = 16",
     {"collector.distance = 16 m"}},
    {"gravity_in_centimetres",
     "acceleration = 9.80665",
     "acceleration = 980.665",
     {"gravity.acceleration = 980.665 m/s^2", "in SI units"}},
    {"not_a_number",
     "density = 840",
     "density = nan",
     {"s.toml:8: nozzle.density = nan kg/m^3"}},
    {"infinity", "end_time = 0.01", "end_time = inf", {"s.toml:3: run.end_time = inf s"}},
    {"unknown_method",
     "rtol = 1e-5",
     "method = \"rk45\"",
     {"s.toml:23: integrator.method = \"rk45\"", "\"dormand-prince\" or \"dop853\""}},

    {"missing_key",
     "radius = 5e-5\n",
     "",
     {"s.toml:4: nozzle.radius is missing", "greater than 0", "m", "a0"}},
    {"missing_table",
     "[run]\nend_time = 0.01\n",
     "",
     {"s.toml: run.end_time is missing", "greater than 0"}},

    {"thick_beads",
     "radius = 5e-5",
     "radius = 1e-3",
     {"s.toml:5: ", "nozzle.radius = 0.001 m", "nozzle.link_length = 0.0002 m", "metres"}},
    {"collector_at_the_nozzle",
     "distance = 0.16",
     "distance = 4e-4",
     {"s.toml:11: ", "collector.distance = 0.0004 m", "nozzle.link_length = 0.0002 m"}},
    {"nozzle_and_chain",
     "[collector]",
     "[chain]\nfile = \"c.csv\"\n[collector]",
     {"s.toml:10: ", "both [nozzle] and [chain]"}},
    {"field_twice",
     "potential = 9000",
     "potential = 9000\nstrength = 56250",
     {"s.toml:14: ", "field.potential = 9000 V", "field.strength = 56250 V/m",
      "exactly one"}},
    {"field_without_value",
     "potential = 9000\n",
     "", //
     {"s.toml:12: ", "neither field.potential nor field.strength"}},
    {"potential_without_collector",
     "[collector]\ndistance = 0.16\n",
     "",
     {"s.toml:11: ", "field.potential = 9000 V", "needs collector.distance"}},
    {"tolerance_and_step",
     "rtol = 1e-5",
     "rtol = 1e-5\nstep = 1e-8",
     {"s.toml:24: ", "integrator.rtol = 1e-05", "integrator.step = 1e-08 s"}},
    {"tolerance_without_estimate",
     "rtol = 1e-5",
     "rtol = 1e-5\nmethod = \"rk4\"",
     {"s.toml:23: ", "integrator.rtol = 1e-05", "integrator.method = \"rk4\"",
      "integrator.step"}},
    {"neither_tolerance_nor_step_nor_estimate",
     "rtol = 1e-5",
     "method = \"euler\"",
     {"s.toml:23: ", "integrator.method = \"euler\" needs integrator.step"}},
    {"fixed_steps_of_no_method_in_particular",
     "rtol = 1e-5",
     "step = 1e-8",
     {"s.toml:23: ", "integrator.step = 1e-08 s", "integrator.method = \"auto\"",
      "Name another method"}},
    {"two_rates_with_events_at_step_ends",
     "rtol = 1e-5",
     "rtol = 1e-5\nmethod = \"two-rate\"\nevents = \"step-end\"",
     {"s.toml:25: ", "integrator.events = \"step-end\"", "Take \"located\""}},
    {"two_rates_with_a_step_for_every_landing",
     "rtol = 1e-5",
     "rtol = 1e-5\nmethod = \"two-rate\"\nlandings = \"located\"",
     {"s.toml:25: ", "integrator.landings = \"located\"", "Take \"auto\""}},
    {"fixed_steps_with_two_rates",
     "rtol = 1e-5",
     "step = 1e-8\nmethod = \"two-rate\"",
     {"s.toml:23: ", "integrator.method = \"two-rate\": it chooses"}},
    {"inner_beads_of_a_method_with_one_rate",
     "rtol = 1e-5",
     "rtol = 1e-5\nmethod = \"dormand-prince\"\ninner_beads = 30",
     {"s.toml:25: ", "integrator.inner_beads", "method = \"two-rate\" or \"auto\""}},
    {"array_with_two_rates",
     "rtol = 1e-5",
     "rtol = 1e-5\nmethod = \"two-rate\"\n[array]\nrows = 2\ncolumns = 1\nspacing = 0.01",
     {"s.toml:24: ", "integrator.method = \"two-rate\" and [array]", "Take \"auto\""}},
    {"inner_beads_of_an_array",
     "rtol = 1e-5",
     "rtol = 1e-5\ninner_beads = 30\n[array]\nrows = 2\ncolumns = 1\nspacing = 0.01",
     {"s.toml:24: ", "integrator.inner_beads", "no [array]"}},
    {"array_without_charges",
     "[coulomb]",
     "[array]\nrows = 2\ncolumns = 1\nspacing = 0.01",
     {"s.toml:16: ", "[array] needs [coulomb]"}},
    {"array_of_overlapping_nozzles",
     "[coulomb]",
     "[coulomb]\n[array]\nrows = 2\ncolumns = 1\nspacing = 5e-5",
     {"s.toml:20: ", "array.spacing = 5e-05 m", "at least 0.0001 m"}},
    {"array_without_nozzles",
     "[coulomb]",
     "[coulomb]\n[array]\nrows = 0\ncolumns = 1\nspacing = 0.01",
     {"s.toml:18: ", "array.rows = 0", "a whole number from 1 to 1000"}},
    {"array_without_a_spacing",
     "[coulomb]",
     "[coulomb]\n[array]\nrows = 1\ncolumns = 2",
     {"array.spacing", "missing"}},
    {"images_of_an_array",
     "distance = 0.16",
     "distance = 0.16\nimages = \"collector\"\n[array]\nrows = 1\ncolumns = 2\nspacing = "
     "0.01",
     {"s.toml:12: ", "collector.images and [array]"}},
    {"fibres_of_an_array_that_keep_their_charge",
     "distance = 0.16",
     "distance = 0.16\ncharge = \"kept-on-mat\"\n[array]\nrows = 1\ncolumns = 2\nspacing = "
     "0.01",
     {"s.toml:12: ", "collector.charge and [array]"}},
    {"budget_of_an_array",
     "observables = 1e-4",
     "budget = 1e-4\n[array]\nrows = 1\ncolumns = 2\nspacing = 0.01",
     {"s.toml:25: ", "output.budget and [array]", "single jet"}},
    {"resolving_power_of_an_array",
     "observables = 1e-4",
     "resolving_power = 1e-4\n[array]\nrows = 1\ncolumns = 2\nspacing = 0.01",
     {"s.toml:25: ", "output.resolving_power and [array]"}},
    {"too_few_inner_beads",
     "rtol = 1e-5",
     "rtol = 1e-5\ninner_beads = 4",
     {"s.toml:24: ", "integrator.inner_beads = 4", "a whole number from 8 to 100000"}},
    {"first_step_of_fixed_steps",
     "rtol = 1e-5",
     "step = 1e-8\ninitial_step = 1e-9\nmethod = \"rk4\"",
     {"s.toml:24: ", "integrator.initial_step = 1e-09", "integrator.step = 1e-08 s"}},
    {"longest_step_below_the_shortest",
     "rtol = 1e-5",
     "max_step = 1e-9\nmin_step = 1e-6",
     {"s.toml:23: ", "integrator.max_step = 1e-09 s", "integrator.min_step = 1e-06 s"}},
    {"scale_of_a_stress_that_does_not_exist",
     "[viscoelasticity]\nelastic_modulus = 5e3\nviscosity = "
     "2\n[surface_tension]\ncoefficient = "
     "0.021\n[integrator]",
     "[integrator]\nstress_scale = 5",
     {"s.toml:18: ", "integrator.stress_scale = 5 Pa", "[viscoelasticity]"}},
    {"more_rows_than_a_disk",
     "observables = 1e-4",
     "observables = 1e-12",
     {"s.toml:25: ", "output.observables = 1e-12 s", "run.end_time = 0.01 s",
      "1e+10 rows"}},
    {"no_time_between_rows",
     "observables = 1e-4",
     "frames = 0",
     {"s.toml:25: output.frames = 0 s: must be greater than 0"}},
    {"deposit_without_collector",
     "[collector]\ndistance = 0.16\n[field]\npotential = 9000\n[gravity]\nacceleration = "
     "9.80665\n[coulomb]\n[viscoelasticity]\nelastic_modulus = 5e3\nviscosity = "
     "2\n[surface_tension]\ncoefficient = 0.021\n[integrator]\nrtol = 1e-5\n[output]",
     "[output]\ndeposit = true",
     {"s.toml:11: ", "output.deposit = true needs [collector]"}},

    {"unknown_solver",
     "[coulomb]",
     "[coulomb]\nsolver = \"fast\"",
     {"s.toml:17: ", "coulomb.solver = \"fast\"", "\"fmm\""}},
    {"tolerance_that_nothing_keeps",
     "[coulomb]",
     "[coulomb]\ntolerance = 1e-20",
     {"s.toml:17: ", "coulomb.tolerance = 1e-20", "from 1e-13 to 0.1"}},
    {"order_of_a_direct_sum",
     "[coulomb]",
     "[coulomb]\norder = 8",
     {"s.toml:17: ", "coulomb.order", "no expansions"}},
    {"leaf_that_no_vector_fills",
     "[coulomb]",
     "[coulomb]\nsolver = \"fmm\"\nleaf = 20",
     {"s.toml:18: ", "coulomb.leaf = 20", "multiple of 8"}},
    {"calibration_of_a_solver_that_does_not_choose",
     "[coulomb]",
     "[coulomb]\nsolver = \"fmm\"\ncalibration = \"here.toml\"",
     {"s.toml:18: ", "coulomb.calibration", "\"auto\""}},
    {"missing_calibration",
     "[coulomb]",
     "[coulomb]\nsolver = \"auto\"\ncalibration = \"nowhere.toml\"",
     {"nowhere.toml", "No such file"}},
    {"key_that_has_another_name_now",
     "[coulomb]",
     "[coulomb]\ntolerance_norm = \"global\"",
     {"s.toml:17: ", "unknown key coulomb.tolerance_norm", "did you mean coulomb.norm?"}},
    {"softening_of_points",
     "[coulomb]",
     "[coulomb]\nsoftened_pairs = true",
     {"s.toml:17: ", "coulomb.softened_pairs = true", "coulomb.near_field = \"point\""}},
    {"range_of_no_softening",
     "[coulomb]",
     "[coulomb]\nnear_field = \"free-surface\"\nsoftening_range = 30",
     {"s.toml:18: ", "coulomb.softening_range = 30", "no pairs are softened"}},
    {"energy_of_a_fixed_radius",
     "[coulomb]\n[viscoelasticity]\nelastic_modulus = 5e3\nviscosity = 2\n"
     "[surface_tension]\ncoefficient = 0.021\n[integrator]\nrtol = 1e-5\n[output]",
     "[coulomb]\nnear_field = \"fixed\"\n[output]\nbudget = 1e-3",
     {"s.toml:17: ", "coulomb.near_field = \"fixed\"", "output.budget"}},
    {"collector_that_moves_out_of_its_plane",
     "distance = 0.16",
     "distance = 0.16\nvelocity = [0.5, 2, 0]",
     {"s.toml:", "collector.velocity = [0.5, 2, 0] m/s", "first component must be 0 m/s"}},
    {"collector_velocity_of_two_numbers",
     "distance = 0.16",
     "distance = 0.16\nvelocity = [2, 0]",
     {"s.toml:", "collector.velocity = [2, 0]", "three numbers [x, y, z]",
      "from -1000 to 1000 m/s"}},
    {"square_wave_without_frequency",
     "potential = 9000",
     "potential = 9000\nwaveform = \"square\"",
     {"s.toml:", "field.frequency is missing", "field.waveform = \"square\"",
      "greater than 0", "1/s"}},
    {"time_constant_of_a_constant_field",
     "potential = 9000",
     "potential = 9000\ntime_constant = 1e-3",
     {"s.toml:14: ", "field.time_constant = 0.001 s", "waveform = \"rc\""}},
    {"decay_on_a_grounded_collector",
     "distance = 0.16",
     "distance = 0.16\ndecay_time = 0.1",
     {"s.toml:12: ", "collector.decay_time = 0.1 s", "\"kept-on-mat\""}},
    {"mat_of_charges_that_do_not_act",
     "distance = 0.16\n[field]\npotential = 9000\n[gravity]\nacceleration = "
     "9.80665\n[coulomb]",
     "distance = 0.16\ncharge = \"kept-on-mat\"\n[field]\npotential = "
     "9000\n[gravity]\nacceleration = 9.80665",
     {"s.toml:12: ", "collector.charge = \"kept-on-mat\"", "[coulomb]"}},
    {"images_in_an_insulating_collector",
     "distance = 0.16",
     "distance = 0.16\nimages = \"collector\"\ncharge = \"kept\"",
     {"s.toml:12: ", "collector.images = \"collector\"",
      "collector.charge = \"grounded\""}},
    {"image_of_a_nozzle_without_a_pump",
     "distance = 0.16",
     "distance = 0.16\nimages = \"plates\"",
     {"s.toml:12: ", "collector.images = \"plates\"", "nozzle.inflow = \"pump\""}},
    {"images_with_two_rates",
     "distance = 0.16\n[field]\npotential = 9000\n[gravity]\nacceleration = "
     "9.80665\n[coulomb]\n[viscoelasticity]\nelastic_modulus = 5e3\nviscosity = "
     "2\n[surface_tension]\ncoefficient = 0.021\n[integrator]",
     "distance = 0.16\nimages = \"collector\"\n[field]\npotential = 9000\n[gravity]\n"
     "acceleration = 9.80665\n[coulomb]\n[viscoelasticity]\nelastic_modulus = "
     "5e3\nviscosity = 2\n[surface_tension]\ncoefficient = "
     "0.021\n[integrator]\nmethod = \"two-rate\"",
     {"s.toml:24: ", "integrator.method = \"two-rate\"", "collector.images = \"none\""}},
    {"pump_without_flow",
     "velocity = 3e-3",
     "inflow = \"pump\"",
     {"s.toml:4: ", "nozzle.flow_rate is missing", "inflow = \"pump\""}},
    {"pump_with_a_velocity",
     "velocity = 3e-3",
     "velocity = 3e-3\ninflow = \"pump\"\nflow_rate = 1e-8",
     {"s.toml:7: ", "nozzle.velocity = 0.003", "nozzle.flow_rate and nozzle.radius"}},
    {"pump_with_two_charges",
     "velocity = 3e-3",
     "current = 1e-7\ninflow = \"pump\"\nflow_rate = 1e-8",
     {"s.toml:7: ", "nozzle.current = 1e-07 A", "nozzle.charge_density = ", "Remove one"}},
    {"pump_of_points_that_collapse",
     "velocity = 3e-3",
     "inflow = \"pump\"\nflow_rate = 1e-8",
     {"s.toml:", "nozzle.link_length = 0.0002 m", "collapse", "at least 6 radii"}},
    {"stress_of_a_pump_without_any",
     "velocity = 3e-3\ndensity = 840\ncharge_density = 14.7\n[collector]\ndistance = "
     "0.16\n[field]\npotential = 9000\n[gravity]\nacceleration = "
     "9.80665\n[coulomb]\n[viscoelasticity]\nelastic_modulus = 5e3\nviscosity = 2\n",
     "inflow = \"pump\"\nflow_rate = 1e-8\ndensity = 840\ncharge_density = 14.7\n"
     "nozzle_stress = 5\n[collector]\ndistance = 0.16\n[field]\npotential = 9000\n",
     {"s.toml:11: ", "nozzle.nozzle_stress = 5", "[viscoelasticity]"}},
    {"flow_rate_without_a_pump",
     "velocity = 3e-3",
     "velocity = 3e-3\nflow_rate = 1e-8",
     {"s.toml:8: ", "nozzle.flow_rate = 1e-08", "inflow = \"embryo\""}},
    {"no_velocity", "velocity = 3e-3", "", {"s.toml:4: ", "nozzle.velocity is missing"}},
    {"redistribution_without_an_interval",
     "[integrator]",
     "[refinement]\nlength = 3e-3\n[integrator]",
     {"s.toml:22: ", "refinement.interval is missing", "mesh = \"cut\""}},
    {"remap_of_cuts",
     "[integrator]",
     "[refinement]\nlength = 3e-3\nmesh = \"cut\"\nremap = \"paper\"\n[integrator]",
     {"s.toml:25: ", "refinement.remap", "mesh = \"cut\""}},
    {"charge_of_an_unknown_collector",
     "distance = 0.16",
     "distance = 0.16\ncharge = \"lost\"",
     {"s.toml:12: ", "collector.charge = \"lost\"",
      "\"grounded\", \"kept\" or \"kept-on-mat\""}},
    {"refinement_without_its_length",
     "[integrator]",
     "[refinement]\ninterval = 1e-3\n[integrator]",
     {"s.toml:22: ", "refinement.length is missing", "L~"}},
    {"refinement_finer_than_the_link_that_is_being_fed",
     "[integrator]",
     "[refinement]\nlength = 3e-4\ninterval = 1e-3\n[integrator]",
     {"s.toml:23: ", "refinement.length = 0.0003 m", "nozzle.link_length = 0.0002 m"}},
    {"refinement_that_would_never_happen",
     "[integrator]",
     "[refinement]\nlength = 3e-3\ninterval = 1\n[integrator]",
     {"s.toml:24: ", "refinement.interval = 1 s", "run.end_time = 0.01 s"}},
    {"unknown_remap",
     "[integrator]",
     "[refinement]\nlength = 3e-3\ninterval = 1e-3\nremap = \"fast\"\n[integrator]",
     {"s.toml:25: ", "refinement.remap = \"fast\"", "\"conservative\" or \"paper\""}},
    {"coarsening_what_was_just_cut",
     "[integrator]",
     "[refinement]\nlength = 3e-3\ninterval = 1e-3\ncoarsen = 2e-3\n[integrator]",
     {"s.toml:25: ", "refinement.coarsen = 0.002 m", "0.0015 m"}},
    {"joining_what_was_just_cut",
     "[integrator]",
     "[refinement]\nlength = 3e-3\nmesh = \"cut\"\nshortest = 40\n[integrator]",
     {"s.toml:25: ", "refinement.shortest = 40", "at most 30"}},
    {"air_of_no_density",
     "[integrator]",
     "[air]\ndensity = 0\n[integrator]",
     {"s.toml:23: ", "air.density = 0 kg/m^3", "greater than 0"}},
    {"wind_of_two_numbers",
     "[integrator]",
     "[air]\nvelocity = [1, 2]\n[integrator]",
     {"s.toml:23: ", "air.velocity = [1, 2]", "three numbers", "from -100 to 100 m/s"}},
    {"wind_faster_than_any",
     "[integrator]",
     "[air]\nvelocity = [0, 250, 0]\n[integrator]",
     {"s.toml:23: ", "air.velocity = [0, 250, 0]", "from -100 to 100 m/s"}},
    {"wind_and_profile",
     "[integrator]",
     "[air]\nvelocity = [0, 2, 0]\nprofile = \"wind.csv\"\n[integrator]",
     {"s.toml:24: ", "air.velocity and air.profile = \"wind.csv\"", "Remove one"}},
    {"unknown_drag",
     "[integrator]",
     "[air]\ndrag = \"stokes\"\n[integrator]",
     {"s.toml:23: ", "air.drag = \"stokes\"", "\"anisotropic\" or \"tangential\""}},
    {"evaporation_into_nothing",
     "[integrator]",
     "[evaporation]\nsolvent_density = 789\npolymer_density = 1200\npolymer_fraction = "
     "0.1\ndiffusivity = 1.2e-5\nsaturation = 0.11\n[integrator]",
     {"s.toml:22: ", "[evaporation] needs [air]"}},
    {"evaporation_of_what_is_solid",
     "[integrator]",
     "[air]\n[evaporation]\nsolvent_density = 789\npolymer_density = "
     "1200\npolymer_fraction = "
     "0.1\ndiffusivity = 1.2e-5\nsaturation = 0.11\nsolid_fraction = 0.05\n[integrator]",
     {"s.toml:29: ", "evaporation.solid_fraction = 0.05", "polymer_fraction = 0.1"}},
    {"evaporation_of_another_fluid",
     "[integrator]",
     "[air]\n[evaporation]\nsolvent_density = 1300\npolymer_density = "
     "1200\npolymer_fraction = 0.1\ndiffusivity = 1.2e-5\nsaturation = 0.11\n[integrator]",
     {"s.toml:8: ", "nozzle.density = 840 kg/m^3", "1289 kg/m^3", "within 10 %"}},
    {"thickening_of_an_inviscid_fluid",
     "[viscoelasticity]\nelastic_modulus = 5e3\nviscosity = 2",
     "[air]\n[evaporation]\nsolvent_density = 789\npolymer_density = "
     "1200\npolymer_fraction = "
     "0.1\ndiffusivity = 1.2e-5\nsaturation = 0.11\nviscosity_power = 0.2",
     {"s.toml:24: ", "evaporation.viscosity_power = 0.2", "without [viscoelasticity]"}},
    {"phases_of_nozzles_that_rest",
     "[integrator]",
     "[array]\nrows = 2\ncolumns = 1\nspacing = 0.01\nphases = \"spread\"\n[integrator]",
     {"s.toml:26: ", "array.phases = \"spread\"", "nozzle.amplitude = 0 m"}},
    {"inner_beads_where_every_landing_ends_a_step",
     "rtol = 1e-5",
     "rtol = 1e-5\nlandings = \"located\"\ninner_beads = 30",
     {"s.toml:25: ", "integrator.inner_beads", "landings = \"auto\""}},
    {"humidity_in_percent",
     "[integrator]",
     "[air]\n[evaporation]\nsolvent_density = 789\npolymer_density = "
     "1200\npolymer_fraction = "
     "0.1\ndiffusivity = 1.2e-5\nsaturation = 0.11\nhumidity = 40\n[integrator]",
     {"s.toml:29: ", "evaporation.humidity = 40", "from 0 to 1"}},
    {"varicosity_every_half_bead",
     "[integrator]",
     "[varicosity]\nevery = 0.5\nfactor = 1.1\n[integrator]",
     {"s.toml:23: ", "varicosity.every = 0.5", "a whole number"}},
    {"varicosity_of_nothing",
     "[integrator]",
     "[varicosity]\nevery = 10\nfactor = 1.1\nmass = false\nvolume = false\n[integrator]",
     {"s.toml:22: ", "varicosity.mass", "nothing would differ"}},
    {"records_of_no_refinement",
     "observables = 1e-4",
     "refinements = \"sums\"",
     {"s.toml:25: ", "output.refinements = \"sums\"", "[refinement]"}},

    {"not_toml", "radius = 5e-5", "radius = 5e-5 m", {"s.toml:5:15: "}},
    {"the_same_key_twice",
     "radius = 5e-5",
     "radius = 5e-5\nradius = 6e-5",
     {"s.toml:6:", "radius"}},
    {"the_same_table_twice",
     "[coulomb]",
     "[coulomb]\n[coulomb]",
     {"s.toml:17:", "coulomb"}},
};

class WrongScenes : public testing::TestWithParam<Wrong> {};

TEST_P(WrongScenes, are_refused_with_file_line_key_value_and_what_is_allowed) {
  const Wrong& w = GetParam();
  expect_all(complaint_about(good_scene_but(w.piece, w.by)), w.expected);
}
INSTANTIATE_TEST_SUITE_P(All, WrongScenes, testing::ValuesIn(wrong_scenes),
                         [](const auto& p) { return p.param.name; });

TEST(WrongScenes, the_good_scene_is_accepted) {
  EXPECT_EQ(complaint_about(good_scene), "(accepted)");
}

TEST(WrongScenes, a_scene_without_a_jet_is_refused) {
  expect_all(complaint_about("[run]\nend_time = 1\n"),
             {"s.toml: neither [nozzle] nor [chain]"});
}

TEST(WrongScenes, a_missing_file_is_named_with_the_reason) {
  expect_all(complaint([] { read_scene("no/such/scene.toml"); }),
             {"no/such/scene.toml", "No such file"});
  expect_all(complaint([] { read_scene("/"); }), {"it is a folder"});
}

TEST(WrongScenes, a_missing_wind_is_named_with_its_key) {
  expect_all(complaint_about(good_scene_but("[integrator]",
                                            "[air]\nprofile = \"none.csv\"\n[integrator]")),
             {"none.csv", "air.profile", "No such file"});
}

TEST(WrongScenes, a_missing_chain_file_is_named_with_its_key) {
  expect_all(complaint_about("[run]\nend_time = 1\n[chain]\nfile = \"none.csv\"\n"),
             {"none.csv", "chain.file", "No such file"});
}

/// The good scene of another fluid, by an explicit method.
std::string explicit_scene(const std::string& modulus, const std::string& viscosity,
                           const std::string& method = "dormand-prince") {
  return complaint_about(good_scene, {"viscoelasticity.elastic_modulus=" + modulus,
                                      "viscoelasticity.viscosity=" + viscosity,
                                      "integrator.method=" + method});
}

TEST(StiffScenes, are_refused_to_explicit_methods_with_the_term_its_rate_and_the_way_out) {
  expect_all(explicit_scene("1e9", "1e-3"),
             {"integrator.method = \"dormand-prince\"", "relaxes at G/mu = 1e+12 1/s",
              "3.3e-12 s", "3.0e+09", "\"auto\""});
  expect_all(explicit_scene("1e9", "2"), {"G/mu = 5e+08 1/s", "6.6e-09 s"});
  expect_all(
      complaint_about(good_scene, {"nozzle.link_length=1e-8", "nozzle.radius=2.5e-9",
                                   "viscoelasticity=", "integrator.method=dormand-prince"}),
      {"surface tension moves links of 1e-08 m", "1e+10 1/s"});
  expect_all(
      complaint_about(good_scene, {"nozzle.link_length=1e-8", "nozzle.radius=2.5e-9",
                                   "viscoelasticity.elastic_modulus=1e9",
                                   "viscoelasticity.viscosity=1e4",
                                   "surface_tension=", "integrator.method=dormand-prince"}),
      {"elastic waves turn links of 1e-08 m around at 2.18e+11 1/s"});
}

TEST(StiffScenes, are_run_by_the_other_methods_and_if_it_takes_a_while_by_explicit_ones) {
  for (const std::string method : {"auto", "ros34pw2"})
    EXPECT_EQ(explicit_scene("1e9", "1e-3", method), "(accepted)") << method;
  EXPECT_EQ(explicit_scene("5e4", "1e-3"), "(accepted)"); // 6e-8 s, 2e5 steps
  EXPECT_EQ(explicit_scene("5e3", "2"), "(accepted)");
  EXPECT_EQ(explicit_scene("0", "2"), "(accepted)");
  // Whoever fixes the step knows it.
  EXPECT_EQ(complaint_about(
                good_scene_but("rtol = 1e-5", "method = \"rk4\"\nstep = 1e-8"),
                {"viscoelasticity.elastic_modulus=1e9", "viscoelasticity.viscosity=1e-3"}),
            "(accepted)");
}

} // namespace
} // namespace ehdjet
