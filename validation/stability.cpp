// Over which fluids is each method stable with long steps, and what does a given accuracy cost?
//
// Twelve beads of the PVP jet, over viscosity and modulus: the largest fixed step that stays
// bounded against linear theory, and the right-hand sides for an error of 1e-2 and 1e-4 link
// lengths. In full also shorter links, other charges and fields. Writes stability.csv and
// stability.md.

#include "ehdjet/scene/stability.hpp"

#include "ehdjet/integrators/make_integrator.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include "support/scenes.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;
using namespace ehdjet::test;
namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t most_evaluations = 200'000;
const std::vector<std::string> methods{"rk4", "dormand-prince", "ros34pw2", "auto"};

struct Point {
  double viscosity, modulus;             // [Pa s], [Pa]
  double link_length = pvp::link_length; // [m]; the radius is a quarter of it
  double charge = 1;                     // over that of the PVP fluid
  double field = 56250;                  // [V/m]

  [[nodiscard]] bool in_main_slice() const {
    return link_length == pvp::link_length && charge == 1 && field == 56250;
  }
  [[nodiscard]] std::string name() const {
    return fmt::format("mu {:g} G {:g} l {:g} charge {:g} field {:g}", viscosity, modulus,
                       link_length, charge, field);
  }
};

// --- scenes

/// The golden chain, held at bead 0, scaled to the point's links, with its fluid and charges.
Scene zig_zag(const Point& p) {
  static const Scene golden = GoldenChain("held").scene;
  Scene scene = golden;
  const double s = p.link_length / pvp::link_length;
  ChainBeads& b = scene.chain;
  for (std::size_t k = 0; k < b.size(); ++k) {
    b.x[k] *= s, b.y[k] *= s, b.z[k] *= s;
    b.volume[k] *= s * s * s, b.mass[k] *= s * s * s;
    b.charge[k] *= p.charge * s * s * s;
  }
  scene.config.viscoelasticity = ViscoelasticityConfig{p.modulus, p.viscosity};
  scene.config.field = FieldConfig{.potential = {}, .strength = p.field};
  return scene;
}

/// A jet is moved by charge, whose rates do not depend on the scale, and by surface tension, whose
/// rates grow as links become shorter. The time is shorter where surface tension is faster [s].
double duration(const Point& p) {
  const Scene pvp_jet = zig_zag({.viscosity = 2, .modulus = 5e3});
  const double charges =
      *chain_rates(pvp_jet.config, link_state(pvp_jet, 1)).coulomb; // of charge 1
  const Scene scene = zig_zag(p);
  const ChainRates rates = chain_rates(scene.config, link_state(scene, 1));
  return 1e-4 * std::min(1.0, charges / *rates.surface_tension);
}

/// Pseudo-random numbers between -1 and 1.
double noise(std::size_t i) {
  return std::sin(12.9898 * static_cast<double>((i + 1) * (i + 1)));
}

enum class Modes { longitudinal, uncharged };

/// A straight chain between two held beads with noise that is small enough for linear theory.
/// Charges make bends grow in reality and with every method. With charges the noise is therefore
/// along the chain only.
Scene straight_chain(const Point& p, Modes modes) {
  Scene scene = zig_zag(p);
  scene.config.chain->fixed = FixedEnds::both;
  scene.config.field.reset();
  if (modes == Modes::uncharged) scene.config.coulomb.reset();
  const double l = p.link_length;
  ChainBeads& b = scene.chain;
  for (std::size_t k = 0; k < b.size(); ++k) {
    const bool held = k == 0 || k + 1 == b.size();
    b.x[k] = l * (static_cast<double>(k) + (held ? 0 : 1e-6 * noise(k)));
    const bool bends = modes == Modes::uncharged && !held;
    b.y[k] = bends ? 1e-6 * l * noise(k + 100) : 0;
    b.z[k] = bends ? 1e-6 * l * noise(k + 200) : 0;
    b.vx[k] = b.vy[k] = b.vz[k] = 0;
    stresses(b)[k] = 1e-9 * p.modulus * noise(k + 300);
  }
  return scene;
}

