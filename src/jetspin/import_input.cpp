#include "ehdjet/jetspin/import_input.hpp"

#include "ehdjet/core/constants.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>

#include "directives.hpp"
#include "scene_lines.hpp"

namespace ehdjet {
namespace {

/// A unit of JETSPIN: a number of them times `times` over `over` is in SI units. Both factors are whole
/// numbers where they can be, so that 0.005 cm become 5e-05 m to the last digit.
struct Unit {
  std::string_view name;
  double times = 1, over = 1;

  [[nodiscard]] double in_si(double value) const { return value * times / over; }
};
constexpr Unit pure{""}, second{"s"}, per_second{"1/s"}, radian{"rad"}, kelvin{"K"},
    volt{"V"};
constexpr Unit centimetre{"cm", 1, 100}, centimetre_per_second{"cm/s", 1, 100};
constexpr Unit gram_per_cm3{"g/cm^3", 1000}, dyn_per_cm{"dyn/cm", 1, 1000};
constexpr Unit dyn_per_cm2{"dyn/cm^2", 1, 10}, poise{"P", 1, 10}, stokes{"cm^2/s", 1, 1e4};
constexpr Unit statcoulomb_per_cm3{"statC/cm^3", 1e6, constants::statcoulomb_per_coulomb};
constexpr Unit coulomb_per_litre{"C/L", 1000};
constexpr Unit statvolt{"statV", constants::volt_per_statvolt};

/// Of water: p_sat in Pa at t degrees Celsius, the polynomial that JETSPIN takes from Seaver, Galloway and
/// Manuccia, Rev. Sci. Instrum. 60 (1989) 3452.
double saturation_pressure(double celsius) {
  constexpr std::array coefficients{6.107799961,    4.436518521e-1, 1.428945805e-2,
                                    2.650648731e-4, 3.031240396e-6, 2.034080948e-8,
                                    6.136820929e-11};
  double mbar = 0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c)
    mbar = mbar * celsius + *c;
  return 100 * mbar;
}

/// Vapour of water at a pressure and temperature [kg/m^3].
double vapour_density(double pressure, double temperature) {
  constexpr double molar_mass = 0.01801528, gas_constant = 8.314462618;
  return pressure * molar_mass / (gas_constant * temperature);
}

class Importer {
public:
  Importer(std::string_view text, const std::string& name,
           const JetspinImportOptions& options)
      : name_(name)
      , options_(options)
      , settings_(read_settings(text, name))
      , remarks_(settings_.remarks) {}

  ImportedScene import() {
    for (const char* directive :
         {"system", "integrator", "timestep", "final time", "initial length",
          "nozzle cross", "density mass", "density charge", "viscosity", "elastic modulus",
          "collector distance"})
      if (!given(directive)) refuse(fmt::format("\"{}\" is missing", directive));
    const double system = number("system");
    if (system < 1 || system > 4)
      refuse_at("system", "must be 1 or 2 (a straight jet), 3 or 4");
    straight_ = system < 3;
    set_link_length();
    inserting_ = on("inserting"), removing_ = on("removing");

    write_head();
    if (inserting_)
      write_nozzle();
    else
      write_chain();
    write_plates();
    write_fluid();
    write_surface_tension();
    write_air();
    write_evaporation();
    write_refinement();
    write_steps();
    write_output();
    leave_out_noise();
    remark_unused();

    ImportedScene scene{{}, beads_, remarks_, lines_.origins()};
    if (!remarks_.empty()) {
      lines_.comment("");
      lines_.comment("Left out, or different from JETSPIN:");
      for (const std::string& r : remarks_) lines_.comment("* " + r);
    }
    scene.text = lines_.text();
    return scene;
  }

private:
  // What the file says. A directive that somebody has asked for is used.

