#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"
#include "ehdjet/refinement/refine_jet.hpp"
#include "ehdjet/run_files/run_reader.hpp"
#include "ehdjet/runs/run_scene.hpp"
#include "ehdjet/scene/chain_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include "support/refined.hpp"

// A feature brings columns of its own: one class, nothing else in the library knows of it.
namespace ehdjet {
namespace {

using namespace test;

constexpr double solvent_at_birth = 0.4 * pvp::volume;

/// Solvent in each link [m^3], how old the fluid in it is [s], the way that each bead has come [m],
/// and a mark. Exerts no force.
class Drying final : public ForceTerm {
public:
  /// Fluid ages `haste` times as fast as time passes, from some time on.
  explicit Drying(double haste = 1, double from = 0)
      : haste_(haste)
      , from_(from) {}

  [[nodiscard]] std::vector<BeadColumn> columns() const override {
    return {{.name = "solvent",
             .unit = "m^3",
             .description = "of the link",
             .evolution = Evolution::carried,
             .remap = ColumnRemap::share,
             .at_birth = solvent_at_birth},
            {.name = "mark",
             .unit = "1",
             .description = "of the link",
             .evolution = Evolution::carried,
             .remap = ColumnRemap::label,
             .at_birth = 7},
            {.name = "age",
             .unit = "s",
             .description = "of the fluid",
             .weight = "solvent",
             .error_scale = 1e-3},
            {.name = "way",
             .unit = "m",
             .description = "that the bead has come",
             .owner = Owner::bead,
             .error_scale = 1e-3}};
  }
  void bind(const BeadTable& table) override {
    age_ = table.find_integrated("age").value(),
    way_ = table.find_integrated("way").value();
  }
  void add_force(const Stage&, Vec3View) override {}
  void set_column_rates(const Stage& stage, JetColumns<double> rates) override {
    const bool hasty = stage.time >= from_;
    std::ranges::fill(rates.column(age_), hasty ? haste_ : 1);
    const auto v = stage.columns.velocity();
    for (std::size_t k = 0; k < rates.beads; ++k) rates.column(way_)[k] = v[k].norm();
  }
  [[nodiscard]] std::string_view name() const override { return "drying"; }

private:
  double haste_, from_;
  std::size_t age_ = 0, way_ = 0;
};

Extras own(double haste = 1, double from = 0) {
  Extras extras;
  extras.forces.push_back(std::make_unique<Drying>(haste, from));
  return extras;
}
std::unique_ptr<Simulation> drying(const Scene& scene, double haste = 1, double from = 0) {
  return build_simulation(scene, own(haste, from));
}

std::span<const double> integrated(const JetState& jet, const char* name) {
  return jet.columns().column(jet.table->find_integrated(name).value());
}
const std::vector<double>& carried(const JetState& jet, const char* name) {
  return jet.carried(jet.table->find_carried(name).value());
}
/// The place of a column among the declared ones of a bead.
double declared(const JetState& jet, const Bead& bead, const std::string& name) {
  const auto all = jet.table->declared();
  const auto found = std::ranges::find(all, name, &BeadColumn::name);
  return bead.declared.at(static_cast<std::size_t>(found - all.begin()));
}
double sum_of(const std::vector<double>& column) {
  CompensatedSum total;
  for (std::size_t k = 1; k < column.size(); ++k) total += column[k];
  return total;
}

TEST(OwnColumns, are_integrated_and_leave_the_jet_as_it_is) {
  const GoldenChain golden("free");
  const auto dry = drying(golden.scene), plain = run(golden.scene, 1e-4);
  dry->run_until(1e-4);
  const JetState& jet = dry->jet();
  for (std::size_t k = 1; k < jet.beads(); ++k)
    EXPECT_NEAR(integrated(jet, "age")[k] / 1e-4, 1, 1e-13) << k;
  EXPECT_EQ(integrated(jet, "age")[0], 0); // no link
  EXPECT_GT(integrated(jet, "way")[0], 0);
  EXPECT_LT(largest_distance(jet, plain->jet()), 1e-12);
  EXPECT_EQ(plain->jet().table->declared().size(), 1U);
}

TEST(OwnColumns, of_a_bead_at_rest_rest) {
  const GoldenChain golden("held");
  const auto dry = drying(golden.scene);
  dry->run_until(1e-5);
  EXPECT_EQ(integrated(dry->jet(), "way")[0], 0);
  EXPECT_GT(integrated(dry->jet(), "way")[1], 0);
}

/// Five links of which those below the second are long, two marks.
JetState marked_jet() {
  BeadTable table;
  for (const BeadColumn& column : Drying().columns()) table.declare(column);
  JetState jet = blank_jet(std::make_shared<BeadTable>(table), 6);
  for (std::size_t k = 0; k < 6; ++k) {
    const double x = k < 3 ? 0.1 * static_cast<double>(k) : static_cast<double>(k) - 1.8;
    jet.columns().position().set(k, {x, 0, 0});
    jet.volume[k] = 1, jet.mass[k] = 2, jet.charge[k] = 3;
    jet.carried(3)[k] = static_cast<double>(k * k);           // solvent
    jet.carried(4)[k] = k < 4 ? 1 : 2;                        // mark
    jet.columns().column(6)[k] = 10 + static_cast<double>(k); // age
  }
  return jet;
}

TEST(OwnColumns, follow_a_refinement_by_either_remap) {
  for (const LinkRemap remap : {LinkRemap::conservative, LinkRemap::paper}) {
    JetState jet = marked_jet();
    const double before = sum_of(carried(jet, "solvent"));
    RefinementRule rule;
    rule.length = 0.25, rule.remap = remap;
    ASSERT_TRUE(refine_jet(jet, rule));
    ASSERT_EQ(jet.links(), 14U);
    EXPECT_NEAR(sum_of(carried(jet, "solvent")) / before, 1, 1e-14);
    if (remap == LinkRemap::conservative) {
      EXPECT_NEAR(carried(jet, "solvent")[14], 25. / 4, 1e-12);
    } else { // with the volume
      EXPECT_NEAR(carried(jet, "solvent")[14] / jet.volume[14], 50. / 3, 1e-12);
    }
    for (std::size_t k = 3; k < jet.beads(); ++k)
      EXPECT_EQ(carried(jet, "mark")[k], k < 7 ? 1 : 2) << k;
    EXPECT_EQ(integrated(jet, "age").back(), 15);
    EXPECT_TRUE(std::ranges::is_sorted(integrated(jet, "age")));
  }
}

TEST(OwnColumns, can_keep_their_weighted_sum_in_a_refinement) {
  JetState jet = marked_jet();
  auto table = std::make_shared<BeadTable>(*jet.table);
  table->set_remap("age", ColumnRemap::conservative);
  jet.table = table;
  const auto weighted = [](const JetState& j) {
    double total = 0;
    for (std::size_t k = 1; k < j.beads(); ++k)
      total += carried(j, "solvent")[k] * integrated(j, "age")[k];
    return total;
  };
  const double before = weighted(jet);
  RefinementRule rule;
  rule.length = 0.25;
  ASSERT_TRUE(refine_jet(jet, rule));
  EXPECT_NEAR(weighted(jet) / before, 1, 1e-14);
}

TEST(OwnColumns, are_joined_with_the_links) {
  JetState jet = marked_jet();
  RefinementRule rule;
  rule.coarsen = 3.0, rule.has_nozzle = false;
  ASSERT_TRUE(coarsen_jet(jet, rule));
  ASSERT_EQ(jet.links(), 3U); // 1 + 2, 3 + 4, 5
  EXPECT_EQ(carried(jet, "solvent"), (std::vector<double>{0, 1 + 4, 9 + 16, 25}));
  EXPECT_EQ(carried(jet, "mark"), (std::vector<double>{1, 1, 2, 2}));
  EXPECT_NEAR(integrated(jet, "age")[2], (9. * 13 + 16. * 14) / 25, 1e-14);
}

TEST(OwnColumns, begin_with_what_they_have_at_birth) {
  Scene scene = case_one();
  const auto dry = drying(scene);
  dry->run_until(2e-3);
  const JetState& jet = dry->jet();
  ASSERT_GT(jet.beads(), 4U);
  for (std::size_t k = 1; k < jet.beads(); ++k) {
    EXPECT_EQ(carried(jet, "solvent")[k], solvent_at_birth) << k;
    EXPECT_EQ(carried(jet, "mark")[k], 7) << k;
    // Fluid ages from the release of its bead on.
    if (k + 1 < jet.beads()) {
      EXPECT_LT(integrated(jet, "age")[k], integrated(jet, "age")[k + 1]);
    }
  }
  EXPECT_NEAR(integrated(jet, "age").back() / 2e-3, 1, 1e-12);
}

/// A refined jet whose collector is near, over some landings.
Scene landing_jet() {
  Scene scene = refined_case(0.4e-3, 1e-4);
  scene.config.collector->distance = 1e-2;
  scene.config.field = FieldConfig{.potential = {}, .strength = 5.6e4};
  return scene;
}
constexpr double landed = 6e-3;

TEST(OwnColumns, end_in_the_deposit_with_what_they_had_at_the_landing) {
  const auto dry = drying(landing_jet());
  std::vector<DepositedBead> deposit;
  dry->add(std::make_unique<Deposit>(deposit));
  dry->run_until(landed);
  ASSERT_GT(deposit.size(), 3U);
  ASSERT_GT(dry->statistics().refinements.value_or(0), 0U);
  CompensatedSum solvent;
  for (const DepositedBead& d : deposit) {
    solvent += declared(dry->jet(), d.bead, "solvent");
    EXPECT_EQ(declared(dry->jet(), d.bead, "mark"), 7);
    EXPECT_GT(declared(dry->jet(), d.bead, "way"), 9e-3);
    EXPECT_LE(declared(dry->jet(), d.bead, "age"), d.time * (1 + 1e-12));
  }
  solvent += sum_of(carried(dry->jet(), "solvent"));
  const double inserted = static_cast<double>(dry->ledger().inserted_beads);
  EXPECT_NEAR(solvent / (inserted * solvent_at_birth), 1, 1e-12);
}

class KeepCheckpoints final : public Observer {
public:
  explicit KeepCheckpoints(std::vector<Checkpoint>& kept)
      : kept_(kept) {}
  void checkpoint(const Checkpoint& checkpoint) override { kept_.push_back(checkpoint); }

private:
  std::vector<Checkpoint>& kept_;
};

TEST(OwnColumns, go_on_from_a_checkpoint_with_the_same_bits) {
  const auto whole = drying(landing_jet());
  std::vector<Checkpoint> checkpoints;
  whole->make_checkpoints(1e-3);
  whole->add(std::make_shared<KeepCheckpoints>(checkpoints));
  whole->run_until(landed);
  ASSERT_GE(checkpoints.size(), 3U);
  const auto rest = drying(landing_jet());
  rest->make_checkpoints(1e-3);
  rest->restore(checkpoints[1]);
  rest->run_until(landed);
  EXPECT_EQ(rest->jet().y, whole->jet().y);
  for (std::size_t c = 0; c < whole->jet().table->carried().size(); ++c)
    EXPECT_EQ(rest->jet().carried(c), whole->jet().carried(c)) << c;
}

TEST(OwnColumns, of_a_checkpoint_must_be_those_of_the_scene) {
  const Scene scene = case_one();
  const auto complaint = [](Simulation& made, Simulation& restored) {
    std::vector<Checkpoint> checkpoints;
    made.make_checkpoints(1e-5);
    made.add(std::make_shared<KeepCheckpoints>(checkpoints));
    made.run_until(5e-5);
    try {
      restored.restore(checkpoints.at(0));
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("(accepted)");
  };
  EXPECT_EQ(complaint(*drying(scene), *build_simulation(scene)),
            "the checkpoint has a column age, which the scene does not have");
  EXPECT_EQ(complaint(*build_simulation(scene), *drying(scene)),
            "the checkpoint has no column age, which the scene has");
}

TEST(OwnColumns, are_named_when_they_end_a_run) {
  Scene scene = GoldenChain("free").scene;
  scene.config.integrator.min_step = 1e-8;
  const auto failure = [](Simulation& simulation) {
    try {
      simulation.run_until(1e-3);
    } catch (const RunError& e) {
      return std::string(e.what());
    }
    return std::string("(none)");
  };
  const auto jump = drying(scene, 1e12, 2e-5);
  EXPECT_NE(failure(*jump).find("where age of bead"), std::string::npos) << failure(*jump);
  const auto nothing = drying(scene, std::nan(""), 2e-5);
  EXPECT_NE(failure(*nothing).find("the age rate of drying is not a number"),
            std::string::npos)
      << failure(*nothing);
}

TEST(OwnColumns, are_read_from_chain_files) {
  const auto path = std::filesystem::temp_directory_path()
                    / ("ehdjet_own_columns_" + std::to_string(::getpid()) + ".csv");
  const auto jet_of = [&](const std::string& second) {
    std::ofstream(path) << "x_m,y_m,z_m,mass_kg,charge_c,volume_m3,solvent_m3,age_s,note\n"
                           "0,0,0,1e-9,0,0,0,0,first\n1e-3,0,0,1e-9,0,1e-12,"
                        << second << ",second\n";
    Scene scene = chain_scene();
    scene.chain = read_chain(path);
    std::filesystem::remove(path);
    return drying(scene)->jet();
  };
  const JetState jet = jet_of("5e-13,0.25");
  EXPECT_EQ(carried(jet, "solvent")[1], 5e-13);
  EXPECT_EQ(integrated(jet, "age")[1], 0.25);
  EXPECT_EQ(carried(jet, "mark")[1], 0); // not in the file
  try {
    (void)jet_of("much,0.25");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(":3:23: solvent_m3 = \"much\": must be a number"),
              std::string::npos)
        << e.what();
  }
}

TEST(OwnColumns, are_in_run_files_and_in_what_is_made_of_them) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path()
      / ("ehdjet_own_columns_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  Scene scene = landing_jet();
  scene.config.run.end_time = landed;
  scene.config.output.frames = 1e-3, scene.config.output.deposit = true;
  RunOptions options;
  options.extras = own();
  const RunResult end = run_scene(scene, folder / "run.h5", std::move(options));
  const RunReader run(folder / "run.h5");

  const Frame frame = run.frame(run.nearest_frame(landed));
  EXPECT_EQ(frame.find("solvent")->unit, "m^3");
  EXPECT_EQ(frame["solvent"], carried(end.jet, "solvent"));
  EXPECT_EQ(frame["mark"], carried(end.jet, "mark"));
  EXPECT_TRUE(std::ranges::equal(frame["age"], integrated(end.jet, "age")));
  const RunTable deposit = run.table("deposit");
  ASSERT_GT(deposit.rows(), 3U);
  EXPECT_EQ(deposit["mark"], std::vector<double>(deposit.rows(), 7));
  for (std::size_t k = 0; k < deposit.rows(); ++k) EXPECT_GT(deposit["way"][k], 9e-3) << k;

  const auto first_line = [&](const char* name, const auto& write) {
    TextOutput output(folder / name, false);
    write(output);
    std::ifstream text(folder / name);
    std::string line;
    std::getline(text, line);
    return line;
  };
  EXPECT_EQ(first_line("beads.csv", [&](TextOutput& o) { export_beads(run, landed, o); }),
            "bead,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,stress_pa,radius_m,volume_m3,mass_kg,"
            "charge_c,landed,embryo,age_s,mark,solvent_m3,way_m");
  EXPECT_EQ(
      first_line("deposit.csv", [&](TextOutput& o) { export_table(run, "deposit", o); }),
      "time_s,removal_time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,stress_pa,"
      "landing_radius_m,radius_m,mass_kg,charge_c,volume_m3,age_s,mark,solvent_m3,"
      "way_m,arc_length_m");
  export_vtk(run, landed, folder / "run.pvd", false);
  EXPECT_TRUE(std::filesystem::exists(folder / "run_vtk" / "frame_000006.vtp"));

  // Both are chains again.
  for (const char* name : {"run.h5", "beads.csv"}) {
    if (name == std::string("beads.csv") && end.jet.has_embryo) continue; // is refused
    Scene chain = chain_scene();
    chain.config.viscoelasticity = scene.config.viscoelasticity;
    chain.chain = read_chain(folder / name);
    const JetState again = drying(chain)->jet();
    const std::size_t n = again.beads() - 1, last = end.jet.beads() - 1;
    EXPECT_EQ(carried(again, "solvent")[n], carried(end.jet, "solvent")[last]);
    EXPECT_EQ(carried(again, "mark")[n], 7);
    EXPECT_EQ(integrated(again, "age")[n], integrated(end.jet, "age")[last]);
    EXPECT_EQ(integrated(again, "stress")[n], integrated(end.jet, "stress")[last]);
  }
  std::filesystem::remove_all(folder);
}

TEST(OwnColumns, have_names_of_their_own) {
  for (const char* name : {"stress", "x", "mass"}) {
    BeadTable table = *table_with_stress();
    EXPECT_THROW(table.declare({.name = name, .unit = "1", .description = ""}),
                 ContractViolation)
        << name;
  }
  BeadTable table;
  EXPECT_THROW(
      table.declare({.name = "heat", .unit = "J", .description = "", .weight = "solvent"}),
      ContractViolation);
  EXPECT_THROW(
      table.declare(
          {.name = "heat", .unit = "J", .description = "", .remap = ColumnRemap::share}),
      ContractViolation);
}

} // namespace
} // namespace ehdjet
