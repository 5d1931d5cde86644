#include "ehdjet/studies/table2.hpp"

#include "ehdjet/simulation/build.hpp"

#include <omp.h>

#include <algorithm>
#include <cstdint>
#include <memory>

namespace ehdjet {
namespace {

/// A mean over time of something that changes only at the ends of steps.
class TimeMean {
public:
  explicit TimeMean(double from)
      : from_(from) {}
  void add(double start, double end, double value) {
    const double time = end - std::max(start, from_);
    if (time > 0) sum_ += value * time, time_ += time;
  }
  [[nodiscard]] double value() const { return sum_ / time_; }

private:
  double from_, sum_ = 0, time_ = 0;
};

class BeadsBefore final : public Observer {
public:
  explicit BeadsBefore(double from)
      : from_(from) {}
  void refined(const RefinementRecord& record) override {
    if (record.time >= from_) sum_ += static_cast<double>(record.beads_before), ++count_;
  }
  [[nodiscard]] double mean() const { return sum_ / static_cast<double>(count_); }

private:
  double from_, sum_ = 0;
  std::uint64_t count_ = 0;
};

class ThreadsDuring {
public:
  explicit ThreadsDuring(std::size_t threads) {
    omp_set_num_threads(static_cast<int>(threads));
  }
  ~ThreadsDuring() { omp_set_num_threads(before_); }
  ThreadsDuring(const ThreadsDuring&) = delete;
  ThreadsDuring& operator=(const ThreadsDuring&) = delete;

private:
  int before_ = omp_get_max_threads();
};

} // namespace

Table2Run run_table2(Scene scene, double end_time, double stationary_from,
                     std::size_t threads, const std::function<void(Simulation&)>& prepare,
                     const Simulation::StepHook& after_step) {
  const ThreadsDuring during(threads);
  if (scene.config.refinement) scene.config.output.refinements = RefinementRecords::sums;
  const auto simulation = build_simulation(scene);
  auto observer = std::make_unique<BeadsBefore>(stationary_from);
  const BeadsBefore& before = *observer;
  simulation->add(std::move(observer));
  if (prepare) prepare(*simulation);

  TimeMean all(0), stationary(stationary_from);
  double time = 0;
  auto beads = static_cast<double>(simulation->jet().links());
  simulation->after_each_step([&](const Simulation& s) {
    all.add(time, s.jet().time, beads), stationary.add(time, s.jet().time, beads);
    time = s.jet().time, beads = static_cast<double>(s.jet().links());
    if (after_step) after_step(s);
  });
  simulation->run_until(end_time);
  return {.mean_beads = all.value(),
          .stationary_beads = stationary.value(),
          .beads_before = before.mean(),
          .statistics = simulation->statistics()};
}

} // namespace ehdjet
