#include "ehdjet/simulation/build.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "jetspin/inputs.hpp"
#include "support/scenes.hpp"

// JETSPIN's six examples, imported and run, against what JETSPIN prints for them (data/jetspin/printed.csv). Two
// differences belong to all of them: ehdjet locates insertion and landing, and its steps have a tolerance, so that it has no error
// of the step (JETSPIN: 1e-4 in the velocities at dt = 1e-8 s); and each bead of a pair is divided by its own mass.
namespace ehdjet {
namespace {

using namespace test;

double printed(int example, const std::string& quantity) {
  std::ifstream in(EHDJET_TEST_DATA "/jetspin/printed.csv");
  const std::string start = std::to_string(example) + "," + quantity + ",";
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(start)) return std::stod(line.substr(start.size()));
  throw std::runtime_error("printed.csv has no " + start);
}

/// Time means of a run in JETSPIN's names and units. `yz` is the mean over the beads that land.
class Means {
public:
  Means(const Scene& scene, double from, double to)
      : simulation_(build_simulation(scene)) {
    simulation_->run_until(from);
    constexpr int looks = 500;
    simulation_->add(
        std::make_unique<Watch>((to - from) / looks, [&](const JetSnapshot& s) {
          if (s.time > from) look(s);
        }));
    std::vector<DepositedBead> deposit;
    simulation_->add(std::make_unique<Deposit>(deposit));
    simulation_->run_until(to);
    if (deposit.size() < 2) return;
    const auto beads = static_cast<double>(deposit.size());
    double charge = 0; // of the beads that landed after the first one
    for (const DepositedBead& b : deposit) {
      charge += &b == deposit.data() ? 0 : b.bead.charge;
      sums_["yz"] +=
          looks_ * std::hypot(b.bead.position.y(), b.bead.position.z()) / cm / beads;
    }
    sums_["curc"] = looks_ * charge / statC / (deposit.back().time - deposit.front().time);
  }
  double operator[](const std::string& quantity) const {
    return sums_.at(quantity) / looks_;
  }

private:
  void look(const JetSnapshot& s) {
    looks_ += 1;
    const auto r = s.columns.position();
    for (std::size_t k = 1; k < r.size(); ++k) sums_["lp"] += (r[k] - r[k - 1]).norm() / cm;
    sums_["n"] += static_cast<double>(s.jet.links());
    sums_["vn"] += s.ledger.release_speed / cm, sums_["vc"] += s.ledger.impact_speed / cm;
    sums_["rc"] += s.ledger.collector_radius / cm;
  }

  std::unique_ptr<Simulation> simulation_;
  std::map<std::string, double> sums_;
  double looks_ = 0;
};

void expect(const Means& means, int example,
            std::initializer_list<std::pair<const char*, double>> tolerances) {
  for (const auto& [quantity, tolerance] : tolerances)
    EXPECT_NEAR(means[quantity] / printed(example, quantity), 1, tolerance)
        << "example " << example << ", " << quantity;
}

// JETSPIN's length has an error of 1e-8, ehdjet's at rtol 1e-6 one of 1e-8, too.
TEST(JetspinExamples, start_up_of_a_straight_jet) {
  const Scene scene = example(1);
  const auto simulation = run(scene, scene.config.run.end_time);
  EXPECT_NEAR(simulation->jet().columns().position()[1].x() / (0.319 * cm)
                  / printed(1, "xs"),
              1, 3e-7);
}

// Its rc is the radius of the last link when its bead leaves, after the landing of the next one: 0.8 % more
// than at the landing.
TEST(JetspinExamples, straight_jet) {
  Scene scene = example(2);
  scene.config.integrator.rtol = 1e-5;
  expect(Means(scene, 0.42, 0.52), 2, {{"n", 1e-3}, {"curc", 1e-3}, {"rc", 1e-2}});
}

// rc again: 0.15 %.
TEST(JetspinExamples, whipping_jet) {
  expect(
      Means(example(3), 25e-3, 40e-3), 3,
      {{"n", 3e-4}, {"yz", 3e-4}, {"lp", 3e-4}, {"vn", 2e-4}, {"vc", 1e-4}, {"rc", 2e-3}});
}

// The random force is left out. In JETSPIN it bends the jet at all frequencies, not only at that of the nozzle: distance
// and speed of impact scatter by 9 and 1.4 %, and the jet is longer.
//
// The wind blows ehdjet's first bead aside, before it reaches the collector. It never lands, so that none of the landed beads
// behind it leaves; these still show how beads land. Number and distance are those in still air. A wind of 6 m/s
// changes them by 0.2 and 1.3 %.
TEST(JetspinExamples, whipping_jet_against_the_wind) {
  Scene scene = example(4);
  scene.config.integrator.rtol = 1e-5;
  expect(Means(scene, 14e-3, 18e-3), 4, {{"vn", 0.04}, {"vc", 0.03}, {"rc", 0.09}});
  scene.config.air->velocity.reset();
  expect(Means(scene, 20e-3, 27e-3), 4,
         {{"vn", 0.03}, {"vc", 0.02}, {"rc", 0.06}, {"n", 0.09}, {"yz", 0.08}});
}

// JETSPIN loses mass and charge at each refinement.
TEST(JetspinExamples, refined_jet) {
  Scene scene = example(5);
  scene.config.integrator.rtol = 1e-5;
  expect(Means(scene, 17e-3, 19e-3), 5, {{"n", 0.12}, {"vn", 0.03}, {"vc", 0.08}});
}

// JETSPIN's rate of the stress, G e + (mu/l) dv/dt, has mu e^2 more than that of G ln(l/l0) + mu e. On the way of a link
// this adds up: JETSPIN prints 11 to 13 kPa from the first centimetre on, which never relax. Its jet is held back, slower and
// thicker. This version also softens the Coulomb force. So only the order of magnitude can agree.
TEST(JetspinExamples, kelvin_voigt_jet) {
  Scene scene = example(6);
  scene.config.integrator.rtol = 1e-5;
  const Means means(scene, 15e-3, 20e-3);
  expect(means, 6, {{"n", 0.35}, {"vc", 0.2}, {"rc", 0.2}});
  EXPECT_GT(means["vc"], printed(6, "vc"));
  EXPECT_LT(means["rc"], printed(6, "rc"));
}

} // namespace
} // namespace ehdjet
