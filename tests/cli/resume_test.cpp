#include <gtest/gtest.h>

#include <filesystem>
#include <gmock/gmock.h>
#include <string>

#include "cli/command.hpp"

// A run that is stopped and resumed gives the file of a run in one go.
namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// 20 ms of a jet that lands, with every part that a file can have.
const std::string everything =
    "table2_08 --threads 1 --quiet --set run.end_time=20e-3 --set output.observables=1e-4 "
    "--set "
    "output.frames=1e-3 --set output.deposit=true --set output.refinements=sums --set "
    "output.budget=1e-3 --set output.resolving_power=1e-3";
const std::string scenes_here = "EHDJET_SCENES=" EHDJET_SCENES;

std::string all_of(const Folder& folder, const std::string& file) {
  std::string all;
  for (const char* part : {"--observables", "--xyz", "--deposit", "--refinements",
                           "--budget", "--resolving-power"}) {
    const Outcome o = command(folder, "export " + file + ' ' + part);
    EXPECT_EQ(o.exit_code, 0) << part << o.err;
    all += o.out;
  }
  return all;
}

std::string status_of(const Folder& folder, const std::string& file) {
  return command(folder, "info " + file + " --json").out;
}

/// Starts or resumes a run again and again, and ends it with a signal, each time a little later.
int stop_and_resume(const Folder& folder, const std::string& run,
                    const std::string& signal) {
  int stopped = 0;
  for (double seconds = 0.1; seconds < 60; seconds *= 1.5) {
    const Outcome o = command(folder, run + " --resume",
                              scenes_here + " timeout --foreground --preserve-status -s "
                                  + signal + " " + std::to_string(seconds));
    if (o.exit_code == 0) return stopped;
    // 15: before the run looks at signals
    EXPECT_THAT(o.exit_code, testing::AnyOf(1, 128 + 9, 9, 128 + 15, 15)) << o.err;
    if (std::filesystem::exists(folder / "parts.h5")) ++stopped;
  }
  ADD_FAILURE() << "never complete";
  return stopped;
}

TEST(Resume, gives_the_same_file_after_kills_between_checkpoints) {
  const Folder folder;
  const std::string run = "run " + everything + " --set output.checkpoints=1.3e-3";
  ASSERT_EQ(command(folder, "run " + everything + " -o whole.h5", scenes_here).exit_code,
            0);
  EXPECT_GE(stop_and_resume(folder, run + " -o parts.h5", "KILL"), 1);
  EXPECT_EQ(all_of(folder, "parts.h5"), all_of(folder, "whole.h5"));
  EXPECT_THAT(status_of(folder, "parts.h5"), HasSubstr("\"status\":\"complete\""));
}

TEST(Resume, goes_on_where_a_signal_has_stopped_the_run) {
  const Folder folder;
  ASSERT_EQ(command(folder, "run " + everything + " -o whole.h5", scenes_here).exit_code,
            0);
  const int stopped = stop_and_resume(folder, "run " + everything + " -o parts.h5", "TERM");
  EXPECT_GE(stopped, 1);
  EXPECT_EQ(all_of(folder, "parts.h5"), all_of(folder, "whole.h5"));
  EXPECT_THAT(status_of(folder, "parts.h5"), HasSubstr("resumed_at"));
}

const std::string brief =
    "run quickstart --threads 1 --set run.end_time=5e-4 --set output.observables=1e-4";

TEST(Resume, starts_or_does_nothing_and_is_never_in_the_way) {
  const Folder folder;
  const std::string run = brief + " -o jet.h5 --resume";
  EXPECT_EQ(command(folder, run, scenes_here).exit_code, 0);
  const std::string before = text_of(folder / "jet.h5");
  const Outcome again = command(folder, run, scenes_here);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("jet.h5 is complete up to t = 0.0005 s"));
  EXPECT_EQ(text_of(folder / "jet.h5"), before);
}

TEST(Resume, refuses_another_scene_and_names_all_keys) {
  const Folder folder;
  ASSERT_EQ(command(folder, brief + " -o jet.h5", scenes_here).exit_code, 0);
  const std::string before = text_of(folder / "jet.h5");
  const Outcome o = command(
      folder,
      brief + " -o jet.h5 --resume --set nozzle.radius=6e-5 --set output.frames=1e-4",
      scenes_here);
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("jet.h5"), HasSubstr("nozzle.radius was 5e-05"),
                           HasSubstr("output.frames")));
  const Outcome longer =
      command(folder, brief + " -o jet.h5 --resume --set run.end_time=6e-4", scenes_here);
  EXPECT_EQ(longer.exit_code, 2);
  EXPECT_THAT(longer.err, HasSubstr("no checkpoint"));
  folder.file("text.h5", "precious");
  EXPECT_EQ(command(folder, brief + " -o text.h5 --resume", scenes_here).exit_code, 2);
  EXPECT_EQ(text_of(folder / "text.h5"), "precious");
  EXPECT_EQ(text_of(folder / "jet.h5"), before);
}