// --- the largest stable step

constexpr double longest_step = 0.01; // that is tried [s]

struct Unbounded {};

/// Ends a run whose links or stresses are impossible in a chain between held beads.
void require_bounded(const JetState& jet, const Point& p) {
  const auto c = jet.columns();
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    const double l = (c.position()[k] - c.position()[k - 1]).norm() / p.link_length;
    const bool bounded = l > 1. / 3 && l < 3 && std::abs(stress_of(c)[k]) < 10 * p.modulus;
    if (!bounded) throw Unbounded{};
  }
}

bool stays_bounded(const Point& p, Modes modes, const std::string& method, double step) {
  constexpr double steps = 1000;
  Scene scene = straight_chain(p, modes);
  integrate_with_fixed_steps(scene, method, step);
  const auto simulation = build_simulation(scene);
  simulation->after_each_step([&](const Simulation& s) { require_bounded(s.jet(), p); });
  try {
    simulation->run_until(steps * step);
  } catch (const Unbounded&) {
    return false;
  } catch (const RunError&) { // beads run into each other, or a state is not a number
    return false;
  }
  return true;
}

/// To 5 %; `longest_step` if that is stable [s].
double largest_step(const Point& p, const std::string& method) {
  const auto stable = [&](double step) {
    return stays_bounded(p, Modes::uncharged, method, step)
           && (p.charge == 0 || stays_bounded(p, Modes::longitudinal, method, step));
  };
  constexpr double stride = 4, precision = 1.05, shortest = 1e-18;
  if (stable(longest_step)) return longest_step;
  double above = longest_step, below = above / stride;
  while (!stable(below) && below > shortest) above = below, below /= stride;
  while (above > precision * below) {
    const double middle = std::sqrt(above * below);
    (stable(middle) ? below : above) = middle;
  }
  return below;
}

/// Linear theory of an infinite straight chain, for explicit methods [s].
std::optional<StabilityLimits> theory(const Point& p, const std::string& method) {
  if (integration_method(method).kind != MethodKind::explicit_steps) return std::nullopt;
  const Scene scene = straight_chain(p, Modes::longitudinal);
  return step_limits(chain_rates(scene.config, link_state(scene, 1)),
                     butcher_tableau(method));
}

// --- what accuracy costs

struct TooMany {};

/// The jet at the end, and the number of its right-hand sides.
struct End {
  JetState jet;
  std::uint64_t evaluations = 0;
};
End run_within(const Scene& scene, double end_time, std::uint64_t most) {
  const auto simulation = build_simulation(scene);
  simulation->after_each_step([&](const Simulation& s) {
    if (s.statistics().evaluations > most) throw TooMany{};
  });
  simulation->run_until(end_time);
  return {simulation->jet(), simulation->statistics().evaluations};
}

/// |r - r_exact|_2 over the chain in link lengths.
double distance(const JetState& jet, const JetState& exact, const Point& p) {
  double squares = 0;
  for (std::size_t k = 0; k < jet.beads(); ++k)
    squares += (jet.columns().position()[k] - exact.columns().position()[k]).squaredNorm();
  return std::sqrt(squares) / p.link_length;
}

/// The accurate motion: Dormand-Prince 8(5,3) unless stability makes that too long, ROS34PW2 then.
struct Reference {
  explicit Reference(const Point& p) {
    const double end_time = duration(p);
    Scene scene = zig_zag(p);
    integrate(scene, "ros34pw2", 1e-9);
    jet = run_within(scene, end_time, 2'000'000).jet;
    const StabilityLimits limits = *theory(p, "dop853");
    if (end_time / limits.least() > 3e4) return;
    integrate(scene, "dop853", 1e-11);
    const JetState explicit_jet = run_within(scene, end_time, 2'000'000).jet;
    difference = distance(jet, explicit_jet, p);
    jet = explicit_jet;
  }
  JetState jet;
  std::optional<double> difference; // of the two methods, in link lengths
};

/// The first clause of a message, without where in the file it is.
std::string short_reason(std::string message) {
  if (const auto key = message.find("\": "); key != std::string::npos)
    message.erase(0, key + 3);
  message.resize(std::min(message.find_first_of(",;\n"), message.size()));
  return message;
}

