#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <gmock/gmock.h>
#include <string>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;

/// Five frames of a jet, and five of one with another surface tension.
class Plot : public testing::Test {
protected:
  void SetUp() override {
    if (std::system("gnuplot --version > /dev/null 2>&1") != 0) // NOLINT(cert-env33-c)
      GTEST_SKIP() << "no gnuplot here";
    const std::string run = "run " EHDJET_SCENES "/quickstart.toml --set run.end_time=4e-4 "
                            "--set output.frames=1e-4 -o ";
    ASSERT_EQ(command(folder_, run + "one.h5").exit_code, 0);
    ASSERT_EQ(
        command(folder_, run + "two.h5 --set surface_tension.coefficient=0.03").exit_code,
        0);
  }
  void expect_drawn(const std::string& arguments) {
    const Outcome o = command(folder_, "plot " + arguments);
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(o.err, "");
  }
  Folder folder_;
};

TEST_F(Plot, a_page_has_the_title_of_the_scene_and_the_name_of_the_file) {
  expect_drawn("one.h5 -o one.svg");
  EXPECT_THAT(text_of(folder_ / "one.svg"), AllOf(HasSubstr("PVP jet, the first 8 ms"),
                                                  HasSubstr("one.h5,  t = 400 µs")));
}

TEST_F(Plot, a_comparison_says_in_which_keys_the_runs_differ) {
  expect_drawn("one.h5 --compare two.h5 -o both.svg --size 900x700");
  EXPECT_THAT(text_of(folder_ / "both.svg"),
              AllOf(HasSubstr("one.h5:  surface_tension.coefficient = 0.021133,"),
                    HasSubstr("two.h5:  surface_tension.coefficient = 0.03,")));
  const Outcome many = command(folder_, "plot one.h5 -o many.svg --compare two.h5 two.h5 "
                                        "two.h5 two.h5 two.h5 two.h5 two.h5 two.h5");
  EXPECT_EQ(many.exit_code, 2);
}

TEST_F(Plot, a_movie_has_every_frame) {
  expect_drawn("one.h5 --movie --size 640x480");
  const std::string movie = text_of(folder_ / "one.gif");
  EXPECT_THAT(movie, testing::StartsWith("GIF89a"));
  std::size_t images = 0;
  for (std::size_t at = 0; (at = movie.find("\x21\xF9\x04", at)) != std::string::npos; ++at)
    ++images;
  EXPECT_EQ(images, 5U);
  EXPECT_EQ(command(folder_, "plot one.h5 --movie --time 1e-4").exit_code, 2);
}

TEST_F(Plot, an_mp4_needs_ffmpeg) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") == 0) { // NOLINT(cert-env33-c)
    expect_drawn("one.h5 --movie --size 641x481 -o one.mp4");
    EXPECT_EQ(text_of(folder_ / "one.mp4").substr(4, 4), "ftyp");
  }
  const Outcome o =
      command(folder_, "plot one.h5 --movie -o none.mp4",
              "mkdir bin && ln -s \"$(command -v gnuplot)\" bin && PATH=\"$PWD/bin\"");
  EXPECT_EQ(o.exit_code, 1);
  EXPECT_THAT(o.err, AllOf(HasSubstr("ffmpeg not found"), HasSubstr(".gif")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.mp4"));
}

TEST_F(Plot, what_cannot_be_drawn_is_refused) {
  for (const char* arguments :
       {"--size 100x100", "--size large", "--size 800", "--size 800x600x3",
        "--panels side,sides", "--panels side,,tip", "--panels ,side", "--movie -o one.png",
        "-o one.gif", "--panels map", "--panels side,map",
        "--movie --frames-per-second 60"}) {
    const Outcome o = command(folder_, std::string("plot one.h5 ") + arguments);
    EXPECT_EQ(o.exit_code, 2) << arguments << ": " << o.err;
    EXPECT_NE(o.err, "") << arguments;
  }
}

TEST_F(Plot, notes_say_what_is_not_as_one_asked_for) {
  const Outcome small = command(folder_, "plot one.h5 -o small.png --size 480x360");
  EXPECT_EQ(small.exit_code, 0);
  EXPECT_THAT(small.err, AllOf(HasSubstr("no room for "), HasSubstr("480x360")));
  const Outcome fast =
      command(folder_, "plot one.h5 --movie --frames-per-second 30 -o fast.gif");
  EXPECT_EQ(fast.exit_code, 0);
  EXPECT_THAT(fast.err, HasSubstr("33.33 frames per second instead of 30"));
}

TEST_F(Plot, a_movie_compares_with_a_shorter_run) {
  ASSERT_EQ(command(folder_, "run " EHDJET_SCENES "/quickstart.toml -o short.h5 --set "
                             "run.end_time=2e-4 --set output.frames=1e-4")
                .exit_code,
            0);
  expect_drawn("one.h5 --compare short.h5 --movie -o both.gif");
}

TEST_F(Plot, a_free_chain_has_no_nozzle) {
  ASSERT_EQ(command(folder_, "run " EHDJET_SCENES "/startup.toml -o startup.h5").exit_code,
            0);
  expect_drawn("startup.h5 -o startup.svg");
  EXPECT_THAT(text_of(folder_ / "startup.svg"),
              AllOf(HasSubstr("length from the first bead"), HasSubstr("axis (mm)"),
                    testing::Not(HasSubstr("nozzle"))));
}

TEST_F(Plot, characters_that_no_font_has_are_replaced) {
  // A character for private use, and an fc-list that knows none.
  std::filesystem::copy(folder_ / "one.h5", folder_ / "a\U00105555b.h5");
  std::filesystem::create_directory(folder_ / "bin");
  const Outcome o = command(folder_, "plot a\U00105555b.h5 -o private.pdf",
                            "ln -s \"$(command -v true)\" bin/fc-list && "
                            "PATH=\"$PWD/bin:$PATH\"");
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_THAT(o.err, AllOf(HasSubstr("U+105555"), HasSubstr("?")));
  // Without fc-list nobody can say what is there.
  const Outcome none = command(folder_, "plot a\U00105555b.h5 -o none.pdf",
                               "mkdir only && ln -s \"$(command -v gnuplot)\" only && "
                               "PATH=\"$PWD/only\"");
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_THAT(none.err, HasSubstr("U+105555"));
}

} // namespace