TEST(Resume, makes_a_complete_run_longer) {
  const Folder folder;
  const std::string run =
      "run quickstart --quiet --threads 1 --set output.observables=1e-4 --set "
      "output.checkpoints=1e-4 ";
  const std::string longer = "--set run.end_time=8e-4 ";
  ASSERT_EQ(command(folder, run + longer + "-o whole.h5", scenes_here).exit_code, 0);
  ASSERT_EQ(
      command(folder, run + "--set run.end_time=5e-4 -o jet.h5", scenes_here).exit_code, 0);
  const Outcome o = command(folder, run + longer + "-o jet.h5 --resume", scenes_here);
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_EQ(command(folder, "export jet.h5 --observables").out,
            command(folder, "export whole.h5 --observables").out);
}

TEST(Resume, cuts_off_no_results) {
  const Folder folder;
  const std::string run =
      "run quickstart --quiet --threads 1 --set output.observables=1e-4 --set "
      "output.checkpoints=1e-4 -o jet.h5 ";
  ASSERT_EQ(command(folder, run + "--set run.end_time=5e-4", scenes_here).exit_code, 0);
  const std::string before = text_of(folder / "jet.h5");
  const Outcome o =
      command(folder, run + "--set run.end_time=4.5e-4 --resume", scenes_here);
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, HasSubstr("jet.h5 has results up to 0.0005 s"));
  EXPECT_EQ(text_of(folder / "jet.h5"), before);
}

TEST(Checkpoints, by_the_wall_clock_do_not_change_a_run_and_cost_nothing_before) {
  const Folder folder;
  const std::string run =
      "run quickstart --quiet --threads 1 --set output.observables=1e-5 ";
  ASSERT_EQ(command(folder, run + "-o usual.h5", scenes_here).exit_code, 0);
  ASSERT_EQ(command(folder, run + "-o often.h5 --set output.checkpoint_wall_time=0.01",
                    scenes_here)
                .exit_code,
            0);
  EXPECT_EQ(command(folder, "export often.h5 --observables").out,
            command(folder, "export usual.h5 --observables").out);
  EXPECT_THAT(status_of(folder, "often.h5"), HasSubstr("checkpoint_s"));
  EXPECT_THAT(status_of(folder, "usual.h5"), Not(HasSubstr("checkpoint_s")));
}

/// Runs a command in the background, does something to it, and kills it in the end.
std::string in_background(const std::string& what) {
  return scenes_here
         + " sh -c '\"$0\" \"$@\" & p=$!; while ! [ -e long.h5 ]; do sleep 0.05; done; "
           "sleep 0.3; "
         + what + "; kill -KILL $p; wait'";
}

const std::string endless =
    "run table2_02 --threads 1 --quiet --set run.end_time=10 -o long.h5";

TEST(Checkpoints, are_made_at_usr1_and_the_run_goes_on) {
  const Folder folder;
  const Outcome outcome =
      command(folder, endless,
              in_background("kill -USR1 $p; for i in 1 2 3 4 5 6 7 8 9 10; do sleep 0.2; "
                            "'" EHDJET_COMMAND
                            "' info long.h5 --json | grep -q checkpoint_s && break; "
                            "done; kill -0 $p && echo alive"));
  EXPECT_THAT(outcome.out, HasSubstr("alive"));
  EXPECT_THAT(status_of(folder, "long.h5"),
              AllOf(HasSubstr("checkpoint_s"), HasSubstr("\"status\":\"killed\"")));
}

TEST(Resume, leaves_a_running_run_alone) {
  const Folder folder;
  const Outcome o =
      command(folder, endless,
              in_background("'" EHDJET_COMMAND
                            "' info long.h5 --json >info.txt; '" EHDJET_COMMAND "' "
                            + endless + " --resume 2>refused.txt; echo $? >code.txt"));
  EXPECT_THAT(text_of(folder / "info.txt"), HasSubstr("\"status\":\"running\""));
  EXPECT_EQ(text_of(folder / "code.txt"), "2\n");
  EXPECT_THAT(text_of(folder / "refused.txt"),
              HasSubstr("long.h5 is being written by another run"));
}

} // namespace