/// A chain as a file, for as long as the object lives.
class ChainFile {
public:
  explicit ChainFile(const ChainBeads& b)
      : path_(fs::temp_directory_path()
              / fmt::format("ehdjet_stability_{}_{}.csv", getpid(),
                            static_cast<const void*>(this))) {
    std::ofstream out(path_);
    out << "x_m,y_m,z_m,volume_m3,mass_kg,charge_c\n";
    for (std::size_t k = 0; k < b.size(); ++k)
      out << fmt::format("{},{},{},{},{},{}\n", b.x[k], b.y[k], b.z[k], b.volume[k],
                         b.mass[k], b.charge[k]);
  }
  ChainFile(const ChainFile&) = delete;
  ChainFile& operator=(const ChainFile&) = delete;
  ~ChainFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  [[nodiscard]] std::string path() const { return path_.string(); }

private:
  fs::path path_;
};

/// Why a scene file with this method would be refused; empty if it would not.
std::string refusal(const Point& p, const std::string& method) {
  if (!integration_method(method).estimates_errors) return "";
  Scene scene = zig_zag(p);
  integrate(scene, method, 1e-4);
  scene.config.run.end_time = duration(p);
  const ChainFile file(scene.chain);
  scene.config.chain->file = file.path();
  try {
    (void)read_scene_text(resolved_toml(scene.config), "scene", fs::path());
  } catch (const InputError& e) {
    return short_reason(e.what());
  }
  return "";
}

struct Cost {
  std::optional<std::uint64_t> evaluations_1e2, evaluations_1e4;
  std::string refusal;
};

/// Settings that become ever more accurate: rtol, or a fixed step [s].
std::vector<double> settings(const Point& p, const std::string& method) {
  const bool adaptive = integration_method(method).estimates_errors;
  const double end_time = duration(p);
  std::vector<double> all;
  if (adaptive)
    for (int i = 4; i <= 20; ++i) all.push_back(std::pow(10, -0.5 * i));
  else
    for (int steps = 4; 4 * steps <= static_cast<int>(most_evaluations);
         steps = static_cast<int>(std::ceil(1.41 * steps)))
      all.push_back(end_time / steps);
  return all;
}

/// Least evaluations for an error. The next finer setting must keep the error, too, so that a lucky
/// result does not count.
std::optional<std::uint64_t>
evaluations_for(double error, const std::vector<std::pair<std::uint64_t, double>>& curve) {
  for (std::size_t i = 0; i + 1 < curve.size(); ++i)
    if (curve[i].second <= error && curve[i + 1].second <= error) return curve[i].first;
  return std::nullopt;
}

Cost cost(const Point& p, const std::string& method, const Reference& exact) {
  Cost c;
  c.refusal = refusal(p, method);
  if (!c.refusal.empty()) return c;
  std::vector<std::pair<std::uint64_t, double>> curve; // evaluations, error
  std::string stopped = fmt::format("more than {} evaluations", most_evaluations);
  for (const double setting : settings(p, method)) {
    Scene scene = zig_zag(p);
    integrate(scene, method, setting);
    try {
      const End end = run_within(scene, duration(p), most_evaluations);
      curve.emplace_back(end.evaluations, distance(end.jet, exact.jet, p));
    } catch (const TooMany&) {
      break;
    } catch (const RunError& e) { // a finer setting may not fail
      if (curve.empty()) stopped = short_reason(e.what());
      curve.emplace_back(0, infinity);
    }
    c.evaluations_1e4 = evaluations_for(1e-4, curve);
    if (c.evaluations_1e4) break;
  }
  c.evaluations_1e2 = evaluations_for(1e-2, curve);
  if (!c.evaluations_1e4) c.refusal = stopped;
  return c;
}

// --- the map

struct Row {
  std::string method;
  std::optional<double> largest;
  std::optional<StabilityLimits> theory;
  Cost cost;
};
struct Measured {
  Point point{};
  std::vector<Row> rows; // as in `methods`
  std::optional<double> reference_difference;
};

