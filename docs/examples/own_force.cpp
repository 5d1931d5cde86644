// A jet in a wind of one's own: a force that the library does not know, an observer, and a run.
#include <cstdio>
#include <ehdjet/forces/force_term.hpp>
#include <ehdjet/observers/observer.hpp>
#include <ehdjet/runs/run_scene.hpp>
#include <ehdjet/scene/read_scene.hpp>
#include <memory>

using namespace ehdjet;

/// A linear drag against air that rotates about the axis of the jet,
///
///     F_k = - b (v_k - Omega x r_k)
class Whirl final : public ForceTerm {
public:
  Whirl(double friction, double rate) // b [kg/s], Omega [rad/s]
      : friction_(friction)
      , rate_(rate) {}
  [[nodiscard]] std::string_view name() const override { return "whirl"; }

  void add_force(const Stage& stage, Vec3View force) override {
    const auto r = stage.columns.position(), v = stage.columns.velocity();
    const BeadRange targets = stage.targets.within(stage.beads());
    for (std::size_t k = targets.begin; k < targets.end; ++k) {
      const Vec3 air{0, -rate_ * r[k].z(), rate_ * r[k].y()};
      force.add(k, -friction_ * (v[k] - air));
    }
  }

private:
  double friction_, rate_;
};

int main(int argc, char** argv) {
  if (argc != 3) {
    std::puts("usage: own_force SCENE.toml RUN.h5");
    return 2;
  }
  Scene scene = read_scene(argv[1]);
  scene.config.run.end_time = 2e-3;

  RunOptions options;
  options.extras.forces.push_back(std::make_unique<Whirl>(1e-10, 100.0));
  const RunResult result = run_scene(std::move(scene), argv[2], std::move(options));
  std::printf("%s after %zu steps\n", result.status.c_str(),
              static_cast<std::size_t>(result.statistics.steps));
}
