#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "io/fabricated_run.hpp"

namespace ehdjet::testing {
namespace {

RefinementRecord record(int i) {
  return {.time = 1e-3 * i,
          .kept = static_cast<std::size_t>(20 + i),
          .beads_before = static_cast<std::size_t>(100 + i),
          .beads_after = static_cast<std::size_t>(200 + i),
          .change = {.mass = 1e-20 * i,
                     .charge = 2e-20 * i,
                     .volume = 3e-20 * i,
                     .momentum = Vec3(4e-9, 5e-9, 6e-9) * i,
                     .kinetic_energy = -7e-9 * i,
                     .elastic_energy = -8e-9 * i,
                     .coulomb_energy = 9e-9 * i},
          .worst_link = 0.01 * i};
}

TEST(RefinementRecords, come_back_as_they_were_written) {
  for (const bool with_coulomb : {false, true}) {
    const Folder folder;
    {
      const auto file =
          std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
      const auto observer = record_refinements(file, with_coulomb);
      for (int i = 1; i <= 300; ++i) observer->refined(record(i)); // more than one chunk
      RunStatistics statistics;
      statistics.refinements = 300;
      file->finish("complete", "", statistics, {});
    }
    const RunReader run(folder / "run.h5");
    ASSERT_TRUE(run.has("refinements"));
    EXPECT_FALSE(run.has("resolving_power"));
    const RunTable t = run.table("refinements");
    ASSERT_EQ(t.rows(), 300U);
    const RefinementRecord last = record(300);
    EXPECT_EQ(t["time"].back(), last.time);
    EXPECT_EQ(t["kept"].back(), 320);
    EXPECT_EQ(t["beads_before"].back(), 400);
    EXPECT_EQ(t["beads_after"].back(), 500);
    EXPECT_EQ(t["mass_change"].back(), last.change.mass);
    EXPECT_EQ(t["charge_change"].back(), last.change.charge);
    EXPECT_EQ(t["volume_change"].back(), last.change.volume);
    EXPECT_EQ(t["momentum_change_x"].back(), last.change.momentum.x());
    EXPECT_EQ(t["momentum_change_y"].back(), last.change.momentum.y());
    EXPECT_EQ(t["momentum_change_z"].back(), last.change.momentum.z());
    EXPECT_EQ(t["kinetic_energy_change"].back(), last.change.kinetic_energy);
    EXPECT_EQ(t["elastic_energy_change"].back(), last.change.elastic_energy);
    EXPECT_EQ(t["worst_link"].back(), last.worst_link);
    EXPECT_EQ(t.find("coulomb_energy_change") != nullptr, with_coulomb);

    TextOutput output(folder / "out.csv", false);
    export_table(run, "refinements", output);
    const std::string text = text_of(folder / "out.csv");
    EXPECT_EQ(text.find("coulomb_energy_change_j") != std::string::npos, with_coulomb);
    const std::string row = text.substr(text.find('\n') + 1);
    EXPECT_EQ(row.substr(0, row.find('\n')).rfind("0.001,21,101,201,", 0), 0U) << row;
  }
}

TEST(RefinementRecords, are_missed_with_the_key_that_asks_for_them) {
  const Folder folder;
  write_run(folder / "run.h5", 1);
  const RunReader run(folder / "run.h5");
  try {
    (void)run.table("refinements");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("output.refinements"), std::string::npos);
  }
  EXPECT_THROW((void)run.resolving_power(), InputError);
}

/// Two numbers that follow from the time.
class MadeUp final : public Accounts {
public:
  [[nodiscard]] std::span<const Column> columns() const override { return columns_; }
  void measure(const JetSnapshot& snapshot, std::span<double> row) override {
    row[0] = 2 * snapshot.time, row[1] = -snapshot.time;
  }

private:
  std::vector<Column> columns_{{"work", "J", "made up"}, {"impulse", "kg m/s", "made up"}};
};

TEST(AccountBook, keeps_columns_in_their_order_with_their_units) {
  const Folder folder;
  const auto accounts = std::make_shared<MadeUp>();
  {
    const auto file =
        std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
    const auto observer = record_budget(file, 0.5, accounts);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(observer->next_time(), 0.5 * i);
      FabricatedJet made;
      made.time = 0.5 * i;
      observer->observe(made.snapshot());
    }
    file->finish("complete", "", {}, {});
  }
  const RunReader run(folder / "run.h5");
  ASSERT_TRUE(run.has("budget"));
  const RunTable t = run.table("budget");
  EXPECT_EQ(t["time"], (std::vector<double>{0, 0.5, 1}));
  std::vector<std::string> names, units;
  for (const RunTable::Column& c : t.columns)
    names.push_back(c.name), units.push_back(c.unit);
  EXPECT_EQ(names, (std::vector<std::string>{"time", "work", "impulse"}));
  EXPECT_EQ(units, (std::vector<std::string>{"s", "J", "kg m/s"}));
  EXPECT_EQ(t["work"], (std::vector<double>{0, 1, 2}));
  TextOutput output(folder / "out.csv", false);
  export_table(run, "budget", output);
  EXPECT_EQ(text_of(folder / "out.csv"),
            "time_s,work_j,impulse_kg_m_s\n0,0,-0\n0.5,1,-0.5\n1,2,-1\n");
}

