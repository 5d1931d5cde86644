// What of a jet does not depend on its links?
//
// Stationary means of two jets against the length of the links at the nozzle, the length and interval of refinements, the
// tolerance of the steps and of the Coulomb solver. The PVP jet with points as in the paper, and with the near
// field of a thread; a pumped jet, whose links at the nozzle can be as short as its radius. Writes mesh.csv and wear.csv.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/jets.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

/// Means over the deposit, weighted with the mass, and over time.
struct Means {
  double links = 0, path_length = 0, distance = 0, speed = 0, radius = 0, scatter = 0,
         evaluations_per_ms = 0;
};

class Stationary final : public Observer {
public:
  Stationary(double from, double interval)
      : schedule_(interval)
      , from_(from) {}
  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void observe(const JetSnapshot& s) override {
    schedule_.advance();
    if (s.time < from_) return;
    const Sample now = sample_of(s);
    looks_ += 1, links_ += now.beads, path_ += now.path_length;
    if (looks_ == 1) first_time_ = s.time, first_evaluations_ = evaluations(s);
    last_time_ = s.time, last_evaluations_ = evaluations(s);
  }
  void deposit(const DepositedBead& b) override {
    if (b.time >= from_) landed_.push_back(b);
  }
  [[nodiscard]] Means means() const {
    Means m{.links = links_ / looks_, .path_length = path_ / looks_};
    m.evaluations_per_ms =
        (last_evaluations_ - first_evaluations_) / (1e3 * (last_time_ - first_time_));
    double mass = 0, square = 0;
    for (const DepositedBead& b : landed_) {
      const double w = b.bead.mass;
      mass += w;
      m.distance += w * std::hypot(b.bead.position.y(), b.bead.position.z());
      m.speed += w * b.bead.velocity.norm();
      m.radius += w * b.landing_radius, square += w * b.landing_radius * b.landing_radius;
    }
    m.distance /= mass, m.speed /= mass, m.radius /= mass;
    m.scatter = std::sqrt(std::max(square / mass - m.radius * m.radius, 0.0));
    return m;
  }

private:
  static double evaluations(const JetSnapshot& s) {
    return static_cast<double>(s.statistics.evaluations);
  }
  Schedule schedule_;
  double from_;
  double looks_ = 0, links_ = 0, path_ = 0;
  double first_time_ = 0, last_time_ = 0, first_evaluations_ = 0, last_evaluations_ = 0;
  std::vector<DepositedBead> landed_;
};

/// A jet, and what its mesh is.
struct Case {
  std::string jet, scene; // name in the table, file in scenes/
  std::string near_field = "point", mesh = "redistribute";
  double link_length = 2e-4, length = 0, interval = 1e-3, rtol = 1e-5; // 0: not refined
  std::string solver = "direct";
  double from = 20e-3, end = 30e-3; // [s]
};

std::string setting(const std::string& key, double value) {
  return fmt::format("{}={:.17g}", key, value);
}

Scene scene_of(const Case& c) {
  std::vector<std::string> set{
      setting("nozzle.link_length", c.link_length), setting("integrator.rtol", c.rtol),
      "coulomb.solver=" + c.solver, "coulomb.near_field=" + c.near_field};
  const std::string form = c.near_field == "point" ? "paper" : "line";
  set.push_back("surface_tension.form=" + form);
  if (c.length > 0) {
    set.push_back(setting("refinement.length", c.length));
    set.push_back("refinement.mesh=" + c.mesh);
    if (c.mesh == "redistribute") set.push_back(setting("refinement.interval", c.interval));
  }
  return scene(c.scene, set);
}

Means run(const Case& c) {
  const auto simulation = build_simulation(scene_of(c));
  const auto stationary = std::make_shared<Stationary>(c.from, 1.37e-5);
  simulation->add(stationary);
  simulation->run_until(c.end);
  return stationary->means();
}

Case pvp(const std::string& near_field, double length) {
  return {.jet = "pvp", .scene = "pvp", .near_field = near_field, .length = length};
}

Case pumped(double link_length) {
  const bool fine = link_length < 4e-5; // is stationary as early as the others
  return {.jet = "pumped",
          .scene = "converged",
          .near_field = "fixed",
          .link_length = link_length,
          .length = 4e-3,
          .from = fine ? 30e-3 : 40e-3,
          .end = fine ? 40e-3 : 50e-3};
}

