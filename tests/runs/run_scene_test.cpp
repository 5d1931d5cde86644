#include "ehdjet/budget/budget.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_reader.hpp"
#include "ehdjet/runs/run_scene.hpp"
#include "ehdjet/scene/chain_file.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <omp.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "io/fabricated_run.hpp"
#include "support/own_event.hpp"
#include "support/own_force.hpp"
#include "support/scenes.hpp"

// A program that links the library, runs a scene into a file and adds things of its own.
namespace ehdjet {
namespace {

using namespace test;
using testing::Folder;

Scene short_jet() {
  Scene scene = case_one("dormand-prince", 1e-6);
  scene.config.run.end_time = 1e-3;
  scene.config.output.frames = 1e-4, scene.config.output.observables = 1e-4;
  return scene;
}

class CountSteps final : public Observer {
public:
  [[nodiscard]] Interest interest() const override { return {.ends_of_steps = true}; }
  void after_step(const JetSnapshot& /*snapshot*/) override { ++steps; }
  std::uint64_t steps = 0;
};

TEST(RunScene, runs_a_scene_with_a_force_an_event_and_an_observer_of_ones_own) {
  const Folder folder;
  const auto counter = std::make_shared<CountSteps>();
  RunOptions options;
  options.extras.forces.push_back(std::make_unique<LinearDrag>(1e-6));
  options.extras.events.push_back(std::make_unique<Discharge>(5e-4, 0.5));
  options.extras.observers.push_back(counter);
  const RunResult with = run_scene(short_jet(), folder / "with.h5", std::move(options));
  const RunResult without = run_scene(short_jet(), folder / "without.h5");

  EXPECT_EQ(with.status, "complete");
  EXPECT_EQ(counter->steps, with.statistics.steps);
  const auto tip = [](const RunResult& r) {
    return r.jet.columns().position().x[r.jet.links()];
  };
  EXPECT_LT(tip(with), 0.99 * tip(without)); // drag holds it back
  EXPECT_EQ(with.jet.charge.back(), without.jet.charge.back() / 2);

  const RunReader run(folder / "with.h5");
  EXPECT_EQ(run.attribute("status"), "complete");
  ASSERT_EQ(run.frame_times().size(), 11U);
  // A frame at the time of an event shows the jet after it.
  EXPECT_EQ(run.frame(4)["charge"].back(), 2 * run.frame(5)["charge"].back());
  EXPECT_EQ(run.frame(10)["x"].back(), tip(with));
  EXPECT_FALSE(run.attribute("version").empty());
}

TEST(RunScene, stops_when_it_is_told_to_and_goes_on_to_the_same_bits) {
  const Folder folder;
  Scene scene = short_jet();
  scene.config.output.checkpoints = 2e-4;
  const RunResult whole = run_scene(scene, folder / "whole.h5");

  RunOptions stopped;
  double seen = 0;
  stopped.started = [&](Simulation& simulation) {
    EXPECT_EQ(simulation.jet().time, 0);
    simulation.after_each_step([&](const Simulation& s) { seen = s.jet().time; });
  };
  stopped.interrupted = [&]() -> const char* { return seen > 5e-4 ? "the test" : nullptr; };
  const RunResult part = run_scene(scene, folder / "part.h5", std::move(stopped));
  EXPECT_EQ(part.status, "interrupted");
  EXPECT_EQ(part.message.rfind("stopped by the test at t = ", 0), 0U) << part.message;
  EXPECT_EQ(RunReader(folder / "part.h5").attribute("status"), "interrupted");

  RunOptions rest;
  rest.continue_from = folder / "part.h5";
  const RunResult end = run_scene(scene, folder / "rest.h5", std::move(rest));
  EXPECT_EQ(end.jet.y, whole.jet.y);
  EXPECT_EQ(end.statistics.evaluations, whole.statistics.evaluations);
  EXPECT_EQ(RunReader(folder / "rest.h5").attribute("continued_from"),
            (folder / "part.h5").string());

  RunOptions again;
  again.continue_from = folder / "part.h5";
  again.overwrite = true;
  EXPECT_THROW(run_scene(scene, folder / "part.h5", std::move(again)), InputError);
}

/// Makes a data set of a file `more` rows longer, or shorter.
void stretch(const std::filesystem::path& path, const char* name, long long more) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
  const auto rows = static_cast<hsize_t>(H5Sget_simple_extent_npoints(space)
                                         + static_cast<hssize_t>(more));
  EXPECT_GE(H5Dset_extent(set, &rows), 0);
  H5Sclose(space), H5Dclose(set), H5Fclose(file);
}

// A run that is killed within a flush may leave some data sets longer than others.
TEST(RunScene, chains_and_exports_agree_on_the_frames_of_a_killed_run) {
  const Folder folder;
  run_scene(short_jet(), folder / "whole.h5");
  const auto last = static_cast<long long>(RunReader(folder / "whole.h5").frame(10).rows());
  struct Case {
    const char* data_set;
    long long more;
    std::size_t frames;
  };
  for (const Case& c : {Case{"frames/time", -1, 10}, Case{"frames/offset", -2, 9},
                        Case{"frames/offset", 3, 11}, Case{"beads/vy", -1, 10},
                        Case{"beads/landed", 5, 11}, Case{"beads/charge", -last - 1, 9}}) {
    SCOPED_TRACE(c.data_set);
    const auto path = folder / "cut.h5";
    std::filesystem::copy_file(folder / "whole.h5", path,
                               std::filesystem::copy_options::overwrite_existing);
    stretch(path, c.data_set, c.more);
    const RunReader run(path);
    const std::vector<double> times = run.frame_times();
    EXPECT_EQ(times.size(), c.frames);
    for (const double t : times) {
      const Frame frame = run.frame(run.nearest_frame(t));
      EXPECT_EQ(frame.time, t);
      const auto& embryo = frame["embryo"];
      const bool forming = embryo.size() > 2 && embryo[1] != 0;
      const ChainBeads chain = read_chain(path, t);
      EXPECT_EQ(chain.size(), frame.rows() - (forming ? 1 : 0));
      EXPECT_EQ(chain.vy.back(), frame["vy"].back());
    }
    EXPECT_EQ(read_chain(path).x.back(), run.frame(times.size() - 1)["x"].back());
  }
}

/// Ends the run after a few steps.
template <class Failure>
class Spoilsport final : public Observer {
public:
  [[nodiscard]] Interest interest() const override { return {.ends_of_steps = true}; }
  void after_step(const JetSnapshot& snapshot) override {
    if (snapshot.statistics.steps == 5) throw Failure("enough");
  }
};

TEST(RunScene, a_failure_of_any_kind_is_in_the_file) {
  const Folder folder;
  RunOptions ours, theirs;
  ours.extras.observers.push_back(std::make_shared<Spoilsport<RunError>>());
  theirs.extras.observers.push_back(std::make_shared<Spoilsport<std::logic_error>>());
  try {
    run_scene(short_jet(), folder / "ours.h5", std::move(ours));
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()),
              "enough; everything up to then is in " + (folder / "ours.h5").string());
    EXPECT_EQ(e.exit_code(), 1);
  }
  EXPECT_THROW(run_scene(short_jet(), folder / "theirs.h5", std::move(theirs)),
               std::logic_error);
  for (const char* name : {"ours.h5", "theirs.h5"}) {
    const RunReader run(folder / name);
    EXPECT_EQ(run.attribute("status"), "failed");
    EXPECT_EQ(run.attribute("message"), "enough");
    EXPECT_EQ(run.column("observables", "time").size(), 1U);
  }
}

