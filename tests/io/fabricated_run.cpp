#include "io/fabricated_run.hpp"

#include <memory>
#include <random>

namespace ehdjet::testing {

FabricatedJet fabricated_jet(std::uint64_t k, bool with_stress) {
  std::mt19937_64 bits(k);
  std::uniform_real_distribution<double> number(0.1, 1);
  FabricatedJet made;
  made.time = static_cast<double>(k) * 1e-5;
  const std::size_t beads = 2 + k * 13 % 61;
  JetState& jet = made.jet;
  for (std::size_t i = 0; i < beads; ++i) {
    jet.mass.push_back(1e-10 * number(bits));
    jet.charge.push_back(1e-12 * number(bits));
    jet.volume.push_back(1e-13 * number(bits));
  }
  if (with_stress) jet.table = test::table_with_stress();
  jet.y.assign((with_stress ? 7 : 6) * beads, -1e300);
  for (std::size_t i = 0; i < jet.y.size(); ++i) made.values.push_back(number(bits) - 0.5);
  jet.has_embryo = beads > 2 && k % 3 == 1;
  if (beads > 4 && k % 4 == 0) jet.landed = {{beads - 2, 0, 0}, {beads - 1, 0, 0}};
  made.ledger.inserted_beads = k;
  made.ledger.inserted_charge = 2e-12 * static_cast<double>(k);
  made.ledger.impact_speed = number(bits);
  made.statistics.evaluations = 700 * k;
  return made;
}

Checkpoint fabricated_checkpoint(std::uint64_t k) {
  const auto x = static_cast<double>(k);
  Checkpoint c;
  c["time"] = {x};
  c["y"].assign(3000 + 4000 * (k % 3), x);
  c["perhaps"].assign(k % 2, x);
  return c;
}

Provenance fabricated_provenance() {
  return {"scenes/made up.toml",
          "given = \"ä\"\n",
          "resolved = 1\n",
          {{"version", "0.1.0"}, {"threads", "2"}}};
}

DepositedBead fabricated_deposit(std::uint64_t k) {
  std::mt19937_64 bits(k + 1000);
  std::uniform_real_distribution<double> number(0.1, 1);
  DepositedBead made;
  made.time = number(bits), made.removal_time = number(bits);
  made.bead.position = {number(bits), number(bits), number(bits)};
  made.bead.velocity = {number(bits), number(bits), number(bits)};
  made.bead.declared = {number(bits)}, made.bead.volume = number(bits);
  made.bead.mass = number(bits), made.bead.charge = number(bits);
  made.landing_radius = number(bits), made.radius = number(bits);
  return made;
}

void write_run(const std::filesystem::path& path, std::size_t frames, bool with_stress) {
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  const auto observables = record_observables(file, 1e-5),
             deposit = record_deposit(file, test::table_with_stress());
  const auto shown = record_frames(
      file, 1e-5, with_stress ? *test::table_with_stress() : *BeadTable::basic());
  FabricatedJet jet;
  for (std::size_t k = 0; k < frames; ++k) {
    jet = fabricated_jet(k, with_stress);
    observables->observe(jet.snapshot());
    shown->observe(jet.snapshot());
    deposit->deposit(fabricated_deposit(k));
  }
  file->finish("complete", "all is well", jet.statistics, jet.ledger);
}

void expect_intact(const RunReader& run, std::uint64_t flushed) {
  EXPECT_EQ(run.scene("resolved"), "resolved = 1\n");
  const std::size_t frames = run.has("frames") ? run.frame_times().size() : 0;
  ASSERT_GE(frames, flushed);
  for (std::size_t k = 0; k < frames; ++k) {
    const FabricatedJet made = fabricated_jet(k);
    const Frame read = run.frame(k);
    const auto velocity = made.snapshot().columns.velocity();
    ASSERT_EQ(read.time, made.time);
    ASSERT_EQ(read["vz"], std::vector<double>(velocity.z.begin(), velocity.z.end()));
    ASSERT_EQ(read["charge"], made.jet.charge);
  }
  ASSERT_GE(run.has("observables") ? run.column("observables", "evaluations").size() : 0,
            flushed);
  const RunTable deposit = run.has("deposit") ? run.table("deposit") : RunTable{};
  ASSERT_GE(deposit.rows(), flushed);
  for (std::size_t k = 0; k < deposit.rows(); ++k) {
    ASSERT_EQ(deposit["volume"][k], fabricated_deposit(k).bead.volume);
  }
}

} // namespace ehdjet::testing