/// All cases that the checks need, and, in a full run, what else the figures show.
struct Cases {
  std::vector<Case> all;
  std::size_t add(Case c) {
    all.push_back(std::move(c));
    return all.size() - 1;
  }
};

void convergence(Suite& suite) {
  Cases cases;
  const std::vector<double> lengths =
      suite.pick<std::vector<double>>({0, 8e-3, 4e-3}, {0, 8e-3, 4e-3, 2e-3});
  std::vector<std::size_t> points, threads;
  for (const double l : lengths) {
    points.push_back(cases.add(pvp("point", l)));
    threads.push_back(cases.add(pvp("free-surface", l)));
  }
  Case other = pvp("free-surface", 4e-3);
  other.rtol = 1e-7;
  const std::size_t strict = cases.add(other);
  other = pvp("free-surface", 4e-3), other.solver = "fmm";
  const std::size_t fast = cases.add(other);
  other = pvp("free-surface", 4e-3), other.interval = 2.5e-4;
  const std::size_t often = cases.add(other);
  other = pvp("free-surface", 4e-3), other.mesh = "cut";
  const std::size_t cut = cases.add(other);
  std::vector<std::size_t> at_nozzle;
  for (const double l : suite.pick<std::vector<double>>({4e-4, 2e-4, 1e-4},
                                                        {4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5}))
    at_nozzle.push_back(cases.add(pumped(l)));

  std::vector<Means> means(cases.all.size());
  std::vector<std::function<void()>> jobs;
  suite.plan(static_cast<double>(means.size()));
  for (std::size_t i = means.size(); i-- > 0;)
    jobs.emplace_back([&, i] {
      means[i] = run(cases.all[i]);
      suite.done(1, fmt::format("{}, {}", cases.all[i].jet, cases.all[i].near_field));
    });
  in_parallel(jobs);

  Csv csv =
      suite.csv("mesh.csv", "jet,near_field,mesh,link_length_m,length_m,interval_s,rtol,"
                            "solver,links,path_length_m,distance_m,speed_m_s,radius_m,"
                            "radius_scatter_m,evaluations_per_ms");
  for (std::size_t i = 0; i < means.size(); ++i) {
    const Case& c = cases.all[i];
    const Means& m = means[i];
    csv.row(c.jet, c.near_field, c.mesh, c.link_length, c.length,
            c.length > 0 && c.mesh == "redistribute" ? c.interval : 0, c.rtol, c.solver,
            m.links, m.path_length, m.distance, m.speed, m.radius, m.scatter,
            m.evaluations_per_ms);
  }

  // Against an independent prototype; row 0 is not refined.
  struct Row {
    double path, distance, speed, links;
  };
  const std::vector<Row> prototype{{2.5230, 5.0065e-2, 21.0932, 130.77},
                                   {2.5719, 5.0098e-2, 21.0942, 317.98},
                                   {2.5776, 5.0055e-2, 21.0926, 603.46},
                                   {2.5802, 5.0039e-2, 21.0913, 1183.24}};
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Means& m = means[threads[i]];
    const std::string l = fmt::format(" (PVP with a near field at L~ = {} m)", lengths[i]);
    suite.check_at_most("path length against a prototype" + l,
                        relative(m.path_length, prototype[i].path), 3e-3);
    suite.check_at_most("distance from the axis" + l,
                        relative(m.distance, prototype[i].distance), 3e-3);
    suite.check_at_most("impact speed" + l, relative(m.speed, prototype[i].speed), 5e-4);
    suite.check_at_most("links" + l, relative(m.links, prototype[i].links), 5e-3);
  }
  const auto spread = [&](const std::vector<std::size_t>& of, double Means::*value) {
    return relative(means[of.back()].*value, means[of[1]].*value);
  };
  suite.check_at_most("spread over L~ with a near field: distance from the axis",
                      spread(threads, &Means::distance), 2e-3);
  suite.check_at_most("spread over L~ with a near field: path length",
                      spread(threads, &Means::path_length), 4e-3);
  suite.check_at_most("spread over L~ with a near field: impact speed",
                      spread(threads, &Means::speed), 2e-4);
  suite.check_at_least("spread over L~ of points: distance from the axis",
                       spread(points, &Means::distance), suite.pick(8e-3, 2e-2));
  const Means& base = means[threads[2]];
  suite.check_at_most("rtol 1e-7 instead of 1e-5: path length",
                      relative(means[strict].path_length, base.path_length), 2e-3);
  suite.check_at_most("fast multipole method at 1e-6: path length",
                      relative(means[fast].path_length, base.path_length), 2e-3);
  suite.check_at_most("refinements four times as often: path length",
                      relative(means[often].path_length, base.path_length), 5e-3);
  suite.check_at_most("cuts instead of redistribution: distance from the axis",
                      relative(means[cut].distance, base.distance), 4e-3);
  suite.check_at_most(
      "evaluations per ms with a near field over those of points",
      means[threads[0]].evaluations_per_ms / means[points[0]].evaluations_per_ms, 1);
  // Path, distance, speed of the prototype with the same links at the nozzle.
  const std::vector<Row> pumped_rows{{0.9420, 1.2570e-2, 18.823, 229.8},
                                     {0.9569, 1.2152e-2, 18.718, 250.1},
                                     {0.9415, 1.1573e-2, 18.658, 309.7},
                                     {0.90935, 1.1136e-2, 18.6926, 582.7},
                                     {0.91111, 1.1134e-2, 18.6908, 1164.8}};
  for (std::size_t i = 0; i < at_nozzle.size(); ++i) {
    const Means& m = means[at_nozzle[i]];
    const std::string l =
        fmt::format(" (pumped with l_step = {} m)", cases.all[at_nozzle[i]].link_length);
    suite.check_at_most("path length against a prototype" + l,
                        relative(m.path_length, pumped_rows[i].path), 5e-3);
    suite.check_at_most("distance from the axis" + l,
                        relative(m.distance, pumped_rows[i].distance), 1e-2);
    suite.check_at_most("impact speed" + l, relative(m.speed, pumped_rows[i].speed), 1e-3);
  }
  if (suite.full())
    suite.check_at_most(
        "distance from the axis of the pumped jet at l_step 5e-5 m against 2.5e-5 m",
        relative(means[at_nozzle[3]].distance, means[at_nozzle[4]].distance), 5e-4);
}

