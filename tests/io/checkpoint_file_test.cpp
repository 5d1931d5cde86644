#include "ehdjet/core/error.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/fabricated_run.hpp"

namespace ehdjet::testing {
namespace {

TEST(CheckpointFile, has_the_last_one_at_once_and_after_the_end) {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  {
    const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
    for (std::uint64_t k = 0; k < 4; ++k) {
      file->keep(fabricated_checkpoint(k));
      EXPECT_EQ(RunReader(path).checkpoint(), fabricated_checkpoint(k)) << k;
    }
    file->finish("complete", "", {}, {});
  }
  EXPECT_EQ(RunReader(path).checkpoint(), fabricated_checkpoint(3));
}

TEST(CheckpointFile, flushes_what_was_written_before) {
  const ScratchFolder folder;
  const auto file =
      std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
  const auto frames = record_frames(file, 1e-5, *test::table_with_stress());
  frames->observe(fabricated_jet(0).snapshot());
  EXPECT_EQ(RunReader(folder / "run.h5").frame_times().size(), 0U);
  file->keep(fabricated_checkpoint(0));
  EXPECT_EQ(RunReader(folder / "run.h5").frame_times().size(), 1U);
}

TEST(CheckpointFile, does_not_grow_with_the_number_of_checkpoints) {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  for (std::uint64_t k = 0; k < 12; ++k) file->keep(fabricated_checkpoint(k));
  const auto size = std::filesystem::file_size(path);
  for (std::uint64_t k = 12; k < 200; ++k) file->keep(fabricated_checkpoint(k));
  EXPECT_EQ(std::filesystem::file_size(path), size);
}

TEST(CheckpointFile, without_one_says_how_to_get_one) {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  try {
    (void)RunReader(path).checkpoint();
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("output.checkpoints"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("run.h5"), std::string::npos);
  }
}

} // namespace
} // namespace ehdjet::testing
