#include "ehdjet/scene/chain_file.hpp"

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include "support.hpp"

namespace ehdjet {
namespace {

/// A file that lives as long as the test.
class TemporaryFile {
public:
  explicit TemporaryFile(const std::string& extension, const std::string& content = "") {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path = std::filesystem::temp_directory_path()
           / ("ehdjet_" + std::string(test->name()) + "_" + std::to_string(::getpid())
              + extension);
    std::ofstream(path, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::filesystem::path path;
};

ChainBeads read_csv(const std::string& content) {
  const TemporaryFile file(".csv", content);
  return read_chain(file.path);
}
std::string csv_complaint(const std::string& content) {
  return complaint([&] { read_csv(content); });
}

const std::string header = "bead,x_m,y_m,z_m,mass_kg,charge_c,volume_m3\n";
const std::string two_beads = "0,0,0,0,1e-9,2e-11,0\n1,2e-4,0,0,1e-9,2e-11,1e-12\n";

TEST(ChainCsv, columns_come_in_any_order_and_others_are_ignored) {
  const ChainBeads b =
      read_csv("\xef\xbb\xbf# beads\r\n"
               "colour,stress_pa,volume_m3,charge_c,mass_kg,z_m,y_m,x_m,vz_m_s\r\n"
               "red,0,0,2e-11,1e-9,0.3,0.2,0.1,7\r\n"
               "\r\n"
               "blue, 5 ,1e-12,-2e-11,3e-9,-0.3,-0.2,1.1,-7\r\n");
  ASSERT_EQ(b.size(), 2u);
  EXPECT_EQ(b.x, (std::vector{0.1, 1.1}));
  EXPECT_EQ(b.y, (std::vector{0.2, -0.2}));
  EXPECT_EQ(b.z, (std::vector{0.3, -0.3}));
  EXPECT_EQ(b.vx, (std::vector{0.0, 0.0})); // not given
  EXPECT_EQ(b.vz, (std::vector{7.0, -7.0}));
  EXPECT_EQ(b.others.at("stress_pa").values, (std::vector{0.0, 5.0}));
  EXPECT_NE(b.others.at("colour").fault, ""); // for who would want it
  EXPECT_EQ(b.volume, (std::vector{0.0, 1e-12}));
  EXPECT_EQ(b.mass, (std::vector{1e-9, 3e-9}));
  EXPECT_EQ(b.charge, (std::vector{2e-11, -2e-11}));
}

TEST(ChainCsv, what_is_wrong_is_named_with_line_and_column) {
  EXPECT_EQ(csv_complaint(header + two_beads), "(accepted)");
  expect_all(csv_complaint(""), {".csv:1:1: ", "header"});
  expect_all(csv_complaint("x_m,y_m,z_m,mass_kg,volume_m3\n"),
             {".csv:1:1: ", "charge_c is missing"});
  expect_all(csv_complaint("x_m,y_m,x_m\n"), {".csv:1:9: ", "x_m appears twice"});
  expect_all(csv_complaint(header + two_beads + "2,4e-4,0,0,heavy,0,1e-12\n"),
             {".csv:4:12: ", "mass_kg = \"heavy\"", "a number"});
  expect_all(csv_complaint(header + two_beads + "2,4e-4,0,0,,0,1e-12\n"),
             {".csv:4:12: ", "mass_kg = \"\""});
  expect_all(csv_complaint(header + two_beads + "2,4e-4,nan,0,1e-9,0,1e-12\n"),
             {".csv:4:8: ", "y_m = nan", "finite"});
  expect_all(csv_complaint(header + two_beads + "2,1e999,0,0,1e-9,0,1e-12\n"),
             {".csv:4:3: ", "x_m = 1e999", "too large"});
  expect_all(csv_complaint(header + two_beads + "2,4e-4,0\n"),
             {".csv:4:1: ", "3 fields", "has 7"});
  expect_all(csv_complaint(header + two_beads + "2,4e-4,0,0,0,0,1e-12\n"),
             {".csv:4:12: ", "mass_kg = 0", "greater than 0"});
  expect_all(csv_complaint(header + two_beads + "2,4e-4,0,0,1e-9,0,0\n"),
             {".csv:4:19: ", "volume_m3 = 0", "greater than 0"});
  expect_all(csv_complaint(header + two_beads + "2,2e-4,0,0,1e-9,0,1e-12\n"),
             {".csv:4: ", "bead 2 is in the same place as bead 1"});
  expect_all(csv_complaint(header + "0,0,0,0,1e-9,2e-11,0\n"), {".csv:2: ", "at least 2"});
  expect_all(csv_complaint(header), {".csv:1: ", "0 bead(s)"});
}

TEST(ChainCsv, beads_must_be_in_order) {
  expect_all(csv_complaint(header + two_beads + "9,4e-4,0,0,1e-9,0,1e-12\n"),
             {".csv:4:1: ", "bead 9 after bead 1: beads must be in order from bead 0"});
  expect_all(csv_complaint(header + "1,0,0,0,1e-9,2e-11,0\n"),
             {".csv:2:1: ", "the first bead is 1"});
}

TEST(ChainCsv, an_embryo_is_no_bead_of_a_chain) {
  const std::string start =
      "x_m,y_m,z_m,mass_kg,charge_c,volume_m3,embryo\n0,0,0,1,0,0,0\n";
  EXPECT_EQ(csv_complaint(start + "1,0,0,1,0,1,0\n"), "(accepted)");
  expect_all(csv_complaint(start + "1,0,0,1,0,1,1\n"), {".csv:3:13: ", "embryo = 1"});
}

TEST(ChainCsv, has_a_single_frame) {
  const TemporaryFile file(".csv", header + two_beads);
  expect_all(complaint([&] { read_chain(file.path, 0.5); }),
             {"chain.time = 0.5 s", "HDF5"});
}

template <class T>
void write(hid_t file, const char* path, const std::vector<T>& values) {
  const hid_t type = std::is_same_v<T, double>         ? H5T_NATIVE_DOUBLE
                     : std::is_same_v<T, std::uint8_t> ? H5T_NATIVE_UINT8
                                                       : H5T_NATIVE_UINT64;
  const hsize_t size = values.size();
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t set =
      H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set);
  H5Sclose(space);
}

/// Two frames: 2 beads at t = 0, and at t = 1 an embryo between bead 0 and a bead that moved.
void write_run(const std::filesystem::path& path,
               std::vector<std::uint64_t> offset = {0, 2, 5},
               const std::string& left_out = "") {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  for (const char* group : {"/frames", "/beads"})
    H5Gclose(H5Gcreate2(file, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  write<double>(file, "/frames/time", {0, 1});
  write(file, "/frames/offset", offset);
  const auto column = [&](const std::string& name, const std::vector<double>& values) {
    if (name != left_out) write(file, ("/beads/" + name).c_str(), values);
  };
  column("x", {0, 2e-4, 0, 2e-4, 3e-4});
  column("y", {0, 1e-5, 0, 1e-6, 2e-5});
  column("z", {0, 0, 0, 0, 0});
  for (const char* name : {"vx", "vy", "vz"}) column(name, {0, 0.1, 0, 0.1, 0.2});
  column("volume", {0, 1e-12, 0, 1e-12, 1e-12});
  column("mass", {1e-9, 1e-9, 1e-9, 1e-9, 3e-9});
  column("charge", {2e-11, 2e-11, 2e-11, 2e-11, 4e-11});
  write<std::uint8_t>(file, "/beads/embryo", {0, 0, 0, 1, 0});
  H5Fclose(file);
}

TEST(ChainHdf5, the_last_frame_is_read_without_its_embryo) {
  const TemporaryFile file(".h5");
  write_run(file.path);
  const ChainBeads b = read_chain(file.path);
  ASSERT_EQ(b.size(), 2u);
  EXPECT_EQ(b.x, (std::vector{0.0, 3e-4}));
  EXPECT_EQ(b.y, (std::vector{0.0, 2e-5}));
  EXPECT_EQ(b.vz, (std::vector{0.0, 0.2}));
  EXPECT_EQ(b.mass, (std::vector{1e-9, 3e-9}));
  EXPECT_EQ(b.charge, (std::vector{2e-11, 4e-11}));
  EXPECT_EQ(b.volume, (std::vector{0.0, 1e-12}));
  EXPECT_TRUE(b.others.empty()
              || b.others.contains("embryo")); // no stress without viscoelasticity
}

TEST(ChainHdf5, the_frame_nearest_to_a_time_is_read) {
  const TemporaryFile file(".h5");
  write_run(file.path);
  EXPECT_EQ(read_chain(file.path, 0.4).x[1], 2e-4);
  EXPECT_EQ(read_chain(file.path, 0.6).x[1], 3e-4);
  EXPECT_EQ(read_chain(file.path, 1.9).x[1], 3e-4);
  expect_all(complaint([&] { read_chain(file.path, 100.0); }),
             {file.path.string(), "no frame at t = 100 s", "from t = 0 s to 1 s"});
}

// What a run leaves that was killed while it wrote.
TEST(ChainHdf5, frames_that_are_not_whole_do_not_count) {
  const TemporaryFile file(".h5");
  for (const auto& offset : std::vector<std::vector<std::uint64_t>>{{0, 2, 6}, {0, 2}}) {
    write_run(file.path, offset);
    EXPECT_EQ(read_chain(file.path).x, (std::vector{0.0, 2e-4}));
  }
  write_run(file.path, {0, 2, 5, 5});
  EXPECT_EQ(read_chain(file.path).x[1], 3e-4);
}

TEST(ChainHdf5, what_is_wrong_is_named_with_the_dataset) {
  const TemporaryFile file(".h5");
  const auto refused = [&] { return complaint([&] { read_chain(file.path); }); };
  write_run(file.path, {0, 2, 5}, "mass");
  expect_all(refused(), {file.path.string(), "no dataset /beads/mass"});
  write_run(file.path, {0});
  expect_all(refused(), {file.path.string(), "has no frame yet"});
  write_run(file.path, {0, 2, 1});
  expect_all(refused(), {file.path.string(), "frame 1 of /frames/offset has no beads"});
  write_run(file.path, {0, 4, 5});
  expect_all(refused(), {"frame 1 (t = 1 s), bead 0", "needs at least 2"});
  std::filesystem::resize_file(file.path, 100);
  expect_all(refused(), {"no readable HDF5 file"});
}

TEST(ChainScene, paths_are_relative_to_the_scene_and_beads_end_before_the_collector) {
  const TemporaryFile file(".csv", header + two_beads);
  const std::string text = "[run]\nend_time = 1\n[chain]\nfile = \""
                           + file.path.filename().string()
                           + "\"\n[collector]\ndistance = 1e-4\n";
  const auto folder = file.path.parent_path();
  expect_all(complaint([&] { read_scene_text(text, "s.toml", folder); }),
             {"s.toml:6: collector.distance = 0.0001 m", "bead 1", "x = 0.0002 m"});
  const Scene s = read_scene_text(text, "s.toml", folder, {"collector.distance=2e-4"});
  EXPECT_EQ(s.chain.size(), 2u); // a landed bead lies on the plane
}

TEST(ChainScene, of_links_that_are_half_dry_needs_evaporation_and_wet_enough_links) {
  const TemporaryFile file(
      ".csv", "x_m,y_m,z_m,mass_kg,charge_c,volume_m3,evaporated\n0,0,0,1e-9,2e-11,0,0\n"
              "2e-4,0,0,1e-9,2e-11,1e-12,0.95\n");
  const std::string folder = file.path.parent_path().string(),
                    wet = "[run]\nend_time = 1e-6\n[chain]\nfile = \""
                          + file.path.filename().string() + "\"\n";
  const auto refusal = [&](const std::string& text) {
    return complaint([&] { (void)read_scene_text(text, "s.toml", folder); });
  };
  expect_all(refusal(wet), {"evaporated = 0.95 of bead 1", "without [evaporation]"});
  expect_all(
      refusal(wet
              + "[air]\n[evaporation]\nsolvent_density = 789\npolymer_density = "
                "1200\npolymer_fraction = 0.1\ndiffusivity = 1e-5\nsaturation = 0.1\n"),
      {"evaporated = 0.95 of bead 1", "from 0 to 0.92"});
}

} // namespace
} // namespace ehdjet