// Redistribution wears the jet down, the more often it happens; cuts do not.
void wear(Suite& suite) {
  struct Kind {
    std::string mesh;
    double interval;
  };
  const std::vector<Kind> kinds{
      {"redistribute", 1e-3}, {"redistribute", 1e-4}, {"redistribute", 1e-5}, {"cut", 0}};
  std::vector<Means> means(kinds.size());
  std::vector<double> changes(kinds.size());
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    jobs.emplace_back([&, i] {
      Case c = pvp("free-surface", 4e-3);
      c.mesh = kinds[i].mesh, c.interval = kinds[i].interval, c.from = 15e-3, c.end = 20e-3;
      const auto simulation = build_simulation(scene_of(c));
      const auto stationary = std::make_shared<Stationary>(c.from, 1.37e-5);
      simulation->add(stationary);
      simulation->run_until(c.end);
      means[i] = stationary->means();
      changes[i] = static_cast<double>(simulation->statistics().refinements.value_or(0));
    });
  in_parallel(jobs);
  Csv csv =
      suite.csv("wear.csv", "mesh,interval_s,changes_of_the_mesh,path_length_m,distance_m,"
                            "speed_m_s,radius_m,radius_scatter_m,evaluations_per_ms");
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const Means& m = means[i];
    csv.row(kinds[i].mesh, kinds[i].interval, changes[i], m.path_length, m.distance,
            m.speed, m.radius, m.scatter, m.evaluations_per_ms);
  }
  const double once = means[0].distance;
  suite.check_at_least("cuts of the mesh in 20 ms", changes[3], 1000);
  suite.check_at_most("wear by cuts: distance from the axis",
                      relative(means[3].distance, once), 4e-3);
  suite.check_at_least("wear by redistributing as often", relative(means[2].distance, once),
                       3e-2);
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "mesh", "What of a jet does not depend on its links?",
                     [](Suite& suite) {
                       convergence(suite);
                       wear(suite);
                     });
}
