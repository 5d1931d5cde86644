// Does a drying jet do what has been observed?
//
// The jet of scenes/fibre.toml and a sweep of voltage, flow rate, current and humidity around it, against
// published observations: growth of the bending, laying speed, the terminal radius over the length of the
// straight jet, and the diameter at which surface charge stops the thinning. Where the jet does not agree
// the number says so. Also the spread over what should not matter: lengths of links and tolerance. Writes
// experiments.csv and agreement.csv.

#include "ehdjet/observers/dry_fibre.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "support/jets.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

/// Slope of y over x by least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    sx += x[i], sy += y[i], sxx += x[i] * x[i], sxy += x[i] * y[i];
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// What a jet looks like at one instant.
struct Shape {
  double straight =
      0; ///< from the nozzle to where it first runs at 15 degrees to its axis [m]
  double envelope = 0; ///< largest distance from the axis [m]
  double growth =
      0; ///< of the distance from the axis before that, over the time of flight [1/s]
};

Shape shape_of(const JetSnapshot& s) {
  constexpr double inclined = 15 * std::numbers::pi / 180;
  const auto r = s.columns.position(), v = s.columns.velocity();
  Shape shape;
  double flight = 0; // to that bead, in a jet that is stationary [s]
  std::vector<double> times, logarithms;
  for (std::size_t k = s.jet.first() + 1; k < s.columns.beads; ++k) {
    const Vec3 link = r[k] - r[k - 1];
    const double off_axis = std::hypot(r[k].y(), r[k].z());
    shape.envelope = std::max(shape.envelope, off_axis);
    if (shape.straight > 0) continue;
    flight += link.norm() / std::max(v[k].norm(), 1e-3);
    if (std::acos(std::clamp(link.x() / link.norm(), -1.0, 1.0)) > inclined)
      shape.straight = r[k].x();
    else if (off_axis > 3e-5 && off_axis < 1e-3)
      times.push_back(flight), logarithms.push_back(std::log(off_axis));
  }
  if (times.size() >= 8) shape.growth = slope(times, logarithms);
  return shape;
}

struct Observed {
  double straight = 0, envelope = 0, growth = 0; // means
  double wet_radius = 0;                         // at the landing [m]
  std::optional<DryFibre::Summary> fibre;
  double beads = 0, path = 0, seconds = 0; // at the end [-], [m]; wall time
};

struct Case {
  std::string name;
  std::vector<std::string> set;
};

/// When a jet is looked at [s].
struct Window {
  double from, end;
  [[nodiscard]] double length() const { return end - from; }
};

class Landing final : public Observer {
public:
  explicit Landing(double from)
      : from_(from) {}
  void deposit(const DepositedBead& d) override {
    if (d.time >= from_) sum_ += d.landing_radius, ++count_;
  }
  [[nodiscard]] double mean() const { return count_ > 0 ? sum_ / count_ : 0; }

private:
  double from_, sum_ = 0, count_ = 0;
};

Observed run(const Case& c, const Window& window) {
  const auto simulation = build_simulation(scene("fibre", c.set));
  const auto fibre = std::make_shared<DryFibre>(simulation->jet().table, window.from);
  const auto landing = std::make_shared<Landing>(window.from);
  Observed o;
  double looks = 0;
  simulation->add(fibre);
  simulation->add(landing);
  simulation->add(std::make_shared<Watch>(1e-3, [&](const JetSnapshot& s) {
    if (s.time < window.from) return;
    const Shape shape = shape_of(s);
    o.straight += shape.straight, o.envelope += shape.envelope, o.growth += shape.growth;
    looks += 1;
  }));
  simulation->run_until(window.end);
  o.straight /= looks, o.envelope /= looks, o.growth /= looks;
  o.fibre = fibre->summary(), o.wet_radius = landing->mean();
  o.beads = static_cast<double>(simulation->jet().links());
  o.path = path_length(simulation->jet().columns().position());
  o.seconds = simulation->statistics().wall_time;
  return o;
}

// Fridrikh, Yu, Brenner & Rutledge, Phys. Rev. Lett. 90 (2003) 144502: where surface tension balances the
// repulsion of the surface charge,
//
//     d = (gamma eps0 (Q/I)^2 2/(pi (2 ln chi - 3)))^(1/3)
double terminal_diameter(double surface_tension, double flow_rate, double current,
                         double chi) {
  constexpr double vacuum_permittivity = 8.8541878128e-12;
  const double ratio = flow_rate / current;
  return std::cbrt(surface_tension * vacuum_permittivity * ratio * ratio * 2
                   / (std::numbers::pi * (2 * std::log(chi) - 3)));
}