/// A straight jet with links of 1, 2, 3 ... times `unit`.
FabricatedJet straight_jet(std::size_t links, double unit, double time) {
  FabricatedJet made;
  made.time = time;
  made.jet.mass.assign(links + 1, 1.0);
  made.jet.charge = made.jet.volume = made.jet.mass;
  made.values.assign(6 * (links + 1), 0.0);
  for (std::size_t k = 1; k <= links; ++k)
    made.values[k] = made.values[k - 1] + unit * static_cast<double>(k);
  return made;
}

TEST(ResolvingPower, is_that_of_the_link_at_each_lambda_averaged_over_the_later_half) {
  const Folder folder;
  constexpr double l = 2e-4;
  {
    const auto file =
        std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
    const auto observer = record_resolving_power(file, 1e-3, l);
    for (int i = 0; i <= 10; ++i) { // the first half is to be ignored
      const double unit = i < 5 ? 1e-5 : i % 2 == 0 ? l : 2 * l;
      observer->observe(straight_jet(4, unit, 1e-3 * i).snapshot());
    }
    file->finish("complete", "", {}, {});
  }
  const RunReader run(folder / "run.h5");
  const ResolvingPowerTable t = run.resolving_power();
  ASSERT_EQ(t.lambda.size(), 101U);
  ASSERT_EQ(t.time.size(), 11U);
  ASSERT_EQ(t.r.size(), 11U * 101U);
  EXPECT_EQ(t.lambda.front(), 0);
  EXPECT_EQ(t.lambda.back(), 1);
  // Links of 1, 2, 3, 4 units end at lambda = 0.1, 0.3, 0.6, 1.
  const auto power = [&](int sample, int place) {
    return t.r[static_cast<std::size_t>(sample * 101 + place)];
  };
  EXPECT_DOUBLE_EQ(power(6, 0), 1);
  EXPECT_DOUBLE_EQ(power(6, 5), 1);
  EXPECT_DOUBLE_EQ(power(6, 20), 1.0 / 2);
  EXPECT_DOUBLE_EQ(power(6, 50), 1.0 / 3);
  EXPECT_DOUBLE_EQ(power(6, 100), 1.0 / 4);
  EXPECT_DOUBLE_EQ(power(5, 100), 1.0 / 8);

  TextOutput output(folder / "r.csv", false);
  export_resolving_power(run, {}, output);
  const std::string text = text_of(folder / "r.csv");
  EXPECT_EQ(text.rfind("lambda,mean_r,min_r\n0,", 0), 0U);
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
  double lambda = 0, mean = 0, least = 0;
  ASSERT_EQ(std::sscanf(text.c_str() + last, "%lf,%lf,%lf", &lambda, &mean, &least), 3);
  EXPECT_EQ(lambda, 1);
  EXPECT_NEAR(mean, (3 * 0.125 + 3 * 0.25) / 6, 1e-15); // samples 5 to 10
  EXPECT_DOUBLE_EQ(least, 0.125);

  TextOutput later(folder / "later.csv", false);
  EXPECT_THROW(export_resolving_power(run, 1.0, later), InputError);
}

TEST(ResolvingPower, takes_the_link_across_an_embryo_as_one) {
  const Folder folder;
  constexpr double l = 1e-3;
  {
    const auto file =
        std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
    const auto observer = record_resolving_power(file, 1, l);
    FabricatedJet made = straight_jet(3, l, 0); // beads at 0, 1, 3, 6 l
    made.jet.has_embryo = true;
    observer->observe(made.snapshot());
    file->finish("complete", "", {}, {});
  }
  const ResolvingPowerTable t = RunReader(folder / "run.h5").resolving_power();
  EXPECT_DOUBLE_EQ(t.r[0], 1.0 / 3);
}

} // namespace
} // namespace ehdjet::testing
