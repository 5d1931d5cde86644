// What does mesh refinement do to a jet?
//
// Convergence in the length and the interval of refinements, with both remaps; what is conserved;
// resolving power; varicose fibres; short links that are joined; the paper's snapshots. Writes
// refinement_convergence.csv, refinement_conservation.csv, resolving_power.csv, varicosity.csv,
// contraction.csv, snapshots.csv.

#include "ehdjet/scene/schema.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "support/jets.hpp"
#include "support/scenes.hpp"
#include "support/suite.hpp"

namespace {

using namespace ehdjet;
using namespace ehdjet::validation;

constexpr double snapshot_time = 9e-3; // as in the paper, before the jet lands [s]

Scene refined(double length, double interval, LinkRemap remap) {
  Scene s = scene("table2_04");
  s.config.refinement->length = length;
  s.config.refinement->interval = interval;
  s.config.refinement->remap = remap;
  return s;
}

constexpr std::array remaps{LinkRemap::paper, LinkRemap::conservative};

// --- convergence

struct Mesh {
  double length, interval; // [m], [s]
  LinkRemap remap;
};

void convergence(Suite& suite) {
  Csv csv = suite.csv("refinement_convergence.csv",
                      "length_m,interval_s,remap,beads,path_length_m,tip_m,"
                      "reference_path_length_m,path_length_error,tip_error");
  const auto lengths = suite.pick<std::vector<double>>(
      {0.008, 0.004, 0.002}, {0.008, 0.004, 0.002, 0.001, 0.0005});
  const auto intervals =
      suite.pick<std::vector<double>>({1e-3, 5e-4}, {1e-3, 5e-4, 2.5e-4, 1.25e-4});
  std::vector<Mesh> meshes;
  for (const auto remap : remaps)
    for (const double interval : intervals)
      for (const double length : lengths) meshes.push_back({length, interval, remap});

  std::vector<Sample> ends(meshes.size());
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = meshes.size(); i-- > 0;) // the long ones first
    jobs.emplace_back([&, i] {
      const Mesh& m = meshes[i];
      ends[i] = simulate(refined(m.length, m.interval, m.remap), snapshot_time).end;
      suite.done(1e-3 / m.length, fmt::format("convergence, {:g} cm", 100 * m.length));
    });
  in_parallel(jobs);

  // Jets lengthen slowly as their mesh is refined: the self-energy of a line of point charges
  // grows with the logarithm of their number. The path length has no limit for short links; only that for short intervals can be checked.
  double worst = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::size_t row = i / lengths.size();
    const Sample& finest = ends[row * lengths.size() + lengths.size() - 1];
    const double path = relative(ends[i].path_length, finest.path_length);
    csv.row(meshes[i].length, meshes[i].interval,
            name_of(meshes[i].remap, refinement_remaps), ends[i].beads, ends[i].path_length,
            ends[i].tip, finest.path_length, path, relative(ends[i].tip, finest.tip));
    // On finer meshes point charges push each other harder, and more so if the mesh is cut earlier.
    constexpr double finest_published = 2e-3;
    if (row % intervals.size() > 0 && meshes[i].length >= finest_published)
      worst = std::max(worst,
                       relative(ends[i].path_length, ends[i - lengths.size()].path_length));
  }
  suite.check_at_most("change of path length at 9 ms by half the interval down to 0.2 cm",
                      worst, 0.02);
}

// --- conservation

/// |chain and deposit over what was inserted - 1|
double imbalance(const std::vector<double>& chain, double removed, double inserted) {
  CompensatedSum sum = removed;
  for (std::size_t k = 1; k < chain.size(); ++k) sum += chain[k];
  return std::abs(sum / inserted - 1);
}

