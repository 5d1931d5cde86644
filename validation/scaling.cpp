// What does a run cost, and is it right all the same?
//
// The paper's Table 2, against runs at a tight tolerance with the direct sum; the evaluations that
// each method and setting saves; finer meshes and longer jets than the paper's. Writes table2.csv,
// table2_ideas.csv, scaling.csv.

#include "ehdjet/integrators/butcher_tableau.hpp"

#include <omp.h>

#include <array>
#include <chrono>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include "support/jets.hpp"
#include "support/long_jet.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

constexpr double sample_interval = 2e-5; // [s]

struct Timed {
  Run run;
  double seconds = 0, beads_before = 0; // right before a refinement, stationary
};

/// What is compared: means over the stationary part.
struct Window {
  double from, to, end; // the run goes on to `end` [s]
};

Timed timed(const Scene& scene, const Window& window, std::size_t threads) {
  Timed t;
  const Table2Run run =
      run_table2(scene, window.end, window.from, threads, [&](Simulation& simulation) {
        simulation.add(
            std::make_unique<Watch>(sample_interval, [&](const JetSnapshot& snapshot) {
              t.run.samples.push_back(sample_of(snapshot));
            }));
      });
  t.run.statistics = run.statistics;
  t.seconds = run.statistics.wall_time;
  t.beads_before = run.links_before;
  return t;
}

Scene table2_scene(const std::string& name, const std::string& solver, double rtol) {
  Scene s = scene(name);
  s.config.coulomb->solver = solver;
  s.config.coulomb->tolerance = 1e-5;
  s.config.integrator.rtol = rtol;
  return s;
}

// --- Table 2

/// Beads of the stationary jet right before a refinement (decision 10 in src/DECISIONS.md); without
/// refinement the mean (tests/simulation).
double converged_beads(const Table2Row& row) {
  constexpr std::array beads{149.58, 267., 485., 950.};
  return beads.at(static_cast<std::size_t>(&row - table2.data()));
}

class Table2 {
public:
  explicit Table2(Suite& suite)
      : suite_(suite)
      , window_(suite.quick() ? Window{0.012, 0.02, 0.02} : Window{0.035, 0.1, 0.2})
      , csv_(suite.csv(
            "table2.csv",
            "length_m,threads,solver,method,rtol,beads_mean,beads_paper,seconds_s,"
            "seconds_paper,evaluations,rejected,tip_m,path_length_m,"
            "deposit_mass_kg,tip_error,path_length_error,deposit_mass_error")) {}

  void run() {
    for (const Table2Row& row : table2)
      if (suite_.full() || row.length == 0 || row.length == 0.008) measure(row);
  }
  static double cost(const Table2Row& row) { return row.beads / 50; }

private:
  void measure(const Table2Row& row) {
    const Window exact_window{window_.from, window_.to, window_.to};
    const auto processors = static_cast<std::size_t>(omp_get_num_procs());
    const Timed exact =
        timed(table2_scene(row.scene, "direct", 1e-8), exact_window, processors);
    suite_.done(2 * cost(row), fmt::format("Table 2, {}, reference", name_of(row)));
    const Sample reference = validation::mean(exact.run.samples, window_.from, window_.to);
    write(row, processors, "direct", "dormand-prince", 1e-8, exact, reference, {});
    for (const std::string method : {"dormand-prince", "two-rate"})
      for (const std::size_t threads : {1U, 2U}) {
        if (threads > processors) continue;
        if (suite_.full() && threads == 1 && row.length == 0.002) continue; // long
        Scene s = table2_scene(row.scene, "auto", 1e-5);
        s.config.integrator.method = method;
        const Timed t = timed(s, window_, threads);
        const Sample mean = validation::mean(t.run.samples, window_.from, window_.to);
        write(row, threads, "auto", method, 1e-5, t, mean, reference);
        check(row, fmt::format("{} {} threads", method, threads), t, mean, reference);
        suite_.done(cost(row) / 2, fmt::format("Table 2, {}, {}, {} threads", name_of(row),
                                               method, threads));
      }
  }

  void write(const Table2Row& row, std::size_t threads, const std::string& solver,
             const std::string& method, double rtol, const Timed& t, const Sample& s,
             const std::optional<Sample>& reference) {
    const auto error = [&](double Sample::*value) -> std::optional<double> {
      if (!reference) return {};
      return relative(s.*value, *reference.*value);
    };
    // The reference ends earlier, so that its wall time cannot be compared with the paper's.
    const Sample all = validation::mean(t.run.samples, 0, window_.end);
    csv_.row(row.length, threads, solver, method, rtol, all.beads, row.beads, t.seconds,
             reference && suite_.full() ? std::optional{row.wall} : std::nullopt,
             t.run.statistics.evaluations, t.run.statistics.rejected, s.tip, s.path_length,
             s.deposit_mass, error(&Sample::tip), error(&Sample::path_length),
             error(&Sample::deposit_mass));
  }

