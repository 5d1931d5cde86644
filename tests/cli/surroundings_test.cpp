#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <gmock/gmock.h>
#include <string>
#include <vector>

#include "cli/command.hpp"

// What surrounds a command goes wrong: standard streams, disks, links, signals, names. Every case has the exit
// code that it deserves and a message that names the cause, and destroys nothing.
namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

const std::string quickstart = EHDJET_SCENES "/quickstart.toml";
const std::string brief =
    quickstart
    + " --set run.end_time=2e-4 --set output.observables=1e-4 --set output.frames=1e-4";
/// Does not end by itself within a test.
const std::string endless = EHDJET_SCENES "/pvp.toml --set run.end_time=100 --set "
                                          "output.observables=1e-6 --set output.flush=0.01";

/// The command with redirections of the shell, such as 2>&-.
std::string with(const std::string& redirections) {
  return "sh -c 'exec \"$0\" \"$@\" " + redirections + "'";
}

/// The command in the background as process $p, and then a script.
std::string beside(const std::string& script) {
  return "sh -c '\"$0\" \"$@\" & p=$!; " + script + "; wait $p'";
}

bool is_gnuplot_here() {
  return std::system("gnuplot --version >/dev/null 2>&1") == 0; // NOLINT(cert-env33-c)
}

std::vector<std::string> files_in(const Folder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path()))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

Folder& with_run(Folder& folder) {
  EXPECT_EQ(command(folder, "run " + brief + " -o jet.h5 --quiet").exit_code, 0);
  return folder;
}

void write_charges(const Folder& folder, const std::string& name) {
  folder.file(name, "x,y,z,q\n0,0,0,1e-9\n1e-3,0,0,1e-9\n");
}

// ---- standard streams ----------------------------------------------------------------------------

TEST(StandardStreams, that_are_closed_do_not_become_files_of_the_run) {
  for (const std::string closed : {"2>&-", "<&- 2>&-", "<&- >&- 2>&-"}) {
    const Folder folder;
    command(folder, "run " + brief + " -o jet.h5", with(closed));
    const Outcome rows = command(folder, "export jet.h5 --observables");
    EXPECT_EQ(rows.exit_code, 0) << closed << rows.err;
    EXPECT_EQ(std::ranges::count(rows.out, '\n'), 4) << closed;
  }
}

TEST(StandardStreams, that_take_no_messages_do_not_stop_a_run) {
  const Folder folder;
  EXPECT_EQ(command(folder, "run " + brief + " -o jet.h5", with("2>/dev/full")).exit_code,
            0);
  EXPECT_EQ(std::ranges::count(command(folder, "export jet.h5 --observables").out, '\n'),
            4);
  EXPECT_EQ(command(folder, "run nowhere.toml", with("2>/dev/full")).exit_code, 2);
}

TEST(StandardStreams, that_take_no_results_make_every_command_fail) {
  Folder folder;
  with_run(folder);
  write_charges(folder, "two.csv");
  for (const std::string& arguments :
       {"check " + brief, std::string("check --keys"), std::string("forces two.csv"),
        std::string("export jet.h5 --observables"), "run " + brief + " -o other.h5 --force",
        std::string("--version"), std::string("run --help")})
    for (const std::string to : {">/dev/full", ">&-"}) {
      const Outcome o = command(folder, arguments, with(to));
      EXPECT_EQ(o.exit_code, 1) << arguments << to;
      EXPECT_THAT(o.err, HasSubstr("cannot write standard output: ")) << arguments << to;
    }
}

TEST(StandardStreams, get_no_commands_for_the_terminal_from_names_and_titles) {
  const Folder folder;
  const std::string controls = "\x1b]0;title\x07\x1b[2J";
  const Outcome titled =
      command(folder, "run " + brief
                          + " -o jet.h5 --set 'title=\"\\u001b]0;T\\u0007"
                            "\\u009b2J\"'");
  EXPECT_EQ(titled.exit_code, 0) << titled.err;
  EXPECT_THAT(titled.err, HasSubstr("\\x1b]0;T\\x07\\xc2\\x9b2J"));
  const Outcome named = command(folder, "run '" + controls + ".toml'");
  const Outcome unknown = command(folder, "run --'" + controls + "'");
  const Outcome written = command(folder, "run " + brief + " -o '" + controls + ".h5'");
  EXPECT_EQ(named.exit_code, 2);
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(written.exit_code, 0);
  for (const Outcome& o : {titled, named, unknown, written})
    EXPECT_THAT(o.out + o.err, Not(HasSubstr("\x1b")));
}