  const Setting* find(std::string_view directive) {
    const auto found = settings_.by_name.find(directive);
    if (found == settings_.by_name.end()) return nullptr;
    used_.insert(found->first);
    return &found->second;
  }
  bool given(std::string_view directive) const {
    return settings_.by_name.contains(directive);
  }
  double number(std::string_view directive, double otherwise = 0) {
    const Setting* setting = find(directive);
    return setting == nullptr ? otherwise : setting->values.front();
  }
  bool on(std::string_view directive) { return number(directive) != 0; }
  void need(std::string_view directive, std::string_view with) {
    if (!given(directive))
      refuse(fmt::format("\"{}\" is missing: \"{}\" needs it", directive, with));
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(fmt::format("{}: {}", name_, why));
  }
  [[noreturn]] void refuse_at(std::string_view directive, std::string_view why) const {
    const Setting& s = settings_.by_name.find(directive)->second;
    throw InputError(
        fmt::format("{}:{}: {}{}: {}", name_, s.line, directive, shown_value(s), why));
  }
  static std::string shown_value(const Setting& s) {
    switch (s.directive->given) {
    case Given::nothing:
      return {};
    case Given::yes:
      return " yes";
    case Given::no:
      return " no";
    case Given::choice:
      return fmt::format(" {}", s.directive->keywords.back());
    default:
      break;
    }
    std::string text;
    for (const double v : s.values) fmt::format_to(std::back_inserter(text), " {}", v);
    return text;
  }
  /// "line 12: nozzle cross 0.005 cm"
  std::string origin(std::string_view directive, const Unit& unit = pure) const {
    const auto found = settings_.by_name.find(directive);
    if (found == settings_.by_name.end()) return fmt::format("{} is not given", directive);
    return fmt::format("line {}: {}{}{}{}", found->second.line, directive,
                       shown_value(found->second), unit.name.empty() ? "" : " ", unit.name);
  }
  void remark(std::string_view directive, std::string_view what) {
    remarks_.push_back(fmt::format("{}: {}", origin(directive), what));
  }

  // What the scene says.

  void key(std::string_view key, double value, const std::string& origin) {
    lines_.key(key, toml_text(value), origin);
  }
  void key(std::string_view key, std::string_view value, const std::string& origin) {
    lines_.key(key, toml_text(value), origin);
  }
  /// Returns the value in SI units.
  double key_from(std::string_view key, std::string_view directive, const Unit& unit,
                  double otherwise = 0) {
    const double value = unit.in_si(number(directive, otherwise));
    this->key(key, value, origin(directive, unit));
    return value;
  }

  bool real_units() { return on("units"); }

  void set_link_length() {
    const double length = number("initial length");
    if (given("points") == given("resolution"))
      refuse(given("points")
                 ? "both \"points\" and \"resolution\" are given: remove one"
                 : "neither \"points\" nor \"resolution\" is given: one of them is needed");
    // With a resolution, as many links of equal length as come nearest to it.
    links_ = number("points", std::round(length / number("resolution", 1)));
    const char* directive = given("points") ? "points" : "resolution";
    if (!(links_ >= 1 && links_ <= most_links))
      refuse_at(directive, fmt::format("a jet of {} links; from 1 to {} can be imported",
                                       links_, most_links));
    link_length_ = centimetre.in_si(length) / links_;
    link_origin_ = origin("initial length", centimetre) + ", " + origin(directive);
  }

  void write_head() {
    lines_.comment("From a JETSPIN input file, in SI units. Comments say from which line "
                   "and directive a");
    lines_.comment("value comes, in the units of that file.");
    lines_.comment("");
    lines_.key("title", "\"JETSPIN input\"", "not from the file");
    lines_.table("run");
    key_from("end_time", "final time", second);
  }

  void write_charge_density() {
    key_from("charge_density", "density charge",
             real_units() ? coulomb_per_litre : statcoulomb_per_cm3);
  }

  void write_nozzle() {
    lines_.table("nozzle");
    key_from("radius", "nozzle cross", centimetre);
    key("link_length", link_length_, link_origin_);
    key_from("velocity", "nozzle velocity", centimetre_per_second);
    key_from("density", "density mass", gram_per_cm3);
    write_charge_density();
    const bool moves = on("perturb");
    if (moves) {
      need("perturb freq", "perturb yes"), need("perturb ampl", "perturb yes");
      if (straight_)
        remark("perturb", "a straight jet has a nozzle at rest");
      else {
        key_from("amplitude", "perturb ampl", centimetre);
        key_from("angular_frequency", "perturb freq", Unit{"rad/s"});
        key("phase", number("perturb phase"),
            given("perturb phase") ? origin("perturb phase", radian)
                                   : "JETSPIN draws it at random");
      }
    }
    const bool half = number("dragvel", 1) != 0;
    key("insertion_velocity", half ? "half" : "nozzle",
        given("dragvel")
            ? origin("dragvel")
            : "dragvel is not given; versions after 1.21 take \"nozzle\" then");
    if (links_ > 1)
      remark(given("points") ? "points" : "resolution",
             fmt::format("the jet starts with one link of {} m, not with {} of them",
                         link_length_, links_));
    if (number("nozzle stress") != 0)
      remark("nozzle stress",
             "beads start without stress; in JETSPIN only the first one has it");
  }