  void check(const Table2Row& row, const std::string& how, const Timed& t, const Sample& s,
             const Sample& reference) {
    const std::string name = fmt::format("Table 2 {} {}: ", name_of(row), how);
    suite_.check_at_most(name + "tip", relative(s.tip, reference.tip), 1e-3);
    suite_.check_at_most(name + "path length",
                         relative(s.path_length, reference.path_length), 1e-3);
    suite_.check_at_most(name + "deposit mass",
                         relative(s.deposit_mass, reference.deposit_mass), 1e-3);
    if (suite_.quick()) return; // not stationary yet
    suite_.check_at_most(
        name + "beads from the converged number",
        relative(row.length == 0 ? s.beads : t.beads_before, converged_beads(row)),
        row.length == 0 ? 1e-3 : 0.03);
  }

  Suite& suite_;
  Window window_;
  Csv csv_;
};

// --- ways of saving evaluations

struct Idea {
  std::string name;
  std::function<void(Scene&)> apply;
};

std::vector<Idea> ideas() {
  const auto with_rtol = [](double rtol) {
    return [rtol](Scene& s) { s.config.integrator.rtol = rtol; };
  };
  std::vector<Idea> all{{"as it is: dormand-prince rtol 1e-5 auto", [](Scene&) {}}};
  for (const ButcherTableau& method : butcher_tableaus())
    if (!method.error.empty() && method.name != "dormand-prince")
      all.push_back({fmt::format("method {}", method.name),
                     [&method](Scene& s) { s.config.integrator.method = method.name; }});
  all.push_back({"every landing ends a step",
                 [](Scene& s) { s.config.integrator.landings = LandingSteps::located; }});
  all.push_back({"root mean square error norm",
                 [](Scene& s) { s.config.integrator.norm = ErrorNorm::rms; }});
  all.push_back({"events at the ends of steps",
                 [](Scene& s) { s.config.integrator.events = EventPlacement::step_end; }});
  all.push_back({"rtol 1e-4", with_rtol(1e-4)});
  all.push_back({"rtol 1e-6", with_rtol(1e-6)});
  all.push_back({"direct sum", [](Scene& s) { s.config.coulomb->solver = "direct"; }});
  all.push_back({"fmm tolerance 1e-3", [](Scene& s) {
                   s.config.coulomb->solver = "fmm", s.config.coulomb->tolerance = 1e-3;
                 }});
  // As published, but with longer steps: with the published 1e-8 s it would take hours.
  all.push_back({"rk4 with steps of 1e-6 s at step ends", [](Scene& s) {
                   s.config.integrator.method = "rk4";
                   s.config.integrator.rtol.reset(), s.config.integrator.step = 1e-6;
                   s.config.integrator.events = EventPlacement::step_end;
                 }});
  return all;
}

void measure_ideas(Suite& suite) {
  Csv csv = suite.csv("table2_ideas.csv",
                      "idea,length_m,evaluations,rejected,seconds_s,tip_error");
  const Window window =
      suite.quick() ? Window{0.012, 0.015, 0.015} : Window{0.03, 0.04, 0.04};
  for (const Table2Row& row : table2) {
    if (suite.quick() ? row.length != 0.008 : row.length != 0 && row.length != 0.004)
      continue;
    const std::vector<Idea> all = ideas();
    std::vector<Timed> runs(all.size());
    Timed exact;
    std::vector<std::function<void()>> jobs{[&] {
      exact = timed(table2_scene(row.scene, "direct", 1e-8), window, 1);
      suite.done(1, "ways of saving evaluations");
    }};
    for (std::size_t i = 0; i < all.size(); ++i)
      jobs.emplace_back([&, i] {
        Scene s = table2_scene(row.scene, "auto", 1e-5);
        all[i].apply(s);
        runs[i] = timed(s, window, 1);
        suite.done(1, "ways of saving evaluations");
      });
    in_parallel(jobs);
    const Sample reference = validation::mean(exact.run.samples, window.from, window.to);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Sample s = validation::mean(runs[i].run.samples, window.from, window.to);
      csv.row(all[i].name, row.length, runs[i].run.statistics.evaluations,
              runs[i].run.statistics.rejected, runs[i].seconds,
              relative(s.tip, reference.tip));
    }
  }
}

// --- beyond the paper

