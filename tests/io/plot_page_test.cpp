#include "ehdjet/core/error.hpp"
#include "ehdjet/io/plot_page.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <numbers>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "io/fabricated_run.hpp"
#include "io/panel.hpp"

namespace ehdjet::testing {
namespace {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1))
    ++n;
  return n;
}

std::string page_of(const RunReader& run, const PageOptions& options = {},
                    std::optional<double> time = {}) {
  return PlotPage({{&run, "run.h5"}}, "A jet", options).draw(time);
}

class PlotPageOfRun : public ::testing::Test {
protected:
  Folder folder_;
  RunReader run_ = [this] {
    write_run(folder_ / "it's a run.h5", 9);
    return RunReader(folder_ / "it's a run.h5");
  }();
};

TEST(PlotPage, shows_the_parts_that_there_are) {
  const Folder folder;
  {
    const auto file =
        std::make_shared<RunFile>(folder / "frames.h5", false, Provenance{}, 1);
    record_frames(file, 1, *test::table_with_stress())
        ->observe(fabricated_jet(7).snapshot());
  }
  {
    const auto file =
        std::make_shared<RunFile>(folder / "observables.h5", false, Provenance{}, 1);
    record_observables(file, 1)->observe(fabricated_jet(7).snapshot());
    record_deposit(file, test::table_with_stress()); // nothing has landed
  }
  const std::string frames = page_of(RunReader(folder / "frames.h5"));
  for (const char* panel : {"A jet", "run.h5", "Side view", "Along the axis", "In space",
                            "Radius along the jet"})
    EXPECT_TRUE(contains(frames, panel)) << panel;
  for (const char* panel : {"Path length", "Fibre on the collector", "Length of fibre"})
    EXPECT_FALSE(contains(frames, panel)) << panel;
  const std::string observables = page_of(RunReader(folder / "observables.h5"));
  EXPECT_TRUE(contains(observables, "Path length"));
  for (const char* panel : {"Side view", "In space", "Radius along the jet",
                            "Fibre on the collector", "Length of fibre"})
    EXPECT_FALSE(contains(observables, panel)) << panel;
}

TEST_F(PlotPageOfRun, shows_the_panels_that_were_asked_for) {
  const std::string page = page_of(run_, {.panels = {"space", "tip"}});
  EXPECT_TRUE(contains(page, "In space"));
  EXPECT_TRUE(contains(page, "Tip: distance from the axis"));
  EXPECT_FALSE(contains(page, "Side view"));
  EXPECT_FALSE(contains(page, "Path length"));
}

TEST(PlotPage, needs_something_to_draw_a_format_it_knows_and_a_size) {
  const Folder folder;
  {
    const auto bare = std::make_shared<RunFile>(folder / "bare.h5", false, Provenance{}, 1);
  }
  const RunReader bare(folder / "bare.h5");
  EXPECT_THROW(page_of(bare), InputError);
  write_run(folder / "run.h5", 3);
  const RunReader run(folder / "run.h5");
  const PlotPage page({{&run, ""}}, "", {});
  for (const char* name : {"page.jpg", "page", "page.gif", "page.mp4"})
    EXPECT_THROW(static_cast<void>(page.terminal(name)), InputError) << name;
  for (const char* name : {"page.png", "page.svg"})
    EXPECT_THROW(static_cast<void>(page.terminal(name, 20)), InputError) << name;
  for (const auto& [width, height] :
       {std::pair{479., 900.}, {900., 359.}, {1e5, 900.}, {std::nan(""), 900.}})
    EXPECT_THROW(page_of(run, {.width = width, .height = height}), InputError);
}

// What is drawn in which range: the lines that set ranges of the first two panels, the views.
std::string ranges_of_views(const std::string& page) {
  std::string ranges;
  std::size_t at = 0;
  for (int k = 0; k < 4; ++k) {
    at = page.find("range [", at + 1);
    ranges += page.substr(at, page.find('\n', at) - at);
  }
  return ranges;
}

