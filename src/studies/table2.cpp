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

class LinksBefore final : public Observer {
public:
  LinksBefore(double from, Mean& mean)
      : from_(from)
      , mean_(mean) {}
  void refined(const RefinementRecord& record) override {
    if (record.time >= from_) mean_.add(static_cast<double>(record.beads_before - 1), 1);
  }

private:
  double from_;
  Mean& mean_;
};

/// Links in the middle of equal intervals: macro steps are long, and beads are born and land inside.
class LinksInside final : public Observer {
public:
  LinksInside(double from, Mean& all, Mean& stationary)
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
  simulation->add(std::make_shared<LinksBefore>(stationary_from, before));
  if (prepare) prepare(*simulation);

  double time = 0; // at the end of the last step
  auto links = static_cast<double>(simulation->jet().links());
  const bool inside = simulation->statistics().two_rates.has_value();
  if (inside)
    simulation->add(std::make_shared<LinksInside>(stationary_from, all, stationary));
  simulation->after_each_step([&](const Simulation& s) {
    const double now = s.jet().time;
    if (!inside) {
      all.add(links, now - time);
      stationary.add(links, now - std::max(time, stationary_from));
    }
    time = now, links = static_cast<double>(s.jet().links());
    if (after_step) after_step(s);
  });
  simulation->run_until(end_time);
  return {.mean_links = all.value(),
          .stationary_links = stationary.value(),
          .links_before = before.value(),
          .statistics = simulation->statistics()};
}

} // namespace ehdjet