// ---- outputs -------------------------------------------------------------------------------------

TEST(Outputs, of_one_name_that_are_written_at_once_are_refused_but_for_one) {
  const Folder folder;
  command(folder, "run " + brief + " -o jet.h5 --quiet",
          "sh -c 'for i in 1 2 3 4; do (\"$0\" \"$@\" 2>>errors; echo $? >>codes) & done; "
          "wait'");
  std::string codes = text_of(folder / "codes");
  std::ranges::sort(codes);
  EXPECT_EQ(codes, "\n\n\n\n0222");
  EXPECT_THAT(text_of(folder / "errors"), HasSubstr("jet.h5 exists"));
  EXPECT_EQ(files_in(folder), (std::vector<std::string>{"codes", "errors", "jet.h5",
                                                        "stderr.txt", "stdout.txt"}));
}

TEST(Outputs, do_not_replace_what_they_are_made_from) {
  Folder folder;
  with_run(folder);
  write_charges(folder, "two.csv");
  folder.file("scene.toml", text_of(quickstart));
  fs::create_symlink("jet.h5", folder / "link.h5");
  fs::create_hard_link(folder / "two.csv", folder / "hard.csv");
  const std::string run = text_of(folder / "jet.h5"), charges = text_of(folder / "two.csv"),
                    scene = text_of(folder / "scene.toml");
  for (const std::string arguments :
       {"export jet.h5 --observables -o jet.h5", "export jet.h5 --xyz -o link.h5",
        "export jet.h5 --vtk -o jet.h5", "forces two.csv -o two.csv",
        "forces two.csv -o ./hard.csv", "run scene.toml -o scene.toml",
        "plot link.h5 -o jet.h5"}) {
    const Outcome o = command(folder, arguments + " --force");
    EXPECT_EQ(o.exit_code, 2) << arguments;
    EXPECT_THAT(o.err, HasSubstr("that is read")) << arguments;
  }
  EXPECT_EQ(text_of(folder / "jet.h5"), run);
  EXPECT_EQ(text_of(folder / "two.csv"), charges);
  EXPECT_EQ(text_of(folder / "scene.toml"), scene);
}

TEST(Outputs, follow_a_link_to_a_file_that_is_not_there_yet) {
  const Folder folder;
  fs::create_symlink("real.h5", folder / "link.h5");
  EXPECT_EQ(command(folder, "run " + brief + " -o link.h5 --quiet").exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder / "link.h5"));
  EXPECT_TRUE(fs::is_regular_file(folder / "real.h5"));
}

TEST(Outputs, that_cannot_be_created_are_refused_before_the_work) {
  Folder folder;
  with_run(folder);
  write_charges(folder, "two.csv");
  for (const std::string arguments :
       {"calibrate -o no/such/c.toml", "plot jet.h5 -o no/such/p.png",
        "export jet.h5 --xyz -o no/such/x.xyz", "forces two.csv -o no/such/f.csv"}) {
    const Outcome o = command(folder, arguments);
    EXPECT_EQ(o.exit_code, 2) << arguments;
    EXPECT_THAT(o.err, AllOf(HasSubstr("cannot create no/such/"), HasSubstr("no folder")));
  }
  EXPECT_EQ(command(folder, "export jet.h5 --xyz -o /proc/x.xyz").exit_code, 2);
}

TEST(Outputs, on_a_full_disk_leave_the_older_file_and_nothing_else) {
  Folder folder;
  with_run(folder);
  folder.file("jet.xyz", "precious");
  const auto before = files_in(folder);
  const Outcome o =
      command(folder, "export jet.h5 --xyz -o jet.xyz --force", "ulimit -f 1;");
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, HasSubstr("cannot write jet.xyz: File too large"));
  EXPECT_EQ(text_of(folder / "jet.xyz"), "precious");
  EXPECT_EQ(files_in(folder), before);
}

// At every size of the disk the file is readable, says that the run has failed, and has what the message says.
TEST(Outputs, of_a_run_on_a_full_disk_are_what_the_message_says) {
  for (const int blocks : {64, 72, 96, 136}) { // of 512 bytes
    const Folder folder;
    const Outcome o =
        command(folder,
                "run " + quickstart
                    + " -o jet.h5 --quiet --set run.end_time=4e-3 --set output.frames=1e-6",
                "ulimit -f " + std::to_string(blocks) + ";");
    EXPECT_EQ(o.exit_code, 1) << blocks;
    EXPECT_THAT(o.err, HasSubstr("File too large")) << blocks;
    if (!fs::exists(folder / "jet.h5")) continue; // there was no room for the scene
    EXPECT_THAT(o.err, HasSubstr("jet.h5 has 0 of ")) << blocks;
    EXPECT_LE(std::ranges::count(command(folder, "export jet.h5 --observables").out, '\n'),
              1);
    EXPECT_THAT(text_of(folder / "jet.h5"), HasSubstr("failed")) << blocks;
  }
}

