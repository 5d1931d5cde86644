#include "jets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace ehdjet::validation {

Scene scene(const std::string& name, const std::vector<std::string>& overrides) {
  Scene s = read_scene(EHDJET_SCENES "/" + name + ".toml", overrides);
  s.config.output = {};
  return s;
}

std::string name_of(const Table2Row& row) {
  return row.length == 0 ? row.name : std::string(row.name) + " cm";
}

double path_length(ConstVec3View r) {
  double length = 0;
  for (std::size_t k = 1; k < r.size(); ++k) length += (r[k] - r[k - 1]).norm();
  return length;
}

Sample sample_of(const JetSnapshot& snapshot) {
  const auto r = snapshot.columns.position();
  const Vec3 tip = r[r.size() - 1];
  return {.time = snapshot.time,
          .beads = static_cast<double>(snapshot.jet.links()),
          .tip = std::hypot(tip.y(), tip.z()),
          .path_length = path_length(r),
          .deposit_mass = snapshot.ledger.removed_mass};
}

Sample mean(const std::vector<Sample>& samples, double from, double to) {
  Sample sum;
  double n = 0;
  for (const Sample& s : samples) {
    if (s.time < from || s.time > to) continue;
    ++n, sum.time += s.time, sum.beads += s.beads, sum.tip += s.tip;
    sum.path_length += s.path_length, sum.deposit_mass += s.deposit_mass;
  }
  for (double* value :
       {&sum.time, &sum.beads, &sum.tip, &sum.path_length, &sum.deposit_mass})
    *value /= n;
  return sum;
}

double largest_distance(const JetState& a, const JetState& b, bool from_the_end) {
  const bool alike = a.beads() == b.beads();
  if (!alike && !from_the_end) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t common = std::min(a.beads(), b.beads()) - (alike ? 0 : 1); // no nozzle
  double largest = 0;
  for (std::size_t k = 1; k <= common; ++k) {
    const Vec3 ra = a.columns().position()[a.beads() - k];
    largest = std::max(largest, (ra - b.columns().position()[b.beads() - k]).norm());
  }
  return largest;
}

double relative(double a, double b) {
  return a == b ? 0 : std::abs(a / b - 1);
}

Run simulate(const Scene& scene, double end_time, double interval) {
  const auto simulation = build_simulation(scene);
  Run run;
  if (interval > 0)
    simulation->add(std::make_unique<Watch>(interval, [&run](const JetSnapshot& snapshot) {
      run.samples.push_back(sample_of(snapshot));
    }));
  simulation->run_until(end_time);
  run.jet = simulation->jet();
  run.statistics = simulation->statistics();
  run.end = sample_of({run.jet.time, std::as_const(run.jet).columns(), run.jet,
                       simulation->ledger(), run.statistics});
  return run;
}

} // namespace ehdjet::validation
