#include <gtest/gtest.h>

#include <filesystem>
#include <gmock/gmock.h>
#include <string>

#include "cli/command.hpp"

// Names of scenes, commands and options; what commands say of files.
namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string brief = " --set run.end_time=2e-4 --set output.observables=1e-4 "
                          "--set output.frames=1e-4",
                  at_a_terminal = "sh -c 'exec script -qec \"$*\" /dev/null' sh";

TEST(Scenes, are_found_by_name_from_anywhere) {
  const Folder folder;
  const Outcome list = command(folder, "scenes");
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_THAT(list.out,
              AllOf(HasSubstr("pvp "), HasSubstr("PVP jet, case I: no refinement"),
                    HasSubstr("quickstart  ")));
  EXPECT_EQ(command(folder, "check pvp").exit_code, 0);
  EXPECT_EQ(command(folder, "check pvp.toml").exit_code, 0);
  const Outcome run = command(folder, "run quickstart" + brief);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("written to    quickstart.h5"));
  EXPECT_EQ(command(folder,
                    "bench table2 --rows none --rates one --time 2e-4 --no-serial --quiet "
                    "--threads 1")
                .exit_code,
            0);
}

TEST(Scenes, of_this_folder_and_of_the_environment_come_first) {
  const Folder folder;
  std::string mine = text_of(EHDJET_SCENES "/quickstart.toml");
  const auto at = mine.find("PVP jet, the first 8 ms");
  ASSERT_NE(at, std::string::npos);
  mine.replace(at, 3, "My");
  std::filesystem::create_directory(folder / "mine");
  folder.file("mine/pvp.toml", mine);
  EXPECT_THAT(command(folder, "info pvp", "EHDJET_SCENES=mine").out, HasSubstr("My jet"));
  EXPECT_THAT(command(folder, "scenes", "EHDJET_SCENES=absent:mine").out,
              AllOf(HasSubstr("My jet"), HasSubstr("quickstart")));
  mine.replace(at, 2, "Our");
  folder.file("pvp.toml", mine);
  EXPECT_THAT(command(folder, "info pvp", "EHDJET_SCENES=mine").out, HasSubstr("Our jet"));
}

TEST(Scenes, that_do_not_exist_are_named_with_the_nearest) {
  const Folder folder;
  const Outcome o = command(folder, "run pvpp");
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("pvpp"), HasSubstr("did you mean pvp?")));
  const Outcome path = command(folder, "run absent/pvp.toml");
  EXPECT_EQ(path.exit_code, 2);
  EXPECT_THAT(path.err, HasSubstr("absent/pvp.toml"));
}

TEST(Words, that_nobody_knows_are_named_with_the_nearest) {
  const Folder folder;
  for (const auto& [wrong, right] :
       {std::pair{"rnu pvp", "ehdjet has no command rnu (did you mean run?)"},
        {"bench tabel2", "ehdjet bench has no command tabel2 (did you mean table2?)"},
        {"run pvp --frce", "ehdjet run has no option --frce (did you mean --force?)"},
        {"run pvp --thread=2",
         "ehdjet run has no option --thread (did you mean --threads?)"},
        {"run pvp more", "ehdjet run does not expect more"}}) {
    const Outcome o = command(folder, wrong);
    EXPECT_EQ(o.exit_code, 2) << wrong;
    EXPECT_THAT(o.err, HasSubstr(right)) << wrong;
    EXPECT_FALSE(std::filesystem::exists(folder / "pvp.h5")) << wrong;
  }
}

TEST(Commands, say_what_they_have_written) {
  const Folder folder;
  ASSERT_EQ(command(folder, "run quickstart --quiet -o jet.h5" + brief).exit_code, 0);
  EXPECT_EQ(command(folder, "export jet.h5 --beads -o jet.csv").out, "");
  EXPECT_THAT(
      command(folder, "export jet.h5 --beads -o jet.csv --force", at_a_terminal).out,
      HasSubstr("written to jet.csv"));
  EXPECT_EQ(command(folder, "export jet.h5 --vtk").out, "written to jet.pvd\n");
  EXPECT_EQ(command(folder, "plot jet.h5").out, "written to jet.png\n");
}

TEST(Time, beyond_the_frames_is_refused_with_their_range) {
  const Folder folder;
  ASSERT_EQ(command(folder, "run quickstart --quiet -o jet.h5" + brief).exit_code, 0);
  for (const std::string time : {"1", "-1e-3"})
    for (const std::string what : {"export jet.h5 --beads", "export jet.h5 --xyz",
                                   "export jet.h5 --vtk", "plot jet.h5"}) {
      const Outcome o = command(folder, what + " --time=" + time);
      EXPECT_EQ(o.exit_code, 2) << what << time;
      EXPECT_THAT(o.err, AllOf(HasSubstr("jet.h5"), HasSubstr("0 s to 0.0002 s"))) << what;
    }
  EXPECT_EQ(command(folder, "export jet.h5 --beads --time 2e-4").exit_code, 0);
}

TEST(Time, is_refused_where_it_has_no_meaning) {
  const Folder folder;
  ASSERT_EQ(
      command(folder, "run quickstart --quiet --set run.end_time=5e-4 -o jet.h5").exit_code,
      0);
  for (const std::string part : {"observables", "jetspin-stat", "deposit"}) {
    const Outcome o = command(folder, "export jet.h5 --time 1e-4 --" + part);
    EXPECT_EQ(o.exit_code, 2) << part;
    EXPECT_THAT(o.err, HasSubstr("has no meaning with --" + part));
  }
}

TEST(Info, says_what_a_run_file_and_a_scene_hold) {
  const Folder folder;
  ASSERT_EQ(command(folder, "run quickstart --quiet -o jet.h5" + brief).exit_code, 0);
  const Outcome run = command(folder, "info jet.h5");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* text :
       {"status             complete", "observables        3, t = 0 to 0.0002 s",
        "frames             3, t = 0 to 0.0002 s", "end time           0.0002 s",
        "evaluations        ", "version            "})
    EXPECT_THAT(run.out, HasSubstr(text));
  EXPECT_THAT(
      command(folder, "info jet.h5 --json").out,
      AllOf(HasSubstr("\"status\":\"complete\""), HasSubstr("\"frames\":{\"rows\":3,")));
  const Outcome scene = command(folder, "info pvp --json");
  EXPECT_THAT(scene.out,
              AllOf(HasSubstr("\"kind\":\"scene\""), HasSubstr("\"end_time_s\":0.2")));
  folder.file("text.h5", "no run");
  EXPECT_EQ(command(folder, "info text.h5").exit_code, 2);
}

TEST(Run, takes_the_scene_of_a_run_file) {
  const Folder folder;
  ASSERT_EQ(command(folder, "run quickstart --quiet -o old.h5" + brief).exit_code, 0);
  const Outcome again = command(folder, "run old.h5 --quiet -o new.h5");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(command(folder, "export new.h5 --observables").out,
            command(folder, "export old.h5 --observables").out);
  EXPECT_EQ(
      command(folder, "run old.h5 --quiet -o more.h5 --set run.end_time=3e-4").exit_code,
      0);
  EXPECT_THAT(command(folder, "info more.h5 --json").out,
              HasSubstr("\"end_time_s\":0.0003"));
  ASSERT_EQ(command(folder, "run chain --quiet -o chain.h5").exit_code, 0);
  const Outcome chain = command(folder, "run chain.h5 --quiet -o chain2.h5");
  EXPECT_EQ(chain.exit_code, 0) << chain.err;
}

} // namespace
