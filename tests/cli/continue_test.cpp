#include <gtest/gtest.h>

#include <algorithm>
#include <gmock/gmock.h>
#include <sstream>
#include <string>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string scene =
    EHDJET_SCENES "/pvp.toml --threads 1 --set output.observables=1e-5 --set "
                  "output.checkpoints=1e-4";

std::string up_to(const std::string& end_time) {
  return "run " + scene + " --quiet --set run.end_time=" + end_time;
}

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of('\n');
  return text.substr(text.rfind('\n', end) + 1);
}

std::string frames_of(const Folder& folder, const std::string& file) {
  const Outcome o = command(folder, "export " + file + " --beads");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(o.out, Not(IsEmpty()));
  return o.out;
}

TEST(Continue, gives_the_rows_and_the_frame_of_a_run_in_one_go) {
  const Folder folder;
  const std::string frames = " --set output.frames=8e-4"; // the last frame is the end
  ASSERT_EQ(command(folder, up_to("8e-4") + frames + " -o whole.h5").exit_code, 0);
  ASSERT_EQ(command(folder, up_to("3e-4") + " -o first.h5").exit_code, 0);
  const Outcome o =
      command(folder, up_to("8e-4") + frames + " --continue first.h5 -o second.h5");
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_EQ(frames_of(folder, "second.h5"), frames_of(folder, "whole.h5"));
  // Rows at the times of the second file, but for the currents of its first.
  std::istringstream rows(command(folder, "export second.h5 --observables").out);
  const std::string whole = command(folder, "export whole.h5 --observables").out;
  std::string row, header;
  std::getline(rows, header), std::getline(rows, row);
  int number = 0;
  for (; std::getline(rows, row); ++number) EXPECT_THAT(whole, HasSubstr(row + '\n'));
  EXPECT_GT(number, 50);
  EXPECT_LT(number, 70);
}

TEST(Continue, takes_up_a_run_that_was_stopped_by_a_signal) {
  const Folder folder;
  const std::string method = " --set integrator.method=dop853 --set integrator.rtol=1e-9";
  const Outcome stopped = command(folder, up_to("1") + method + " -o stopped.h5",
                                  "timeout --foreground --preserve-status -s TERM 2");
  ASSERT_EQ(stopped.exit_code, 1) << stopped.err;
  const auto at = stopped.err.find("t = ");
  ASSERT_NE(at, std::string::npos) << stopped.err;
  const double end = std::stod(stopped.err.substr(at + 4)) + 2e-4;
  const std::string on = up_to(std::to_string(end)) + method;
  const Outcome o = command(folder, on + " --continue stopped.h5 -o rest.h5");
  ASSERT_EQ(o.exit_code, 0) << o.err;
  ASSERT_EQ(command(folder, on + " -o whole.h5").exit_code, 0);
  EXPECT_EQ(last_line(command(folder, "export rest.h5 --observables").out),
            last_line(command(folder, "export whole.h5 --observables").out));
}

TEST(Continue, refuses_another_scene_and_names_the_key) {
  const Folder folder;
  ASSERT_EQ(command(folder, up_to("3e-4") + " -o first.h5").exit_code, 0);
  const auto refusal = [&](const std::string& change) {
    const Outcome o =
        command(folder, up_to("4e-4") + " " + change + " --continue first.h5 -o second.h5");
    EXPECT_EQ(o.exit_code, 2) << change;
    EXPECT_FALSE(std::filesystem::exists(folder / "second.h5")) << change;
    return o.err;
  };
  EXPECT_THAT(refusal("--set nozzle.radius=6e-5"),
              AllOf(HasSubstr("nozzle.radius was 5e-05, now it is 6e-05"),
                    HasSubstr("first.h5"), HasSubstr("run.end_time")));
  EXPECT_THAT(refusal("--set integrator.max_step=1e-6"),
              HasSubstr("integrator.max_step was absent, now it is 1e-06"));
  EXPECT_THAT(refusal("--set gravity="), HasSubstr("gravity"));
  EXPECT_THAT(refusal("--set run.end_time=1e-4"),
              AllOf(HasSubstr("run.end_time = 0.0001 s"), HasSubstr("t = ")));
  const Outcome same =
      command(folder, up_to("4e-4") + " --continue first.h5 -o first.h5 --force");
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_THAT(same.err, AllOf(HasSubstr("first.h5"), HasSubstr("-o")));
  EXPECT_EQ(command(folder, up_to("4e-4")
                                + " --set output.frames=1e-4 --set "
                                  "output.checkpoints= --continue first.h5 -o second.h5")
                .exit_code,
            0);
}

TEST(Continue, refuses_a_file_without_a_checkpoint) {
  const Folder folder;
  ASSERT_EQ(
      command(folder, up_to("2e-4") + " --set output.checkpoints= -o first.h5").exit_code,
      0);
  const Outcome o = command(folder, up_to("4e-4") + " --continue first.h5 -o second.h5");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("first.h5"), HasSubstr("output.checkpoints")));
  EXPECT_FALSE(std::filesystem::exists(folder / "second.h5"));
  folder.file("text.h5", "no run");
  EXPECT_EQ(command(folder, up_to("4e-4") + " --continue text.h5 -o second.h5").exit_code,
            2);
}

} // namespace