TEST_F(PlotPageOfRun, fixed_axes_are_the_same_at_all_times) {
  const double first = run_.frame_times().front(), last = run_.frame_times().back();
  const auto ranges = [&](double time, bool fixed) {
    return ranges_of_views(page_of(run_, {.fixed_axes = fixed}, time));
  };
  EXPECT_NE(ranges(first, false), ranges(last, false));
  EXPECT_EQ(ranges(first, true), ranges(last, true));
}

TEST_F(PlotPageOfRun, several_runs_have_colours_and_names) {
  write_run(folder_ / "other.h5", 5);
  const RunReader other(folder_ / "other.h5");
  const PlotPage page({{&run_, "tolerance = 1"}, {&other, "tolerance = 2"}}, "", {});
  const std::string text = page.draw({});
  for (const char* name : {"tolerance = 1", "tolerance = 2", "#0072B2", "#D55E00"})
    EXPECT_TRUE(contains(text, name)) << name;
  EXPECT_EQ(count(text, "tolerance = 1"), 1U); // one legend for all panels
}

// The number of labelled ticks of each axis of a page.
std::vector<double> ticks_of(const std::string& page) {
  std::vector<double> ticks;
  static const std::regex axis(
      R"(set ([xyz])range \[(\S+):(\S+)\]\nset \1tics (\(.*\)|\S+))");
  for (std::sregex_iterator a(page.begin(), page.end(), axis), end; a != end; ++a) {
    const std::string step = (*a)[4];
    if (step[0] == '(') {
      ticks.push_back(1 + static_cast<double>(std::ranges::count(step, ',')));
    } else {
      const double low = std::stod((*a)[2]), high = std::stod((*a)[3]), d = std::stod(step);
      ticks.push_back(1 + std::floor(high / d) - std::ceil(low / d));
    }
  }
  return ticks;
}

TEST_F(PlotPageOfRun, every_axis_has_ticks_at_every_size) {
  for (const auto& [width, height] :
       {std::pair{480., 360.}, {640., 1400.}, {1600., 1200.}, {5000., 2000.}}) {
    const std::vector<double> ticks =
        ticks_of(page_of(run_, {.width = width, .height = height}));
    EXPECT_GE(ticks.size(), width < 600 ? 6U : 14U); // of at least three or seven panels
    for (const double n : ticks) {
      EXPECT_GE(n, 2) << width << 'x' << height;
      EXPECT_LE(n, 13) << width << 'x' << height;
    }
  }
}

/// A run of two beads at rest on the axis, of which every history is a constant.
void write_straight_run(const fs::path& path) {
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  const auto observables = record_observables(file, 1e-5);
  const auto frames = record_frames(file, 1e-5, *BeadTable::basic());
  FabricatedJet jet = fabricated_jet(0, false);
  jet.values.assign(jet.values.size(), 0);
  jet.ledger.impact_speed = 0;
  jet.values[1] = 0.1; // x of the second bead
  for (const double time : {0., 1e-5}) {
    jet.time = time;
    observables->observe(jet.snapshot());
    frames->observe(jet.snapshot());
  }
}

TEST(PlotPage, lengths_that_are_all_zero_have_axes_in_millimetres) {
  const Folder folder;
  write_straight_run(folder / "straight.h5");
  const RunReader run(folder / "straight.h5");
  const std::string tip = page_of(run, {.panels = {"tip"}});
  EXPECT_TRUE(contains(tip, "Tip: distance from the axis (mm)"));
  EXPECT_TRUE(contains(tip, "set yrange [-1:1]")) << tip;
  const std::string page = page_of(run, {.panels = {"side", "along", "space", "tip"}});
  EXPECT_FALSE(contains(page, "(nm)"));
  EXPECT_EQ(ticks_of(tip).at(1), 5); // a few are enough for a zero
  EXPECT_TRUE(contains(page_of(run, {.panels = {"beads"}}), "set ytics 1\n"));
}

