#include "ehdjet/scene/scene_report.hpp"

#include "support.hpp"

namespace ehdjet {
namespace {

TEST(SceneReport, says_what_the_pvp_scene_will_do) {
  expect_all(scene_report(read_scene(EHDJET_SCENES "/pvp.toml")),
             {"radius = 5e-05", "Q     13.66545847", "H     458.7513676",
              "Fve'  211.6506208", "4.582e-05 s", "external field 56250 V/m",
              "gravity 9.80665", "Coulomb (direct)", "surface tension (paper form)",
              "2001 rows", "201 frames", "rtol 1e-05", "located inside steps"});
}

TEST(SceneReport, is_silent_about_what_a_scene_does_not_have) {
  const std::string report =
      scene_report(read(good_scene, {"field=", "gravity=", "coulomb=", "viscoelasticity=",
                                     "surface_tension=", "output=", "collector="}));
  expect_all(report, {"forces: none", "output: none", "collector: none"});
  for (const char* absent :
       {"Dimensionless", "Fastest", "gravity", "Coulomb", "acceleration"})
    EXPECT_EQ(report.find(absent), std::string::npos) << absent;
}

TEST(SceneReport, warns_of_a_fixed_step_beyond_the_stability_limit) {
  const std::vector<std::string> rk4 = {"integrator.rtol=", "integrator.method=rk4"};
  const auto with_step = [&](const std::string& step) {
    auto all = rk4;
    all.push_back("integrator.step=" + step);
    return scene_report(read(good_scene, all));
  };
  expect_all(with_step("1e-4"), {"WARNING", "integrator.step = 0.0001 s"});
  EXPECT_EQ(with_step("1e-6").find("WARNING: integrator"), std::string::npos);
}

TEST(SceneReport, warns_of_what_a_thread_cannot_be) {
  expect_all(scene_report(read_scene(EHDJET_SCENES "/pvp.toml")),
             {"WARNING: field at the surface of the jet at the nozzle 4.14e+07 V/m",
              "WARNING: electrostatic over capillary pressure at the nozzle 18"});
  expect_all(scene_report(read(good_scene, {"coulomb.near_field=free-surface",
                                            "nozzle.link_length=1.9e-4",
                                            "coulomb.softened_pairs=false"})),
             {"near field (free-surface)",
              "WARNING: coulomb.near_field with surface_tension.form",
              "WARNING: nozzle.link_length = 0.00019 m makes links of less than 4 radii"});
  EXPECT_EQ(scene_report(read(good_scene, {"nozzle.charge_density=0.01"})).find("WARNING"),
            std::string::npos);
}

TEST(SceneReport, of_a_pumped_jet_estimates_what_it_costs) {
  expect_all(scene_report(read_scene(EHDJET_SCENES "/converged.toml")),
             {"fed by a pump at 1.80556e-08 m^3/s and 1.86703e-07 A", "v_s = 2.2989 m/s",
              "softened pairs", "where links are longer than 0.004 m", "beads         762",
              "evaluations   1.1e+05", "wall time", "MB of frames"});
  // sqrt(I/(pi K E)) = sqrt(1.867e-7/(pi 1e-2 71201))
  expect_all(
      scene_report(
          read_scene(EHDJET_SCENES "/converged.toml", {"nozzle.conductivity=1e-2"})),
      {"conduction ends where the jet is thinner than sqrt(I/(pi K E)) = 9.14e-06 m"});
}

TEST(SceneReport, of_a_chain_names_its_beads_and_stiffest_link) {
  expect_all(scene_report(read_scene(EHDJET_SCENES "/chain.toml")),
             {"a chain of 12 beads from chain.csv", "link 6", "nothing is inserted"});
}

} // namespace
} // namespace ehdjet