  /// Bead 0 is the nozzle, the others are on the axis.
  void write_chain() {
    if (on("perturb"))
      refuse_at("perturb", "the end of a chain (\"inserting no\") rests in ehdjet. Give "
                           "\"inserting yes\", or "
                           "remove it");
    lines_.table("chain");
    const std::string from = origin("inserting") + ": the beads are given; " + link_origin_;
    key("file", options_.beads_file, from);
    key("fixed", "first", "the nozzle");
    const double radius = centimetre.in_si(number("nozzle cross"));
    const double volume = std::numbers::pi * radius * radius * link_length_;
    const double mass = gram_per_cm3.in_si(number("density mass")) * volume;
    const double charge = (real_units() ? coulomb_per_litre : statcoulomb_per_cm3)
                              .in_si(number("density charge"))
                          * volume;
    const double velocity = centimetre_per_second.in_si(number("nozzle velocity"));
    const double stress = dyn_per_cm2.in_si(number("nozzle stress"));
    auto out = std::back_inserter(beads_);
    fmt::format_to(out, "# {}\n", from);
    for (const auto& [directive, unit] :
         {std::pair{"nozzle cross", centimetre},
          {"density mass", gram_per_cm3},
          {"density charge", real_units() ? coulomb_per_litre : statcoulomb_per_cm3},
          {"nozzle velocity", centimetre_per_second},
          {"nozzle stress", dyn_per_cm2}})
      fmt::format_to(out, "# {}\n", origin(directive, unit));
    fmt::format_to(out, "bead,x_m,y_m,z_m,vx_m_s,mass_kg,charge_c,volume_m3,stress_pa\n");
    for (std::size_t k = 0; k <= static_cast<std::size_t>(links_); ++k)
      fmt::format_to(out, "{},{},0,0,{},{},{},{},{}\n", k,
                     static_cast<double>(k) * link_length_, velocity, mass, charge,
                     k == 0 ? 0 : volume, k == 0 ? 0 : stress);
    if (const Setting* s = find("dragvel"); s != nullptr)
      remark("dragvel", "no bead is inserted");
  }

  void write_plates() {
    const double distance = centimetre.in_si(number("collector distance"));
    const Unit unit = real_units() ? volt : statvolt;
    if (removing_) {
      lines_.table("collector");
      key("distance", distance, origin("collector distance", centimetre));
      key("charge", "grounded",
          "JETSPIN from 1.2 on keeps the last landed bead's: \"kept\"");
    }
    if (given("external potential vector"))
      refuse_at("external potential vector",
                "ehdjet's field is along x. Give \"external potential\"");
    if (given("external potential")) {
      lines_.table("field");
      const std::string from = origin("external potential", unit);
      const double potential = unit.in_si(number("external potential"));
      if (removing_)
        key("potential", potential, from);
      else // no collector: the beads fly on
        key("strength", potential / distance,
            from + ", " + origin("collector distance", centimetre));
      write_waveform();
    }
    if (on("gravity")) {
      lines_.table("gravity");
      key("acceleration", constants::standard_gravity, origin("gravity"));
    }
    lines_.table("coulomb");
    key("solver", "auto", "JETSPIN sums all pairs, or has a cut-off");
  }

  void write_waveform() {
    const double type = number("external potential type");
    if (type == 0) return;
    need("external potential freq", "external potential type");
    const double frequency = number("external potential freq");
    if (type == 1) {
      key("waveform", "square", origin("external potential type"));
      key_from("frequency", "external potential freq", per_second);
    } else if (type == 2) {
      need("external potential time", "external potential type 2");
      if (number("final time") * frequency > 0.5)
        refuse_at("external potential type",
                  fmt::format("the field of an RC circuit that is switched off after {} s; "
                              "ehdjet's rises once",
                              0.5 / frequency));
      key("waveform", "rc", origin("external potential type"));
      key_from("time_constant", "external potential time", second);
    } else
      refuse_at("external potential type",
                type == 3 ? "ehdjet has no rotating field" : "must be 0, 1, 2 or 3");
  }

