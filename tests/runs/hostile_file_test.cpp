#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"
#include "ehdjet/io/plot_page.hpp"
#include "ehdjet/run_files/run_reader.hpp"
#include "ehdjet/runs/run_scene.hpp"
#include "ehdjet/scene/chain_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/fabricated_run.hpp"
#include "support/mutant.hpp"

// Run files that somebody has changed. Whoever reads one gets what was written or a message that names the file;
// nothing crashes, hangs, takes all memory or goes on with numbers that are none.
namespace ehdjet {
namespace {

namespace fs = std::filesystem;
using test::Mutation;
using testing::Folder;

const std::string near_collector = "collector.distance=0.004",
                  weak_field = "field.potential=225";

struct Original {
  const char* scene;
  std::vector<std::string> overrides;
  double end_time;
};
const std::vector<Original> originals{
    {"pvp",
     {near_collector, weak_field, "output.budget=1e-3", "output.resolving_power=1e-3"},
     6e-3},
    {"table2_02",
     {"collector.distance=0.01", "field.potential=560", "coulomb.solver=auto",
      "coulomb.check_every=50", "integrator.method=auto", "refinement.interval=1e-4"},
     6e-3},
    {"pvp", {"integrator.method=two-rate", "integrator.inner_beads=8"}, 5e-3},
    {"array_3x3", {"array.rows=1", "array.columns=2", near_collector, weak_field}, 4.5e-3},
    {"drum",
     {near_collector, weak_field, "collector.charge=kept-on-mat", "coulomb.solver=treecode",
      "field.waveform=square", "field.frequency=1000"},
     5e-3}};

bool is_finite(const JetState& jet) {
  return all_finite(jet.y) && all_finite(jet.mass) && all_finite(jet.charge);
}

/// The jets after so many steps from the last checkpoint, one after the other.
std::vector<double> steps_on(const Scene& scene, const fs::path& file, const fs::path& to) {
  constexpr int most_attempts = 30;
  int attempts = 0;
  RunOptions options;
  options.continue_from = file, options.overwrite = true, options.threads = 1;
  options.interrupted = [&]() -> const char* {
    return ++attempts > most_attempts ? "the test" : nullptr;
  };
  RunResult end = run_scene(scene, to, std::move(options));
  EXPECT_TRUE(is_finite(end.jet));
  std::vector<double> all = end.jet.y;
  for (const JetState& jet : end.array) {
    EXPECT_TRUE(is_finite(jet));
    all.insert(all.end(), jet.y.begin(), jet.y.end());
  }
  return all;
}

/// Everything that reads a run file.
void read_all(const fs::path& file, const fs::path& folder,
              const std::function<void(const std::function<void()>&)>& trying) {
  std::optional<RunReader> run; // opened once: that takes longer than reading
  trying([&] { run.emplace(file); });
  trying([&] { (void)read_chain(file); });
  if (!run) return;
  const auto to_file = [&](auto exporting) {
    trying([&] {
      TextOutput output(folder / "out.csv", true);
      exporting(output);
    });
  };
  for (const char* part : {"observables", "deposit", "refinements", "budget"})
    to_file([&](TextOutput& output) { export_table(*run, part, output); });
  to_file([&](TextOutput& output) { export_beads(*run, {}, output); });
  to_file([&](TextOutput& output) { export_resolving_power(*run, {}, output); });
  to_file([&](TextOutput& output) { export_xyz(*run, {}, output); });
  trying([&] { export_vtk(*run, {}, folder / "out.pvd", true); });
  trying([&] { (void)PlotPage({{&*run, "run"}}, "", {}).draw({}); });
  trying([&] { (void)run->attribute("status"); });
}

// Files per original: more for a longer trial, fewer where the sanitizers are slow.
std::uint64_t number_of_mutants() {
  const char* given = std::getenv("EHDJET_MUTANTS");
  return given == nullptr ? 420 : std::stoull(given);
}

class HostileFile : public ::testing::TestWithParam<std::size_t> {};

TEST_P(HostileFile, is_refused_or_gives_what_was_written) {
  const std::uint64_t mutants = number_of_mutants();
  const Folder folder;
  const Original& original = originals[GetParam()];
  std::vector<std::string> overrides = original.overrides;
  for (const char* more :
       {"output.frames=2e-3", "output.observables=1e-3", "output.checkpoints=1e-3"})
    overrides.emplace_back(more);
  overrides.push_back("run.end_time=" + std::to_string(original.end_time));
  Scene scene =
      read_scene(std::string(EHDJET_SCENES "/") + original.scene + ".toml", overrides);
  const fs::path whole = folder / "whole.h5", mutant = folder / "mutant.h5";
  RunOptions one_thread;
  one_thread.threads = 1;
  run_scene(scene, whole, std::move(one_thread));
  scene.config.run.end_time = 1;
  const std::vector<double> expected = steps_on(scene, whole, folder / "on.h5");

  std::size_t refused = 0, continued = 0;
  for (std::uint64_t number = 0; number < mutants; ++number) {
    fs::copy_file(whole, mutant, fs::copy_options::overwrite_existing);
    const Mutation made = test::mutate(mutant, 100000 * GetParam() + number);
    SCOPED_TRACE(made.text + (made.with_checksums ? " with checksums" : "") + " ("
                 + std::to_string(number) + ")");
    bool may_fail = false;
    const auto trying = [&](const std::function<void()>& use) {
      try {
        use();
      } catch (const Error& e) {
        ++refused;
        // A state that is possible, but not that of the run, may end in a failure of the run.
        EXPECT_TRUE(e.exit_code() == 2 || (may_fail && e.exit_code() == 1)) << e.what();
        if (e.exit_code() == 2) {
          EXPECT_NE(std::string(e.what()).find("mutant.h5"), std::string::npos) << e.what();
        }
      } catch (const std::exception& e) {
        ADD_FAILURE() << e.what();
      }
    };
    read_all(mutant, folder.path(), trying);
    may_fail = made.with_checksums;
    trying([&] {
      const std::vector<double> end = steps_on(scene, mutant, folder / "on.h5");
      ++continued;
      if (!made.with_checksums && made.text.find("@current") == std::string::npos) {
        EXPECT_EQ(end, expected);
      }
    });
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, mutants);
  EXPECT_GT(continued, mutants / 5);
}

INSTANTIATE_TEST_SUITE_P(Runs, HostileFile,
                         ::testing::Range<std::size_t>(0, originals.size()));

} // namespace
} // namespace ehdjet