double resident_memory() { // [bytes]
  std::ifstream in("/proc/self/statm");
  double all = 0, resident = 0;
  in >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct Enough {};

class Beyond {
public:
  explicit Beyond(Suite& suite)
      : suite_(suite)
      , csv_(suite.csv("scaling.csv",
                       "beads,source,solver,tolerance,threads,steps,seconds_s,"
                       "seconds_per_evaluation_s,evaluations,time_per_ms_s,memory_bytes")) {
  }

  void cut_links() {
    const auto lengths = suite_.pick<std::vector<double>>({0.002}, {0.002, 0.001, 0.0005});
    for (const double length : lengths) {
      Scene s = table2_scene("table2_02", "auto", 1e-5);
      s.config.refinement->length = length;
      const auto simulation = build_simulation(s);
      // Stationary, with some beads on the collector, before the clock starts.
      simulation->run_until(suite_.pick(0.012, 0.02));
      measure(*simulation, "cut links", s, suite_.pick<std::uint64_t>(100, 1000));
      suite_.done(0.04 / length, "cut links");
    }
  }

  void long_jets() {
    const LongJet source(suite_.pick(0.013, 0.025));
    suite_.done(10, "a jet to be continued");
    for (const Job& job : jobs()) {
      Scene s = source.scene(job.beads);
      s.config.coulomb->solver = job.solver;
      s.config.coulomb->tolerance = 1e-5;
      const auto simulation = build_simulation(s);
      check_links(simulation->jet());
      const double seconds = measure(*simulation, "collector distance", s, job.steps);
      if (job.solver == "fmm" && job.beads == 100'000 && job.steps == 100)
        suite_.check_at_most("100 steps of 1e5 beads with fmm [s]", seconds, 180);
      suite_.done(job.cost, fmt::format("{} beads, {}", job.beads, job.solver));
    }
  }

  [[nodiscard]] double cost() const {
    double sum = 10 + (suite_.quick() ? 20 : 140);
    for (const Job& job : jobs()) sum += job.cost;
    return sum;
  }

private:
  struct Job {
    std::size_t beads;
    std::string solver;
    std::uint64_t steps;
    double cost;
  };
  [[nodiscard]] std::vector<Job> jobs() const {
    if (suite_.quick())
      return {
          {10'000, "direct", 10, 2}, {10'000, "treecode", 10, 2}, {10'000, "fmm", 10, 1}};
    return {{10'000, "direct", 100, 10},    {10'000, "treecode", 100, 15},
            {10'000, "fmm", 100, 3},        {100'000, "direct", 2, 30},
            {100'000, "treecode", 20, 40},  {100'000, "fmm", 100, 30},
            {1'000'000, "treecode", 2, 60}, {1'000'000, "fmm", 20, 120}};
  }

  /// Point charges can represent a jet only while its links are longer than it is wide.
  void check_links(const JetState& jet) {
    double least = std::numeric_limits<double>::infinity(), longest = 0;
    for (std::size_t k = jet.first(); k < jet.beads(); ++k) {
      const double length = link_length(jet, k);
      least = std::min(least, length / link_radius(jet.volume[k], length));
      longest = std::max(longest, length);
    }
    suite_.check_at_least(fmt::format("link over radius with {} beads", jet.links()), least,
                          4);
    suite_.check_at_most(fmt::format("longest link with {} beads [m]", jet.links()),
                         longest, 0.004);
  }

  /// Some steps of a run [s].
  double measure(Simulation& simulation, const std::string& source, const Scene& scene,
                 std::uint64_t steps) {
    const RunStatistics before = simulation.statistics();
    const double start = simulation.jet().time;
    simulation.after_each_step([&](const Simulation& s) {
      if (s.statistics().steps - before.steps >= steps) throw Enough();
    });
    using Clock = std::chrono::steady_clock;
    const auto clock = Clock::now();
    try {
      simulation.run_until(start + 1);
    } catch (const Enough&) {
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - clock).count();
    const RunStatistics& after = simulation.statistics();
    const auto evaluations = static_cast<double>(after.evaluations - before.evaluations);
    // A few steps are too short to estimate the time of a millisecond.
    std::optional<double> per_ms;
    if (steps >= 100) per_ms = 1e-3 * seconds / (simulation.jet().time - start);
    const CoulombConfig& c = *scene.config.coulomb;
    csv_.row(simulation.jet().links(), source, c.solver,
             c.solver == "direct" ? std::optional<double>{} : c.tolerance,
             omp_get_max_threads(), after.steps - before.steps, seconds,
             seconds / evaluations, evaluations, per_ms, resident_memory());
    return seconds;
  }

  Suite& suite_;
  Csv csv_;
};

void answer(Suite& suite) {
  Beyond beyond(suite);
  double cost =
      beyond.cost() + static_cast<double>((ideas().size() + 1) * suite.pick(1U, 2U));
  for (const Table2Row& row : table2)
    if (suite.full() || row.length == 0 || row.length == 0.008)
      cost += 4 * Table2::cost(row);
  suite.plan(cost);
  Table2(suite).run();
  measure_ideas(suite);
  beyond.cut_links();
  beyond.long_jets();
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "scaling", "What runs cost, from the paper's Table 2 on",
                     answer);
}