void conservation(Suite& suite) {
  Csv csv = suite.csv("refinement_conservation.csv",
                      "remap,refinements,mass_error,charge_error,volume_error");
  struct Balance {
    std::uint64_t refinements = 0;
    double mass = 0, charge = 0, volume = 0;
  };
  std::array<Balance, remaps.size()> balances;
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < remaps.size(); ++i)
    jobs.emplace_back([&, i] {
      const auto simulation = build_simulation(refined(0.002, 2.5e-5, remaps[i]));
      simulation->run_until(suite.pick(0.015, 0.03));
      const JetState& jet = simulation->jet();
      const Ledger& l = simulation->ledger();
      balances[i] = {simulation->statistics().refinements.value_or(0),
                     imbalance(jet.mass, l.removed_mass, l.inserted_mass),
                     imbalance(jet.charge, l.removed_charge, l.inserted_charge),
                     imbalance(jet.volume, l.removed_volume, l.inserted_volume)};
      suite.done(1, "conservation");
    });
  in_parallel(jobs);
  for (std::size_t i = 0; i < remaps.size(); ++i) {
    const Balance& b = balances[i];
    const auto remap = name_of(remaps[i], refinement_remaps);
    csv.row(remap, b.refinements, b.mass, b.charge, b.volume);
    suite.check_at_least(fmt::format("number of refinements with the {} remap", remap),
                         static_cast<double>(b.refinements), 200);
    suite.check_at_most(
        fmt::format("change of mass and charge and volume by the {} remap", remap),
        std::max({b.mass, b.charge, b.volume}), 1e-12);
  }
}

// --- resolving power

constexpr std::size_t places = 101; // lambda = 0, 0.01, ... 1

/// Sums R = l_step/l of the link in which each lambda lies; the link across an embryo is one.
class ResolvingPower {
public:
  explicit ResolvingPower(double link_length)
      : link_length_(link_length) {}

  void add(const JetSnapshot& snapshot) {
    const auto r = snapshot.columns.position();
    const std::size_t first = snapshot.jet.first(), beads = snapshot.jet.beads();
    std::vector<double> length(beads);
    double total = 0;
    for (std::size_t k = first; k < beads; ++k)
      total += length[k] = link_length(r, first, k);
    std::size_t k = first;
    double end = length[first];
    for (std::size_t i = 0; i < places; ++i) {
      while (k + 1 < beads && end < lambda(i) * total) end += length[++k];
      sum_[i] += link_length_ / length[k];
    }
    ++samples_;
  }
  [[nodiscard]] static double lambda(std::size_t place) {
    return static_cast<double>(place) / (places - 1);
  }
  [[nodiscard]] double mean(std::size_t place) const { return sum_[place] / samples_; }
  [[nodiscard]] double least() const { return *std::ranges::min_element(sum_) / samples_; }

private:
  double link_length_;
  std::array<double, places> sum_{};
  double samples_ = 0;
};

void resolving_power(Suite& suite) {
  Csv csv = suite.csv("resolving_power.csv", "mesh,lambda,resolving_power");
  const double from = suite.pick(0.02, 0.035), to = suite.pick(0.03, 0.06);
  const double step = scene("table2_none").config.nozzle->link_length;
  std::vector<ResolvingPower> power(table2.size(), ResolvingPower(step));
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = table2.size(); i-- > 0;)
    jobs.emplace_back([&, i] {
      const auto simulation = build_simulation(scene(table2[i].scene));
      simulation->add(std::make_unique<Watch>(2e-5, [&, i](const JetSnapshot& snapshot) {
        if (snapshot.time > from) power[i].add(snapshot);
      }));
      simulation->run_until(to);
      suite.done(2 + table2[i].beads / 100, "resolving power");
    });
  in_parallel(jobs);
  for (std::size_t i = 0; i < power.size(); ++i)
    for (std::size_t p = 0; p < places; ++p)
      csv.row(i == 0 ? "unrefined" : name_of(table2[i]), ResolvingPower::lambda(p),
              power[i].mean(p));
  // The paper has 1/40 and 1/200 (read off a figure), and above 0.075 when refined. Its algorithm
  // gives other values here, as it does for the numbers of beads.
  suite.check_at_most("1/R of case I at lambda 0.1 from 40",
                      relative(1 / power[0].mean(10), 40), 0.25);
  suite.check_at_least("1/R of case I at lambda 1", 1 / power[0].mean(places - 1), 160);
  suite.check_at_most("1/R of case I at lambda 1", 1 / power[0].mean(places - 1), 210);
  suite.check_at_least("least R refined at 0.2 cm", power.back().least(), 0.9 * 0.075);
}