  void write_fluid() {
    lines_.table("viscoelasticity");
    const bool kelvin_voigt = on("kvfluid"), herschel_bulkley = on("hbfluid");
    if (kelvin_voigt && herschel_bulkley)
      refuse_at("kvfluid", "hbfluid is on, too: remove one");
    const double yield = number("yield stress");
    if (kelvin_voigt) {
      key("model", "kelvin-voigt", origin("kvfluid"));
      remark(
          "kvfluid",
          "the stress is G ln(l/l0) + mu e; JETSPIN's rate of it leaves a term in e^2 out");
      if (yield != 0) refuse_at("yield stress", "a Kelvin-Voigt body has none");
    } else if (herschel_bulkley || yield != 0) {
      key("model", "herschel-bulkley",
          origin(herschel_bulkley ? "hbfluid" : "yield stress"));
    }
    key_from("elastic_modulus", "elastic modulus", dyn_per_cm2);
    const double viscosity = key_from("viscosity", "viscosity", poise);
    if (kelvin_voigt || !(herschel_bulkley || yield != 0)) return;
    if (herschel_bulkley) {
      need("hbfluid consistency", "hbfluid yes"), need("hbfluid index", "hbfluid yes");
      key("consistency", viscosity * number("hbfluid consistency"),
          origin("hbfluid consistency") + " viscosities");
      key_from("flow_index", "hbfluid index", pure);
    } else {
      key("consistency", viscosity, origin("viscosity", poise));
      key("flow_index", 1., "a Maxwell fluid with a yield stress");
    }
    if (yield == 0) return;
    key_from("yield_stress", "yield stress", dyn_per_cm2);
    key("regularization", 1., "JETSPIN has none");
    remark("yield stress", "opposes the motion, and is full beyond a strain rate of 1/s; "
                           "JETSPIN's always pulls");
  }

  void write_surface_tension() {
    if (!given("surface tension")) return;
    if (straight_) {
      remark("surface tension", "a straight jet has no curvature");
      find("surface tension");
      return;
    }
    lines_.table("surface_tension");
    key_from("coefficient", "surface tension", dyn_per_cm);
    key("form", "paper", "the force of JETSPIN");
  }

  void write_air() {
    if (!on("airdrag")) return;
    need("airdrag airdensity", "airdrag yes"), need("airdrag airviscosity", "airdrag yes");
    lines_.table("air");
    key_from("density", "airdrag airdensity", gram_per_cm3);
    key_from("kinematic_viscosity", "airdrag airviscosity", stokes);
    if (const double u = centimetre_per_second.in_si(number("airdrag airvelocity")); u != 0)
      lines_.key("velocity", fmt::format("[{}, 0, 0]", toml_text(u)),
                 origin("airdrag airvelocity", centimetre_per_second));
    key("drag", "tangential",
        "JETSPIN's law. The largest drag is across the jet: \"anisotropic\"");
    lines_.key("lift", straight_ ? "false" : "true", "JETSPIN has it on a curved jet");
    remark("airdrag", "the drag of each link has its own radius, volume and direction; "
                      "JETSPIN's has those at the nozzle");
  }

  void write_evaporation() {
    if (!on("evaporation")) return;
    if (!on("airdrag"))
      refuse_at("evaporation",
                "a jet dries in air: give airdrag yes, airdensity and airviscosity");
    for (const char* directive :
         {"evaporation polymer frac", "evaporation temperature", "evaporation umidity",
          "evaporation bconst", "evaporation mconst"})
      need(directive, "evaporation yes");
    if (number("evaporation tconst", 1) != 1)
      refuse_at("evaporation tconst",
                "ehdjet's relaxation time grows like the polymer fraction: 1");
    const double temperature = number("evaporation temperature");
    const double pressure = saturation_pressure(temperature - 273.15);
    constexpr double atmosphere = 101325; // JETSPIN's ratio is to it [Pa]
    lines_.table("evaporation");
    for (const char* density : {"solvent_density", "polymer_density"})
      key_from(density, "density mass", gram_per_cm3);
    key_from("polymer_fraction", "evaporation polymer frac", pure);
    key_from("diffusivity", "evaporation diffusivity", stokes,
             0.211 * std::pow(temperature / 273.15, 1.94));
    const bool ratio = given("evaporation relumidity");
    key("saturation",
        vapour_density(ratio ? number("evaporation relumidity") * atmosphere : pressure,
                       temperature),
        ratio ? origin("evaporation relumidity") + " times 1 atm, water"
              : origin("evaporation temperature", kelvin) + ", water");
    key_from("humidity", "evaporation umidity", pure);
    key("still_air_sherwood", 0., "JETSPIN has none");
    key_from("viscosity_exponent", "evaporation bconst", pure);
    key_from("viscosity_power", "evaporation mconst", pure);
    remark("evaporation", "the vapour has its density; JETSPIN takes the ratio of the "
                          "saturation pressure to that of the air "
                          "instead of the ratio of the densities of vapour and solvent, "
                          "and dries some thousand times faster");
    if (const double nu = number("evaporation airviscosity"),
        of_drag = number("airdrag airviscosity");
        given("evaporation airviscosity") && nu != of_drag)
      remark("evaporation airviscosity",
             fmt::format("the air has one viscosity, that of airdrag: {} cm^2/s", of_drag));
  }