Measured measure(const Point& p) {
  Measured m{.point = p, .rows = {}, .reference_difference = {}};
  const Reference exact(p);
  m.reference_difference = exact.difference;
  for (const std::string& method : methods) {
    Row row{.method = method,
            .largest = {},
            .theory = theory(p, method),
            .cost = cost(p, method, exact)};
    if (method != "auto") row.largest = largest_step(p, method);
    m.rows.push_back(row);
  }
  return m;
}

void write(Csv& csv, const Measured& m) {
  for (const Row& r : m.rows) {
    const Point& p = m.point;
    const double limit =
        r.theory ? r.theory->least() : std::numeric_limits<double>::quiet_NaN();
    csv.row(r.method, p.viscosity, p.modulus, p.link_length, p.charge, p.field, r.largest,
            limit, r.cost.evaluations_1e2, r.cost.evaluations_1e4, r.cost.refusal);
  }
}

std::vector<Point> main_slice(const Suite& suite) {
  std::vector<Point> all;
  if (suite.quick())
    for (const double mu : {1e-3, 1.0, 1e4})
      for (const double g : {1.0, 1e3, 1e6, 1e9})
        all.push_back({.viscosity = mu, .modulus = g});
  else
    for (int mu = -3; mu <= 4; ++mu)
      for (int g = 0; g <= 9; ++g)
        all.push_back({.viscosity = std::pow(10, mu), .modulus = std::pow(10, g)});
  return all;
}

/// Points that change one parameter at a time.
std::vector<Point> other_slices() {
  std::vector<Point> all;
  for (const double mu : {1e-3, 1.0, 1e4})
    for (const double g : {1.0, 5e3, 1e9}) {
      const Point p{.viscosity = mu, .modulus = g};
      for (const double l : {1e-8, 1e-6, 1e-5})
        all.push_back(p), all.back().link_length = l;
      for (const double q : {0.0, 10.0}) all.push_back(p), all.back().charge = q;
      for (const double e : {0.0, 1e6}) all.push_back(p), all.back().field = e;
    }
  return all;
}

std::vector<double> sorted(const std::vector<Measured>& map, double Point::*member) {
  std::vector<double> values;
  for (const Measured& m : map)
    if (m.point.in_main_slice()) values.push_back(m.point.*member);
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::string cell(const std::vector<Measured>& map, double mu, double g,
                 std::size_t method) {
  for (const auto& [p, rows, difference] : map)
    if (p.in_main_slice() && p.viscosity == mu && p.modulus == g) {
      const Cost& c = rows[method].cost;
      return c.evaluations_1e4 ? fmt::format("{}", *c.evaluations_1e4) : c.refusal;
    }
  return "";
}

/// The main slice as a table to read.
void write_markdown(const fs::path& file, const std::vector<Measured>& map) {
  const auto moduli = sorted(map, &Point::modulus);
  std::string text = "# Right-hand sides for an error of 1e-4 link lengths\n\n"
                     "Twelve beads of the PVP jet over 0.1 ms; G in Pa, mu in Pa s.\n";
  for (std::size_t i = 0; i < methods.size(); ++i) {
    text += fmt::format("\n## {}\n\n| mu \\ G |", methods[i]);
    for (const double g : moduli) text += fmt::format(" {:g} |", g);
    text += "\n|---|";
    for (std::size_t j = 0; j < moduli.size(); ++j) text += "---:|";
    text += '\n';
    for (const double mu : sorted(map, &Point::viscosity)) {
      text += fmt::format("| {:g} |", mu);
      for (const double g : moduli) text += fmt::format(" {} |", cell(map, mu, g, i));
      text += '\n';
    }
  }
  std::ofstream out(file);
  out << text << std::flush;
  if (!out) throw RunError(fmt::format("cannot write {}", file.string()));
}

// --- checks

/// Where the fluid alone limits rk4.
void check_theory(Suite& suite, const std::vector<Measured>& map) {
  double least = infinity, largest = 0;
  for (const Measured& m : map) {
    const Row& rk4 = m.rows.front();
    const StabilityLimits& t = *rk4.theory;
    const double others =
        std::min(t.coulomb.value_or(infinity), t.surface_tension.value_or(infinity));
    if (*t.viscoelastic > others / 3) continue;
    least = std::min(least, *rk4.largest / *t.viscoelastic);
    largest = std::max(largest, *rk4.largest / *t.viscoelastic);
  }
  suite.check_at_least("rk4 largest step over theory", least, 0.9);
  suite.check_at_most("rk4 largest step over theory", largest, 1.3);
}

void check_costs(Suite& suite, const std::vector<Measured>& map) {
  std::vector<double> refused(methods.size()), worst(methods.size());
  for (const Measured& m : map)
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const Cost& c = m.rows[i].cost;
      if (!c.refusal.empty()) ++refused[i];
      if (m.point.in_main_slice())
        worst[i] =
            std::max(worst[i], c.evaluations_1e2 ? static_cast<double>(*c.evaluations_1e2)
                                                 : infinity);
    }
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (methods[i] != "ros34pw2" && methods[i] != "auto") continue;
    suite.check_at_most(methods[i] + " refusals", refused[i], 0);
    suite.check_at_most(methods[i] + " evaluations for 1e-2", worst[i],
                        methods[i] == "auto" ? 360 : 210); // twice what was measured
  }
}