// --- varicosity

class Fibre final : public Observer {
public:
  explicit Fibre(std::vector<DepositedBead>& beads)
      : beads_(beads) {}
  void deposit(const DepositedBead& bead) override { beads_.push_back(bead); }

private:
  std::vector<DepositedBead>& beads_;
};

struct Segment {
  double length, radius, volume; // [m], [m], [m^3]
};

/// Links of the fibre from the last deposited one on, for `most` of its length. A link that was
/// fed its volume has length V/(pi a^2).
std::vector<Segment> last_segments(const std::vector<DepositedBead>& beads, double most) {
  std::vector<Segment> segments;
  double length = 0;
  for (auto b = beads.rbegin(); b != beads.rend() && length < most; ++b) {
    const double l = b->bead.volume / (std::numbers::pi * b->radius * b->radius);
    segments.push_back({l, b->radius, b->bead.volume});
    length += l;
  }
  return segments;
}

/// Largest over median radius, by length.
double bump(std::vector<Segment> segments) {
  std::ranges::sort(segments, {}, &Segment::radius);
  double total = 0, below = 0;
  for (const Segment& s : segments) total += s.length;
  for (const Segment& s : segments)
    if ((below += s.length) >= total / 2) return segments.back().radius / s.radius;
  return 1;
}

void varicosity(Suite& suite) {
  Csv csv = suite.csv("varicosity.csv", "mesh,arc_length_m,radius_m");
  struct Case {
    const char *mesh, *scene;
    std::vector<DepositedBead> beads = {};
  };
  std::array cases{Case{"unrefined", "varicose_unrefined"}, Case{"refined", "varicose"}};
  std::vector<std::function<void()>> jobs;
  for (Case& c : cases)
    jobs.emplace_back([&] {
      const auto simulation = build_simulation(scene(c.scene));
      simulation->add(std::make_unique<Fibre>(c.beads));
      simulation->run_until(suite.pick(0.025, 0.06));
      suite.done(6, "varicosity");
    });
  in_parallel(jobs);
  for (const Case& c : cases) {
    const auto segments = last_segments(c.beads, 1.0); // the length of about ten bumps
    double arc = 0;
    for (const Segment& s : segments) { // one radius per link: a step function
      csv.row(c.mesh, arc, s.radius);
      csv.row(c.mesh, arc += s.length, s.radius);
    }
    // Ten per cent more volume is a radius 1.0488 times as large, if the link is as long; heavier
    // links are stretched less.
    suite.check_at_least(fmt::format("largest over median radius of the {} fibre", c.mesh),
                         bump(segments), std::sqrt(1.1));
  }
}

// --- short links

// A viscous thread without charge is held at one end, and its surface tension pulls it together. From
// pi a^2 sigma = -pi a alpha and sigma = mu (dl/dt)/l follows a = a0 + alpha t/(2 mu).
struct Thread {
  double length = 0.02, radius = 2e-5, density = 840; // [m], [m], [kg/m^3]
  double tension = 0.02, viscosity = 200;             // alpha [N/m], mu [Pa s]
  std::size_t links = 400;

  [[nodiscard]] double length_at(double t) const { // [m]
    const double grown = 1 + tension * t / (2 * viscosity * radius);
    return length / (grown * grown);
  }
};

Scene contracting(const Thread& thread, std::optional<double> coarsen) {
  Scene s = test::chain_scene(FixedEnds::first);
  const double l = thread.length / static_cast<double>(thread.links);
  const double volume = std::numbers::pi * thread.radius * thread.radius * l;
  const double stress = -thread.tension / thread.radius, rate = stress / thread.viscosity;
  for (std::size_t k = 0; k <= thread.links; ++k) {
    const double x = static_cast<double>(k) * l;
    test::add_bead(s, {.position = {x, 0, 0},
                       .velocity = {rate * x, 0, 0},
                       .volume = volume,
                       .mass = thread.density * volume,
                       .charge = 0,
                       .declared = {stress}});
  }
  s.config.viscoelasticity = ViscoelasticityConfig{1e5, thread.viscosity};
  s.config.surface_tension =
      SurfaceTensionConfig{.coefficient = thread.tension, .form = SurfaceTensionForm::line};
  s.config.refinement =
      RefinementConfig{.length = 1e-3, .interval = 0.02, .coarsen = coarsen};
  test::integrate(s, "auto", 1e-5);
  return s;
}

