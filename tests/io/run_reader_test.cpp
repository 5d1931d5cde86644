#include "ehdjet/core/error.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <string>

#include "io/fabricated_run.hpp"

namespace ehdjet::testing {
namespace {

namespace fs = std::filesystem;

// What the reader says about a file that it does not want.
std::string complaint(const fs::path& path) {
  try {
    const RunReader run(path);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(path.string() + " ")) << message;
    return message.substr(path.string().size() + 1);
  }
  return "no complaint";
}

TEST(RunReader, says_why_a_file_is_no_run) {
  const Folder folder;
  EXPECT_EQ(complaint(folder / "absent.h5"), "does not exist");
  EXPECT_EQ(complaint(folder.path()), "is a folder, not a run file");
  std::ofstream(folder / "empty.h5").flush();
  EXPECT_EQ(complaint(folder / "empty.h5"), "is not an HDF5 file");
  std::ofstream(folder / "text.h5") << std::string(3000, 'x');
  EXPECT_EQ(complaint(folder / "text.h5"), "is not an HDF5 file");
  H5Fclose(
      H5Fcreate((folder / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_EQ(complaint(folder / "other.h5"),
            "is not an ehdjet run: it has no attribute format = \"ehdjet run\"");
}

TEST(RunReader, rejects_a_truncated_file_wherever_it_was_cut) {
  const Folder folder;
  write_run(folder / "run.h5", 20);
  const std::string whole = text_of(folder / "run.h5");
  for (const double part : {0.01, 0.3, 0.7, 0.999}) {
    const auto bytes = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    std::ofstream(folder / "cut.h5", std::ios::binary) << whole.substr(0, bytes);
    EXPECT_NE(complaint(folder / "cut.h5").find("truncated"), std::string::npos) << part;
  }
}

TEST(RunReader, rejects_a_file_of_a_later_format) {
  const Folder folder;
  write_run(folder / "run.h5", 1);
  const hid_t file = H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t version = H5Aopen(file, "format_version", H5P_DEFAULT);
  const int later = 2;
  H5Awrite(version, H5T_NATIVE_INT, &later);
  H5Aclose(version), H5Fclose(file);
  EXPECT_EQ(complaint(folder / "run.h5"),
            "has format version 2; this ehdjet reads up to 1");
}

TEST(RunReader, takes_the_nearest_frame_and_of_two_the_earlier) {
  const Folder folder;
  {
    const auto file = std::make_shared<RunFile>(folder / "run.h5", false, Provenance{}, 1);
    const auto shown = record_frames(file, 0.25, *test::table_with_stress());
    for (const double time :
         {0., 0.25, 0.5, 0.75}) { // exact in binary, so that ties are ties
      FabricatedJet jet = fabricated_jet(3);
      jet.time = time;
      shown->observe(jet.snapshot());
    }
  }
  const RunReader run(folder / "run.h5");
  EXPECT_EQ(run.nearest_frame(0), 0U);
  EXPECT_EQ(run.nearest_frame(0.1), 0U);
  EXPECT_EQ(run.nearest_frame(0.125), 0U);
  EXPECT_EQ(run.nearest_frame(0.2), 1U);
  EXPECT_EQ(run.nearest_frame(0.625), 2U);
  EXPECT_EQ(run.nearest_frame(0.99), 3U); // a run ends before the next frame
  for (const double beyond : {-1., 1.01, 7.})
    EXPECT_THROW((void)run.nearest_frame(beyond), InputError) << beyond;
}

TEST(RunReader, a_run_without_a_frame_yet_has_no_nearest_one) {
  const Folder folder;
  const auto file = std::make_shared<RunFile>(folder / "run.h5", false, Provenance{}, 1);
  const auto shown = record_frames(file, 1, *test::table_with_stress());
  const RunReader run(folder / "run.h5");
  EXPECT_TRUE(run.frame_times().empty());
  EXPECT_THROW(static_cast<void>(run.nearest_frame(0)), InputError);
  EXPECT_THROW(static_cast<void>(run.frame(0)), ContractViolation);
}

} // namespace
} // namespace ehdjet::testing
