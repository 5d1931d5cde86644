#include "ehdjet/core/error.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "io/fabricated_run.hpp"

namespace ehdjet::testing {
namespace {

TEST(CheckpointFile, has_the_last_one_at_once_and_after_the_end) {
  const Folder folder;
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
  const Folder folder;
  const auto file =
      std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
  const auto frames = record_frames(file, 1e-5, *test::table_with_stress());
  frames->observe(fabricated_jet(0).snapshot());
  EXPECT_EQ(RunReader(folder / "run.h5").frame_times().size(), 0U);
  file->keep(fabricated_checkpoint(0));
  EXPECT_EQ(RunReader(folder / "run.h5").frame_times().size(), 1U);
}

TEST(CheckpointFile, does_not_grow_with_the_number_of_checkpoints) {
  const Folder folder;
  const auto path = folder / "run.h5";
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  for (std::uint64_t k = 0; k < 12; ++k) file->keep(fabricated_checkpoint(k));
  const auto size = std::filesystem::file_size(path);
  for (std::uint64_t k = 12; k < 200; ++k) file->keep(fabricated_checkpoint(k));
  EXPECT_EQ(std::filesystem::file_size(path), size);
}

// Wherever it is in the numbers.
TEST(CheckpointFile, with_a_flipped_bit_is_refused) {
  const Folder folder;
  const auto path = folder / "run.h5";
  Checkpoint kept = fabricated_checkpoint(5);
  kept["y"].assign(11000, std::sqrt(2)); // eight bytes that are nowhere else in the file
  {
    const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
    file->keep(kept);
    file->finish("complete", "", {}, {});
  }
  const std::string whole = text_of(path);
  const std::string number(reinterpret_cast<const char*>(kept.at("y").data()),
                           sizeof(double));
  std::mt19937 bits(4);
  int flipped = 0;
  for (auto place = whole.find(number); place != std::string::npos;
       place = whole.find(number, place + number.size())) {
    if (flipped > 100 && bits() % 100 != 0) continue;
    std::string damaged = whole;
    damaged[place + bits() % number.size()] ^= static_cast<char>(1U << bits() % 8);
    std::ofstream(path, std::ios::binary) << damaged;
    ++flipped;
    try {
      (void)RunReader(path).checkpoint();
      ADD_FAILURE() << place;
    } catch (const InputError& e) {
      const std::string message = e.what();
      EXPECT_NE(message.find("run.h5"), std::string::npos) << message;
      EXPECT_NE(message.find("/checkpoint/a/numbers"), std::string::npos) << message;
      EXPECT_NE(message.find("checksum"), std::string::npos) << message;
    }
  }
  EXPECT_GT(flipped, 100);
}

TEST(CheckpointFile, without_checksum_is_refused) {
  const Folder folder;
  const auto path = folder / "run.h5";
  {
    const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
    file->keep(fabricated_checkpoint(0));
  }
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  EXPECT_GE(H5Adelete_by_name(file, "checkpoint/a/offset", "crc32", H5P_DEFAULT), 0);
  H5Fclose(file);
  try {
    (void)RunReader(path).checkpoint();
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("/checkpoint/a/offset has no checksum"),
              std::string::npos)
        << e.what();
  }
}

TEST(CheckpointFile, with_other_lists_than_the_one_before_is_an_error) {
  const Folder folder;
  const auto file =
      std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
  file->keep(fabricated_checkpoint(0));
  Checkpoint other = fabricated_checkpoint(1);
  other["another"] = {1};
  EXPECT_THROW(file->keep(other), RunError);
}

TEST(CheckpointFile, without_one_says_how_to_get_one) {
  const Folder folder;
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