/// The choice of method against the better one of the two that it chooses from.
void check_choice(Suite& suite, const std::vector<Measured>& map) {
  const auto evaluations = [](const Measured& m, std::string_view method) {
    for (const Row& r : m.rows)
      if (r.method == method && r.cost.evaluations_1e4)
        return static_cast<double>(*r.cost.evaluations_1e4);
    return infinity;
  };
  double worst = 0;
  for (const Measured& m : map)
    worst = std::max(worst, evaluations(m, "auto")
                                / std::min(evaluations(m, "dormand-prince"),
                                           evaluations(m, "ros34pw2")));
  suite.check_at_most("auto evaluations for 1e-4 over the better method", worst, 3);
}

void check_references(Suite& suite, const std::vector<Measured>& map) {
  double worst = 0;
  for (const Measured& m : map) worst = std::max(worst, m.reference_difference.value_or(0));
  suite.check_at_most("explicit and implicit reference differ [links]", worst, 1e-5);
}

struct Golden {
  Point point;
  double most; // evaluations for 1e-4
};
const std::vector<Golden> golden_cases{{{.viscosity = 2, .modulus = 1e9}, 150},
                                       {{.viscosity = 1e-3, .modulus = 5e4}, 150},
                                       {{.viscosity = 1e4, .modulus = 1e9}, 2500}};

void check_golden_case(Suite& suite, const Golden& golden) {
  const auto n = cost(golden.point, "ros34pw2", Reference(golden.point)).evaluations_1e4;
  suite.check_at_most("ros34pw2 evaluations for 1e-4 " + golden.point.name(),
                      n ? static_cast<double>(*n) : infinity, golden.most);
}

void answer(Suite& suite) {
  Csv csv = suite.csv("stability.csv",
                      "method,viscosity_pa_s,modulus_pa,link_length_m,charge_factor,"
                      "field_v_per_m,largest_step_s,theory_step_s,evaluations_1e2,"
                      "evaluations_1e4,refusal");
  std::vector<Point> points = main_slice(suite);
  if (suite.full())
    for (const Point& p : other_slices()) points.push_back(p);
  suite.plan(static_cast<double>(points.size()));
  (void)zig_zag(points.front()); // reads the chain before there are threads

  std::vector<Measured> map(points.size());
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < points.size(); ++i)
    jobs.emplace_back([&, i] {
      map[i] = measure(points[i]);
      suite.done(1, points[i].name());
    });
  in_parallel(jobs);

  for (const Measured& m : map) write(csv, m);
  write_markdown(suite.folder() / "stability.md", map);
  check_theory(suite, map);
  check_costs(suite, map);
  check_choice(suite, map);
  check_references(suite, map);
  for (const Golden& golden : golden_cases) check_golden_case(suite, golden);
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "stability",
                     "Stable steps and costs of each method over the fluids", answer);
}