void contraction(Suite& suite) {
  Csv csv = suite.csv("contraction.csv",
                      "coarsen_m,time_s,beads,length_m,theory_m,evaluations,pairs");
  const Thread thread;
  constexpr double end = 2; // [s]: the thread is then six times as thick
  struct Outcome {
    double length = 0, beads = 0, pairs = 0; // pairs of charges that a direct sum would see
  };
  const auto outcome = [&](std::optional<double> coarsen) {
    const auto simulation = build_simulation(contracting(thread, coarsen));
    Outcome o;
    double evaluations = 0;
    simulation->add(std::make_unique<Watch>(end / 100, [&](const JetSnapshot& snapshot) {
      const auto now = static_cast<double>(snapshot.statistics.evaluations);
      o.beads = static_cast<double>(snapshot.jet.links());
      o.pairs += (now - evaluations) * o.beads * o.beads / 2;
      evaluations = now;
      o.length = path_length(snapshot.columns.position());
      csv.row(coarsen, snapshot.time, o.beads, o.length, thread.length_at(snapshot.time),
              now, o.pairs);
    }));
    simulation->run_until(end);
    return o;
  };
  const Outcome all = outcome({}), joined = outcome(1e-4);
  suite.check_at_most("length of a contracting thread from theory",
                      relative(all.length, thread.length_at(end)), 0.01);
  suite.check_at_most("length of a contracting thread with and without coarsening",
                      relative(joined.length, all.length), 1e-4);
  suite.check_at_most("beads of a contracting thread with over without coarsening",
                      joined.beads / all.beads, 0.05);
  suite.check_at_most("pairs in a contracting thread with over without coarsening",
                      joined.pairs / all.pairs, 0.5);
  suite.done(1, "short links");
}

// --- snapshots

void snapshots(Suite& suite) {
  Csv csv = suite.csv("snapshots.csv", "length_m,time_s,bead,x_m,y_m,z_m,radius_m");
  const double nozzle_radius = scene("table2_none").config.nozzle->radius;
  std::vector<Run> runs(table2.size());
  std::vector<std::function<void()>> jobs;
  for (std::size_t i = 0; i < runs.size(); ++i)
    jobs.emplace_back([&, i] {
      runs[i] = simulate(scene(table2[i].scene), snapshot_time);
      suite.done(0.5, "snapshots");
    });
  in_parallel(jobs);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const JetState& jet = runs[i].jet;
    const auto r = jet.columns().position();
    for (std::size_t k = 0; k < jet.beads(); ++k) {
      if (jet.has_embryo && k == 1) continue; // on the link from bead 0 to bead 2
      const double radius =
          k == 0 ? nozzle_radius : link_radius(jet.volume[k], link_length(jet, k));
      csv.row(table2[i].length, jet.time, k, r.x[k], r.y[k], r.z[k], radius);
    }
    if (i > 0) // "substantially equivalent" to the paper
      suite.check_at_most(fmt::format("path length at 9 ms refined at {} from unrefined",
                                      name_of(table2[i])),
                          relative(runs[i].end.path_length, runs[0].end.path_length), 0.05);
  }
}

void answer(Suite& suite) {
  double cost = 2 + 2 * 6 + 2 + 4 * 2 + 1;
  for (const Table2Row& row : table2) cost += row.beads / 100;
  suite.plan(
      cost
      + suite.pick(4 * (1 / 8. + 1 / 4. + 1 / 2.), 8 * (1 / 8. + 1 / 4. + 1 / 2. + 1 + 2)));
  snapshots(suite);
  convergence(suite);
  conservation(suite);
  resolving_power(suite);
  varicosity(suite);
  contraction(suite);
}

} // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, "refinement", "What mesh refinement does to a jet",
                     answer);
}