void observations(Suite& suite) {
  // 2 mL/h and 100 nA with the surface tension of the PVP solution of pvp.toml.
  suite.check_at_most(
      "terminal diameter of Fridrikh et al. (2003) for 2 mL/h and 100 nA: 0.840 um",
      relative(terminal_diameter(0.021133, 2e-6 / 3600, 1e-7, 100), 0.840e-6), 1e-3);

  const Window window = suite.pick<Window>({0.08, 0.1}, {0.14, 0.2});
  std::vector<Case> cases{{"as it is", {}},
                          {"potential 20000 V", {"field.potential=20000"}}};
  if (suite.full()) {
    cases.push_back({"potential 12000 V", {"field.potential=12000"}});
    for (const char* current : {"7e-9", "1.4e-8"})
      cases.push_back({fmt::format("current {} A", current),
                       {fmt::format("nozzle.current={}", current)}});
  }
  const std::size_t past_sweep = cases.size(); // at one flow rate and humidity
  if (suite.full()) {
    for (const double flow : {2.7778e-10, 8.3334e-10})
      cases.push_back({fmt::format("flow rate {} m^3/s at the same charge density", flow),
                       {fmt::format("nozzle.flow_rate={}", flow),
                        fmt::format("nozzle.current={:.6g}", 1e-8 * flow / 5.5556e-10)}});
    cases.push_back({"humidity 0.9", {"evaporation.humidity=0.9"}});
  }
  const std::size_t first_spread = cases.size();
  cases.push_back({"refinement at 1 mm", {"refinement.length=1e-3"}});
  if (suite.full()) {
    cases.push_back({"links at the nozzle of 28 um", {"nozzle.link_length=2.8e-5"}});
    cases.push_back({"rtol 1e-6", {"integrator.rtol=1e-6"}});
  }

  std::vector<Observed> seen(cases.size());
  std::vector<std::function<void()>> jobs;
  suite.plan(static_cast<double>(cases.size()));
  for (std::size_t i = 0; i < cases.size(); ++i)
    jobs.emplace_back([&, i] {
      seen[i] = run(cases[i], window);
      suite.done(1, cases[i].name);
    });
  in_parallel(jobs);

  Csv csv = suite.csv("experiments.csv",
                      "case,straight_length_m,envelope_m,growth_per_s,landing_speed_m_s,"
                      "laying_speed_m_s,wet_radius_m,dry_radius_m,dry_radius_scatter_m,"
                      "evaporated,beads,path_length_m,wall_time_s");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Observed& o = seen[i];
    const DryFibre::Summary f = o.fibre.value_or(DryFibre::Summary{});
    csv.row(cases[i].name, o.straight, o.envelope, o.growth, f.speed,
            f.length / window.length(), o.wet_radius, f.diameter / 2, f.scatter / 2,
            f.evaporated, o.beads, o.path, o.seconds);
  }

  const Observed& jet = seen[0];
  for (std::size_t i = 0; i < cases.size(); ++i)
    suite.check_at_least("fibre laid in metres: " + cases[i].name,
                         seen[i].fibre ? seen[i].fibre->length : 0, 1e-3);
  if (!jet.fibre) return;
  // Published, and here.
  Csv agreement = suite.csv("agreement.csv", "quantity,published,here");
  // Arras et al., Sci. Technol. Adv. Mater. 13 (2012) 035008: fibres on a moving target buckle at 0.9
  // and 2.7 m/s and do not at 4.5 m/s.
  agreement.row("landing speed in m/s (Arras et al. 2012: between 2.7 and 4.5)", 3.6,
                jet.fibre->speed);
  suite.check_at_least("landing speed in m/s", jet.fibre->speed, 0.9);
  suite.check_at_most("landing speed in m/s", jet.fibre->speed, 4.5);
  // The mass balance of a tenth of the flow rate would give a tenth of this.
  agreement.row(
      "length of fibre per second in m/s (Arras et al. 2012: between 2.7 and 4.5)", 3.6,
      jet.fibre->length / window.length());
  // Montinaro et al., Soft Matter 11 (2015) 3424: PVP jets.
  agreement.row("growth of the bending in 1/s (Montinaro et al. 2015)", 1000, jet.growth);
  suite.check_at_least("growth of the bending over that of Montinaro et al. (2015)",
                       jet.growth / 1000, 0.1);
  suite.check_at_most("growth of the bending over that of Montinaro et al. (2015)",
                      jet.growth / 1000, 3);
  // Lei et al., Polymer 180 (2019) 121762: radius ~ (length of the straight jet)^(-2/3).
  std::vector<double> lengths, radii;
  for (std::size_t i = 0; i < past_sweep; ++i)
    if (seen[i].fibre && seen[i].straight > 0) {
      lengths.push_back(std::log(seen[i].straight));
      radii.push_back(std::log(seen[i].fibre->diameter / 2));
    }
  if (lengths.size() >= 4)
    agreement.row("exponent of the radius over the straight length (Lei et al. 2019)",
                  -2. / 3, slope(lengths, radii));
  // The volume of fresh solution in a piece of fibre, as a cylinder, against the terminal diameter.
  const SceneConfig c = scene("fibre").config;
  const double fresh =
      jet.fibre->diameter / std::sqrt(c.evaporation->solution().polymer_volume());
  const double terminal = terminal_diameter(c.surface_tension->coefficient,
                                            *c.nozzle->flow_rate, *c.nozzle->current, 100);
  agreement.row("diameter as fresh solution in m (Fridrikh et al. 2003)", terminal, fresh);
  suite.check_at_most("diameter as fresh solution over the terminal one of Fridrikh et al.",
                      fresh / terminal, 4);
  suite.check_at_least(
      "diameter as fresh solution over the terminal one of Fridrikh et al.",
      fresh / terminal, 0.5);
  for (std::size_t i = first_spread; i < cases.size(); ++i) {
    if (!seen[i].fibre) continue;
    const std::string& what = cases[i].name;
    suite.check_at_most("dry diameter with " + what,
                        relative(seen[i].fibre->diameter, jet.fibre->diameter), 0.1);
    suite.check_at_most("straight length with " + what,
                        relative(seen[i].straight, jet.straight), 0.1);
    suite.check_at_most("landing speed with " + what,
                        relative(seen[i].fibre->speed, jet.fibre->speed), 0.15);
  }
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "experiments",
                     "Does a drying jet do what has been observed?", observations);
}