TEST(Outputs, of_a_run_that_are_removed_stop_it) {
  const Folder folder;
  const Outcome o = command(
      folder, "run " + endless + " -o jet.h5 --quiet",
      "timeout 60 "
          + beside("while [ ! -s jet.h5 ]; do sleep 0.02; done; sleep 0.5; rm jet.h5"));
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr("at t = "), HasSubstr("has been removed or replaced"),
                           HasSubstr("nothing is left of it")));
}

TEST(Outputs, of_a_run_that_are_renamed_are_found) {
  const Folder folder;
  const Outcome o = command(
      folder, "run " + endless + " -o jet.h5 --quiet",
      "timeout 60 "
          + beside(
              "while [ ! -s jet.h5 ]; do sleep 0.02; done; mv jet.h5 other.h5; sleep 0.3; "
              "kill -TERM $p"));
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, HasSubstr("other.h5"));
  EXPECT_EQ(command(folder, "export other.h5 --observables").exit_code, 0);
}

// ---- signals and limits --------------------------------------------------------------------------

TEST(Signals, of_a_terminal_that_goes_stop_a_run_cleanly_unless_they_are_ignored) {
  const Folder folder;
  const std::string hang_up =
      "while [ ! -s jet.h5 ]; do sleep 0.02; done; sleep 0.3; kill -HUP $p; kill -HUP $p";
  const Outcome o = command(folder, "run " + endless + " -o jet.h5 --quiet",
                            "timeout 60 " + beside(hang_up));
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err,
              AllOf(HasSubstr("stopped by SIGHUP"), HasSubstr("everything up to then")));
  EXPECT_EQ(command(folder, "run " + brief + " -o under.h5 --quiet",
                    "trap '' HUP; " + beside("kill -HUP $p"))
                .exit_code,
            0);
}

TEST(Limits, of_the_wall_time_stop_a_run_that_can_be_continued) {
  const Folder folder;
  const Outcome o =
      command(folder, "run " + quickstart
                          + " -o jet.h5 --quiet --set run.max_wall_time=0.4 --set "
                            "run.end_time=10 --set output.checkpoints=1e-6");
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr("stopped by run.max_wall_time = 0.4 s at t = "),
                           HasSubstr("everything up to then is in jet.h5")));
  const Outcome further = command(
      folder,
      "run " + quickstart
          + " -o further.h5 --continue jet.h5 --quiet --set run.max_wall_time=0.1 --set "
            "run.end_time=10");
  EXPECT_EQ(further.exit_code, 1);
  EXPECT_THAT(further.err, HasSubstr("stopped by run.max_wall_time = 0.1 s"));
}

TEST(Limits, of_threads_are_in_the_report) {
  const Folder folder;
  write_charges(folder, "two.csv");
  EXPECT_THAT(command(folder, "forces two.csv --threads 8", "OMP_THREAD_LIMIT=1").out,
              HasSubstr("\"threads\":1,"));
}

// ---- inputs --------------------------------------------------------------------------------------

TEST(Inputs, that_are_no_files_are_refused_with_the_reason) {
  Folder folder;
  with_run(folder);
  struct Case {
    std::string before, arguments, message;
  };
  for (const Case& c : std::vector<Case>{
           {"", "run /dev/zero", "more than 16 MiB"},
           {"mkfifo pipe;", "run pipe", "a pipe to which nobody writes"},
           {"", "run .", "it is a folder"},
           {"", "forces .", "it is a folder"},
           {"", "export . --xyz", "is a folder"},
           {"", "export jet.h5 --beads --time nan", "nan: must be finite"},
           {"", "export jet.h5 --xyz --time inf", "inf: must be finite"},
           {"", "plot jet.h5 --time nan", "nan: must be finite"},
           {"", "check " + quickstart + " --set ' = 3'", "expected table.key=value"}}) {
    const Outcome o = command(folder, c.arguments, c.before);
    EXPECT_EQ(o.exit_code, 2) << c.arguments;
    EXPECT_THAT(o.err, HasSubstr(c.message)) << c.arguments;
  }
}

