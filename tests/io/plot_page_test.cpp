#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "io/fabricated_run.hpp"

namespace ehdjet::testing {
namespace {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(PlotPage, shows_the_parts_that_there_are) {
  const ScratchFolder folder;
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
  }
  const std::string frames = plot_page(RunReader(folder / "frames.h5"), {}, "page.png");
  EXPECT_TRUE(contains(frames, "Side view"));
  EXPECT_FALSE(contains(frames, "Path length"));
  const std::string observables =
      plot_page(RunReader(folder / "observables.h5"), {}, "page.png");
  EXPECT_FALSE(contains(observables, "Side view"));
  EXPECT_TRUE(contains(observables, "Path length"));
}

TEST(PlotPage, needs_something_to_draw_and_a_format_it_knows) {
  const ScratchFolder folder;
  {
    const auto bare = std::make_shared<RunFile>(folder / "bare.h5", false, Provenance{}, 1);
  }
  EXPECT_THROW(static_cast<void>(plot_page(RunReader(folder / "bare.h5"), {}, "page.png")),
               InputError);
  write_run(folder / "run.h5", 3);
  EXPECT_THROW(static_cast<void>(plot_page(RunReader(folder / "run.h5"), {}, "page.jpg")),
               InputError);
}

TEST(PlotPage, gnuplot_draws_it_without_a_word) {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "no gnuplot here";
  const ScratchFolder folder;
  write_run(folder / "it's a run.h5", 9);
  const RunReader run(folder / "it's a run.h5");
  for (const char* name : {"page.png", "page.svg", "page.pdf"}) {
    std::ofstream(folder / "page.gp") << plot_page(run, 4e-5, folder / name);
    const std::string command = "gnuplot '" + (folder / "page.gp").string() + "' > '"
                                + (folder / "words").string() + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(text_of(folder / "words"), "");
    EXPECT_GT(fs::file_size(folder / name), 5000U);
  }
}

} // namespace
} // namespace ehdjet::testing