TEST(PlotPage, one_tick_alone_is_replaced_by_several) {
  const Canvas page{480, 360, 10};
  for (const double half : {0.99, 1.01, 1.99, 2.01, 3.99, 4.5, 4.99, 5.01, 9.99}) {
    const Panel panel{.title = "",
                      .x = {"x", {"", 1}, {-half, half}},
                      .y = {"y", {"", 1}, {-half, half}},
                      .curves = {}};
    for (const double n : ticks_of(page.draw(panel, {0, 0, 150, 120})))
      EXPECT_GE(n, 2) << half;
    const std::string space =
        page.draw_in_space({}, {0, 3 * half}, half, {"m", 1}, {0, 0, 150, 140});
    for (const double n : ticks_of(space)) EXPECT_GE(n, 2) << half;
  }
}

// Between which heights of the page the box in space is seen, by gnuplot's rules for a box between margins.
TEST(PlotPage, the_box_in_space_is_below_its_title_and_within_its_cell) {
  const auto margin = [](const std::string& text, const std::string& name) {
    const std::string key = "set " + name + " at screen ";
    return std::stod(text.substr(text.find(key) + key.size()));
  };
  for (const auto& [width, height] : {std::pair{600., 280.}, {200., 220.}, {400., 460.}})
    for (const double across : {0.2, 0.5, 5.}) {
      const Canvas page{1000, 1000, 10};
      const Box cell{300, 500, width, height};
      const std::string s = page.draw_in_space({}, {0, 1}, across, {"m", 1}, cell);
      const double left = 1000 * margin(s, "lmargin"), right = 1000 * margin(s, "rmargin"),
                   low = 1000 * margin(s, "bmargin"), high = 1000 * margin(s, "tmargin");
      EXPECT_NEAR(right - left, high - low, 0.1);
      const double turned = std::cos(2 * std::numbers::pi / 9)
                            + std::sin(2 * std::numbers::pi / 9),
                   scale = (right - left) / (2 * across), tilt = 13 * std::numbers::pi / 36;
      const double seen_width = 2 * across * turned * scale,
                   seen_height =
                       scale * (2 * across * turned * std::cos(tilt) + std::sin(tilt));
      EXPECT_LE((high + low + seen_height) / 2, 500 + height - 25); // below the title
      EXPECT_GE((high + low - seen_height) / 2, 500);
      EXPECT_GE((left + right - seen_width) / 2, 300);
      EXPECT_LE((left + right + seen_width) / 2, 300 + width);
    }
}

TEST(PlotPage, titles_stay_within_their_cells) {
  EXPECT_EQ(Canvas::fitted("short", 10, 100), "short");
  EXPECT_EQ(Canvas::fitted("much too long", 10, 60), "much to...");
  EXPECT_EQ(Canvas::fitted("\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9", 10, 31),
            "\u00e9\u00e9...");
  const Canvas page{100, 100, 10};
  EXPECT_TRUE(contains(page.titled("1234567890", 90, 50, {0, 0, 100, 100}),
                       "at screen 0.70000,0.50000 center"));
}

TEST_F(PlotPageOfRun, what_has_no_room_is_left_out_or_refused) {
  const PlotPage small({{&run_, "run.h5"}}, "", {.width = 480, .height = 360});
  const std::vector<std::string>& left_out = small.left_out();
  EXPECT_EQ(std::ranges::count(left_out, "impact"), 1);
  EXPECT_EQ(std::ranges::count(left_out, "side"), 0);
  EXPECT_FALSE(contains(small.draw({}), "Impact speed"));
  EXPECT_TRUE(PlotPage({{&run_, "run.h5"}}, "", {}).left_out().empty());

  std::vector<std::string> all;
  for (const auto& [name, what] : page_panels()) all.push_back(name);
  try {
    page_of(run_, {.width = 480, .height = 360, .panels = all});
    ADD_FAILURE() << "ten panels on a small page";
  } catch (const InputError& error) {
    const std::string message = error.what(), need = "they need 480x";
    ASSERT_TRUE(contains(message, need)) << message;
    const double height = std::stod(message.substr(message.find(need) + need.size()));
    EXPECT_NO_THROW(PlotPage({{&run_, "run.h5"}}, "A jet",
                             {.width = 480, .height = height, .panels = all}));
  }
}

