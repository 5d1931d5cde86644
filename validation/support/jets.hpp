#pragma once

#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/build.hpp"
#include "ehdjet/simulation/simulation.hpp"
#include "ehdjet/studies/table2.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// The PVP jets of the paper as scenes, and the quantities that are compared.
namespace ehdjet::validation {

/// scenes/<name>.toml with overrides "table.key=value"; nothing is recorded unless asked for.
Scene scene(const std::string& name, const std::vector<std::string>& overrides = {});

/// "none" or "0.8 cm": L~ of a row of the paper's Table 2.
std::string name_of(const Table2Row& row);

/// The jet as a whole at one instant.
struct Sample {
  double time = 0, beads = 0; ///< [s], links of the chain
  double tip = 0;             ///< distance of the leading bead from the axis [m]
  double path_length = 0;     ///< [m]
  double deposit_mass = 0;    ///< what has left the chain [kg]
};
Sample sample_of(const JetSnapshot& snapshot);
double path_length(ConstVec3View r); // [m]

/// Means over the samples from `from` to `to`.
Sample mean(const std::vector<Sample>& samples, double from, double to);

/// Largest distance of a bead from the same bead of another jet [m]. With different numbers of beads
/// it is not a number, unless beads are counted from the leading end: then it is over the beads that
/// both jets have. In a jet that is not refined a bead keeps its place from that end.
double largest_distance(const JetState& a, const JetState& b, bool from_the_end = false);

/// |a/b - 1|; 0 if both are the same number.
double relative(double a, double b);

/// Calls a function at 0, dt, 2 dt, ...
class Watch final : public Observer {
public:
  using Look = std::function<void(const JetSnapshot&)>;
  Watch(double interval, Look look)
      : schedule_(interval)
      , look_(std::move(look)) {}
  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void observe(const JetSnapshot& snapshot) override {
    schedule_.advance();
    look_(snapshot);
  }

private:
  Schedule schedule_;
  Look look_;
};

/// A run, its end and its samples.
struct Run {
  JetState jet; ///< at the end
  Sample end;
  std::vector<Sample> samples; ///< every `interval`
  RunStatistics statistics;
};
/// interval: between samples [s]; 0: none are taken.
Run simulate(const Scene& scene, double end_time, double interval = 0);

} // namespace ehdjet::validation