  void write_refinement() {
    if (!on("dynam refin")) return;
    need("dynam refin threshold", "dynam refin yes"),
        need("dynam refin every", "dynam refin yes");
    lines_.table("refinement");
    key_from("length", "dynam refin threshold", centimetre);
    key_from("interval", "dynam refin every", second);
    remark(
        "dynam refin",
        "keeps mass, charge and volume; JETSPIN up to 1.21 loses some at each refinement");
    if (number("dynam refin start") != 0)
      remark("dynam refin start", "ehdjet refines from the beginning");
    if (number("dynam refin anchor") != 0)
      remark("dynam refin anchor", "no bead is kept in its place");
  }

  void write_steps() {
    constexpr std::array methods{"euler", "heun", "rk4", "heun"};
    const double integrator = number("integrator");
    if (integrator < 1 || integrator > 4)
      refuse_at("integrator", "must be 1 (Euler), 2 (Heun), 3 (Runge-Kutta) or 4 (Platen)");
    const char* method = methods.at(static_cast<std::size_t>(integrator) - 1);
    const std::string like = integrator == 4 ? ": Platen's, without noise" : "";
    lines_.table("integrator");
    if (options_.fixed_steps) {
      key("method", method, origin("integrator") + like);
      key_from("step", "timestep", second);
      key("events", "step-end", "beads are inserted and land at the ends of steps");
      return;
    }
    key("rtol", 1e-6, "steps with error control, for JETSPIN's fixed ones:");
    lines_.comment(
        fmt::format("  {}{}: method = \"{}\"", origin("integrator"), like, method));
    lines_.comment(fmt::format("  {}: step = {}, events = \"step-end\"",
                               origin("timestep", second), toml_text(number("timestep"))));
  }

  void write_output() {
    constexpr double rows_without_interval = 1000; // steps
    lines_.table("output");
    if (given("print time"))
      key_from("observables", "print time", second);
    else
      key("observables", rows_without_interval * number("timestep"),
          "print time is not given: 1000 times the timestep");
    for (const char* directive : {"print xyz", "print xyz frame", "print pdb frame"})
      if (given(directive)) {
        key_from("frames", directive, second);
        break;
      }
    if (removing_) lines_.key("deposit", "true", origin("removing"));
  }

  /// Random forces on the beads: of turbulent air, and of JETSPIN's noise.
  void leave_out_noise() {
    for (const auto& [force, strength] :
         {std::pair{"airdrag", "airdrag amplitude"}, {"noise", "noise diffusivity"}}) {
      if (!on(force) || number(strength) == 0) continue;
      if (!options_.without_noise)
        refuse_at(
            strength,
            "ehdjet has no random force. Import with --without-noise to leave it out");
      remark(strength, "the random force is left out");
    }
  }

  void remark_unused() {
    std::vector<const Setting*> unused;
    for (const auto& [name, setting] : settings_.by_name)
      if (!used_.contains(name) && setting.directive->given != Given::no)
        unused.push_back(&setting);
    std::ranges::sort(unused, {}, &Setting::line);
    for (const Setting* s : unused)
      remark(s->directive->name(), s->directive->left_out.empty() ? "has no effect here"
                                                                  : s->directive->left_out);
  }

  static constexpr double most_links = 1e6;

  const std::string& name_;
  const JetspinImportOptions& options_;
  Settings settings_;
  std::set<std::string, std::less<>> used_;
  std::vector<std::string> remarks_;
  SceneLines lines_;
  std::string beads_, link_origin_;
  double links_ = 0, link_length_ = 0; // link_length_ [m]
  bool straight_ = false, inserting_ = false, removing_ = false;
};

} // namespace

ImportedScene import_jetspin(std::string_view text, const std::string& name,
                             const JetspinImportOptions& options) {
  return Importer(text, name, options).import();
}

void check_imported(const ImportedScene& scene, const std::string& name,
                    const std::filesystem::path& folder) {
  try {
    static_cast<void>(read_scene_text(scene.text, name + " as a scene", folder));
  } catch (const InputError& e) {
    std::string why = e.what();
    for (const auto& [key, origin] : scene.origins)
      if (std::string_view(e.what()).find(key + " ") != std::string_view::npos)
        why += fmt::format(". {} is from {}", key, origin);
    throw InputError(why);
  }
}

} // namespace ehdjet
