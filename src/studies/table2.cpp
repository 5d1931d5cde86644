#include "ehdjet/studies/table2.hpp"

#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/simulation/build.hpp"

#include <algorithm>
#include <memory>

namespace ehdjet {
namespace {

struct Mean {
  double sum = 0, weights = 0;
  void add(double value, double weight) {
    if (weight > 0) sum += value * weight, weights += weight;
  }
  [[nodiscard]] double value() const { return sum / weights; }
};

class BeadsBefore final : public Observer {
public:
  BeadsBefore(double from, Mean& mean)
      : from_(from)
      , mean_(mean) {}
  void refined(const RefinementRecord& record) override {
    if (record.time >= from_) mean_.add(static_cast<double>(record.beads_before), 1);
  }

private:
  double from_;
  Mean& mean_;
};

/// Beads in the middle of equal intervals: macro steps are long, and beads are born and land inside.
class BeadsInside final : public Observer {
public:
  BeadsInside(double from, Mean& all, Mean& stationary)
      : from_(from)
      , all_(all)
      , stationary_(stationary) {}
  [[nodiscard]] double next_time() const override { return (count_ + 0.5) * interval; }
  void observe(const JetSnapshot& s) override {
    const auto links = static_cast<double>(s.columns.beads - 1);
    all_.add(links, 1);
    if (s.time >= from_) stationary_.add(links, 1);
    ++count_;
  }

private:
  static constexpr double interval = 1e-4; // [s]
  double from_;
  double count_ = 0;
  Mean &all_, &stationary_;
};

} // namespace

Table2Run run_table2(Scene scene, double end_time, double stationary_from,
                     std::size_t threads, const std::function<void(Simulation&)>& prepare,
                     const Simulation::StepHook& after_step) {
  const ThreadCount during(threads);
  if (scene.config.refinement) scene.config.output.refinements = RefinementRecords::sums;
  const auto simulation = build_simulation(scene);
  Mean all, stationary, before;
  simulation->add(std::make_shared<BeadsBefore>(stationary_from, before));
  if (prepare) prepare(*simulation);

  double time = 0; // at the end of the last step
  auto beads = static_cast<double>(simulation->jet().links());
  const bool inside = simulation->statistics().two_rates.has_value();
  if (inside)
    simulation->add(std::make_shared<BeadsInside>(stationary_from, all, stationary));
  simulation->after_each_step([&](const Simulation& s) {
    const double now = s.jet().time;
    if (!inside) {
      all.add(beads, now - time);
      stationary.add(beads, now - std::max(time, stationary_from));
    }
    time = now, beads = static_cast<double>(s.jet().links());
    if (after_step) after_step(s);
  });
  simulation->run_until(end_time);
  return {.mean_beads = all.value(),
          .stationary_beads = stationary.value(),
          .beads_before = before.value(),
          .statistics = simulation->statistics()};
}

} // namespace ehdjet