TEST(RunScene, leaves_the_number_of_threads_as_it_was) {
  const Folder folder;
  const int before = omp_get_max_threads();
  Scene scene = short_jet();
  scene.config.run.end_time = 1e-5;
  RunOptions options;
  options.threads = 1;
  run_scene(scene, folder / "run.h5", std::move(options));
  EXPECT_EQ(RunReader(folder / "run.h5").attribute("threads"), "1");
  EXPECT_EQ(omp_get_max_threads(), before);
}

// Who writes to a file shares its ownership: nothing is left that could be destroyed too early.
TEST(RunScene, simulation_file_and_observers_may_go_in_any_order) {
  const Folder folder;
  const Scene scene = short_jet();
  for (const int first : {0, 1, 2}) {
    const auto path = folder / (std::to_string(first) + ".h5");
    auto file = std::make_shared<RunFile>(path, false, Provenance{}, 1e9);
    auto simulation = build_simulation(scene);
    std::shared_ptr<Observer> frames =
        record_frames(file, 1e-4, *test::table_with_stress());
    auto budget = std::make_shared<Budget>(simulation->dynamics(), simulation->events());
    std::shared_ptr<Observer> book = record_budget(file, 1e-4, budget);
    for (const std::shared_ptr<Observer>& o :
         std::initializer_list<std::shared_ptr<Observer>>{frames, book, budget})
      simulation->add(o);
    if (first == 0) file.reset();
    if (first == 1) frames.reset(), budget.reset(), book.reset();
    simulation->run_until(5e-4);
    if (first == 2) file.reset();
    simulation.reset();
    frames.reset(), book.reset(), budget.reset(), file.reset();
    const RunReader run(path);
    EXPECT_EQ(run.attribute("status"), "running"); // nobody finished it
    EXPECT_EQ(run.frame_times().size(), 6U);
    EXPECT_EQ(run.column("budget", "time").size(), 6U);
  }
}

} // namespace
} // namespace ehdjet