TEST(PlotPage, a_panel_without_data_is_refused_with_the_key_that_brings_them) {
  const Folder folder;
  write_straight_run(folder / "run.h5");
  const RunReader run(folder / "run.h5");
  try {
    page_of(run, {.panels = {"side", "map"}});
    ADD_FAILURE() << "there is no deposit";
  } catch (const InputError& error) {
    for (const char* part : {"panel map", "run.h5 has no deposit", "output.deposit = true"})
      EXPECT_TRUE(contains(error.what(), part)) << error.what();
  }
  EXPECT_THROW(page_of(run, {.panels = {"impact"}}), InputError); // nothing has landed
}

TEST_F(PlotPageOfRun, a_panel_that_was_asked_for_waits_for_the_first_landing) {
  EXPECT_THROW(page_of(run_, {.panels = {"side", "map"}}, 0), InputError);
  EXPECT_NO_THROW(page_of(run_, {.panels = {"side", "map"}, .fixed_axes = true}, 0));
}

TEST_F(PlotPageOfRun, a_chain_without_a_nozzle_has_a_first_bead) {
  EXPECT_TRUE(contains(page_of(run_), "length from the nozzle"));
  const std::string free = PlotPage({{&run_, "run.h5", false}}, "", {}).draw({});
  EXPECT_TRUE(contains(free, "length from the first bead"));
  EXPECT_TRUE(contains(free, "title 'first bead'"));
  EXPECT_FALSE(contains(free, "nozzle"));
}

TEST_F(PlotPageOfRun, a_run_that_is_over_stands_still_in_a_movie) {
  write_run(folder_ / "short.h5", 3);
  const RunReader over(folder_ / "short.h5");
  const auto draw = [&](bool movie) {
    return PlotPage({{&run_, "long"}, {&over, "short"}}, "",
                    {.width = 960, .height = 720, .movie = movie})
        .draw(run_.frame_times().back());
  };
  EXPECT_TRUE(contains(draw(true), "short,  t = 20 \u00b5s")) << draw(true).substr(0, 900);
  EXPECT_THROW(draw(false), InputError);
}

TEST_F(PlotPageOfRun, a_gif_has_all_colours_and_a_speed_that_it_can_show) {
  const PlotPage page({{&run_, ""}}, "", {.movie = true});
  EXPECT_FALSE(contains(page.terminal("m.gif", 20), "optimize")); // colours of one frame
  EXPECT_TRUE(contains(page.terminal("m.gif", 20), "delay 5 "));
  EXPECT_DOUBLE_EQ(PlotPage::gif_frames_per_second(30), 100 / 3.);
  EXPECT_DOUBLE_EQ(PlotPage::gif_frames_per_second(50), 50);
  EXPECT_THROW(static_cast<void>(page.terminal("m.gif", 60)), InputError);
  EXPECT_NO_THROW(static_cast<void>(page.terminal("m.mp4", 60)));
}

TEST_F(PlotPageOfRun, gnuplot_draws_it_without_a_word) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "no gnuplot here";
  const PlotPage small({{&run_, "it's a run.h5"}}, "It's a \"jet\" of 5 µm",
                       {.width = 480, .height = 360});
  const auto draw = [&](const std::string& name, const std::string& script,
                        const std::string& words = "") {
    std::ofstream(folder_ / "page.gp") << script;
    const std::string command =
        "gnuplot --default-settings - < '" + (folder_ / "page.gp").string() + "' > '"
        + (folder_ / name).string() + "' 2> '" + (folder_ / "words").string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
    EXPECT_EQ(text_of(folder_ / "words"), words) << name;
    EXPECT_GT(fs::file_size(folder_ / name), 5000U) << name;
  };
  for (const char* name : {"page.png", "page.svg", "page.pdf"})
    draw(name, small.terminal(name) + small.draw(4e-5));
  draw("movie.gif", small.terminal("movie.gif", 20) + small.draw(0) + small.draw(4e-5),
       "2 frames in animation sequence\n");
}

} // namespace
} // namespace ehdjet::testing