TEST(Inputs, may_come_through_a_pipe) {
  const Folder folder;
  const Outcome o =
      command(folder, "check /dev/stdin",
              "sh -c '(sleep 0.1; cat \"" + quickstart + "\") | \"$0\" \"$@\"'");
  EXPECT_EQ(o.exit_code, 0) << o.err;
}

TEST(Inputs, may_have_blanks_around_the_equals_sign) {
  const Folder folder;
  const Outcome o = command(
      folder, "check " + quickstart + " --set 'run.end_time = 1e-4' --set ' gravity = '");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("0 to 0.0001 s"), Not(HasSubstr("[gravity]"))));
}

TEST(Inputs, with_a_fixed_step_that_is_not_stable_get_a_warning) {
  const Folder folder;
  const std::string fixed =
      brief + " --set integrator.method=rk4 --set integrator.rtol= --set integrator.step=";
  for (const std::string command_name : {"check ", "run -o jet.h5 --force "}) {
    const Outcome rough = command(folder, command_name + fixed + "1e-3");
    EXPECT_THAT(rough.out + rough.err, HasSubstr("the longest stable step of rk4"))
        << rough.err;
    const Outcome fine = command(folder, command_name + fixed + "1e-7");
    EXPECT_THAT(fine.out + fine.err, Not(HasSubstr("the longest stable step of rk4 "
                                                   "for the link")));
  }
}

TEST(Inputs, that_ask_for_too_much_output_get_a_warning) {
  const Folder folder;
  const Outcome o =
      command(folder, "check " + quickstart + " --set output.observables=1e-9");
  EXPECT_THAT(o.out, HasSubstr("WARNING: output.observables = 1e-09 s is 8.0e+06 times"));
  const Outcome more =
      command(folder, "check " + quickstart + " --set output.observables=1e-12");
  EXPECT_EQ(more.exit_code, 2);
  EXPECT_THAT(more.err, AllOf(HasSubstr("output.observables = 1e-12 s"),
                              HasSubstr("8e+09 rows, more than 1e+08")));
}

// ---- plots ---------------------------------------------------------------------------------------

TEST(Plots, execute_nothing_that_is_in_a_name) {
  if (!is_gnuplot_here()) GTEST_SKIP() << "no gnuplot here";
  Folder folder;
  with_run(folder);
  const std::vector<std::string> names{"a'\nsystem('touch executed')\n.h5",
                                       "b`touch executed`$(touch executed).h5",
                                       "c\"; system 'touch executed' #.h5",
                                       "d\\\nsystem 'touch executed'\n.h5", "e\x1b[2J.h5"};
  for (const std::string& name : names) {
    fs::copy_file(folder / "jet.h5", folder / name);
    const Outcome o =
        command(folder, "plot ./*.h5 -o 'page\nsystem \"touch executed\"\n.svg' --force",
                "rm -f jet.h5;");
    EXPECT_EQ(o.exit_code, 0) << name << o.err;
    EXPECT_EQ(o.out + o.err, "") << name;
    EXPECT_FALSE(fs::exists(folder / "executed")) << name;
    fs::rename(folder / name, folder / "jet.h5");
  }
}

TEST(Plots, need_no_folder_for_temporary_files_and_no_locale) {
  if (!is_gnuplot_here()) GTEST_SKIP() << "no gnuplot here";
  Folder folder;
  with_run(folder);
  const Outcome o =
      command(folder, "plot jet.h5 -o page.png", "LC_ALL=C TMPDIR=/nonexistent");
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_EQ(o.out + o.err, "");
  const Outcome format = command(folder, "plot jet.h5 -o page.jpg");
  EXPECT_EQ(format.exit_code, 2);
  EXPECT_THAT(format.err,
              AllOf(HasSubstr("cannot plot to page.jpg"), Not(HasSubstr(".page"))));
}

TEST(Plots, on_a_full_disk_fail_and_leave_the_older_picture) {
  if (!is_gnuplot_here()) GTEST_SKIP() << "no gnuplot here";
  for (const std::string extension : {".png", ".svg", ".pdf"}) {
    Folder folder;
    with_run(folder);
    const std::string page = "page" + extension;
    folder.file(page, "precious");
    const auto before = files_in(folder);
    const Outcome o = command(folder, "plot jet.h5 --force -o " + page, "ulimit -f 8;");
    EXPECT_EQ(o.exit_code, 1) << page;
    EXPECT_EQ(text_of(folder / page), "precious");
    EXPECT_EQ(files_in(folder), before);
  }
}

} // namespace
