#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"
#include "ehdjet/run_files/run_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "io/fabricated_run.hpp"

namespace ehdjet::testing {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<double> numbers_in(const std::string& line, char separator) {
  std::vector<double> numbers;
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, separator);) {
    numbers.push_back(std::strtod(word.c_str(), nullptr));
  }
  return numbers;
}

using Rows = std::vector<std::vector<double>>;

// Header and numbers of a CSV export.
std::pair<std::string, Rows> csv(const Folder& folder,
                                 const std::function<void(TextOutput&)>& write) {
  TextOutput output(folder / "out.csv", true);
  write(output);
  const std::vector<std::string> lines = lines_of(text_of(folder / "out.csv"));
  Rows rows;
  for (std::size_t i = 1; i < lines.size(); ++i) rows.push_back(numbers_in(lines[i], ','));
  return {lines.at(0), rows};
}

class Export : public ::testing::Test {
protected:
  Export() { write_run(folder_ / "run.h5", 9); }
  Folder folder_;
};

TEST_F(Export, observables_have_the_documented_columns_and_keep_every_bit) {
  const RunReader run(folder_ / "run.h5");
  const auto [header, rows] =
      csv(folder_, [&](TextOutput& to) { export_table(run, "observables", to); });
  EXPECT_EQ(header,
            "time_s,beads,tip_x_m,tip_yz_m,path_length_m,nozzle_speed_m_s,impact_speed_m_s,"
            "collector_radius_m,current_in_a,current_out_a,aperture_deg,evaluations,steps,"
            "rejected");
  ASSERT_EQ(rows.size(), 9U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), 14U);
    EXPECT_EQ(rows[k][0], run.column("observables", "time")[k]);
    EXPECT_EQ(rows[k][2], run.column("observables", "tip_x")[k]);
    EXPECT_EQ(rows[k][4], run.column("observables", "path_length")[k]);
    EXPECT_EQ(rows[k][6], run.column("observables", "impact_speed")[k]);
    EXPECT_EQ(rows[k][8], run.column("observables", "current_in")[k]);
    EXPECT_EQ(rows[k][10], run.column("observables", "aperture")[k]);
    EXPECT_EQ(rows[k][11], run.column("observables", "evaluations")[k]);
  }
}

TEST_F(Export, beads_have_the_documented_columns_and_keep_every_bit) {
  const RunReader run(folder_ / "run.h5");
  const auto [header, rows] =
      csv(folder_, [&](TextOutput& to) { export_beads(run, 4.4e-5, to); });
  EXPECT_EQ(header,
            "bead,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,stress_pa,radius_m,volume_m3,mass_kg,"
            "charge_c,landed,embryo");
  const Frame f = run.frame(4);
  ASSERT_EQ(rows.size(), f.rows());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::vector<double> expected = {static_cast<double>(k),
                                          f["x"][k],
                                          f["y"][k],
                                          f["z"][k],
                                          f["vx"][k],
                                          f["vy"][k],
                                          f["vz"][k],
                                          f["stress"][k],
                                          f["radius"][k],
                                          f["volume"][k],
                                          f["mass"][k],
                                          f["charge"][k],
                                          f["landed"][k],
                                          f["embryo"][k]};
    EXPECT_EQ(rows[k], expected);
  }
}

TEST_F(Export, beads_of_a_run_without_stress_have_zeros) {
  write_run(folder_ / "inviscid.h5", 3, false);
  const RunReader run(folder_ / "inviscid.h5");
  const auto rows = csv(folder_, [&](TextOutput& to) { export_beads(run, {}, to); }).second;
  ASSERT_EQ(rows.size(), run.frame(2).rows());
  for (const auto& row : rows) EXPECT_EQ(row.at(7), 0);
}

TEST_F(Export, beads_are_those_of_the_last_frame_unless_a_time_is_given) {
  const RunReader run(folder_ / "run.h5");
  const auto rows = csv(folder_, [&](TextOutput& to) { export_beads(run, {}, to); }).second;
  EXPECT_EQ(rows.size(), run.frame(8).rows());
  EXPECT_EQ(rows[1][1], run.frame(8)["x"][1]);
}

TEST_F(Export, deposit_has_the_documented_columns_and_keeps_every_bit) {
  const RunReader run(folder_ / "run.h5");
  const auto [header, rows] =
      csv(folder_, [&](TextOutput& to) { export_table(run, "deposit", to); });
  EXPECT_EQ(header, "time_s,removal_time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,stress_pa,"
                    "landing_radius_m,radius_m,mass_kg,charge_c,volume_m3,arc_length_m");
  ASSERT_EQ(rows.size(), 9U);
  double arc_length = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const DepositedBead d = fabricated_deposit(k);
    const Vec3 &r = d.bead.position, &v = d.bead.velocity;
    arc_length += d.bead.volume / (std::numbers::pi * d.radius * d.radius);
    const std::vector<double> expected = {d.time,
                                          d.removal_time,
                                          r.x(),
                                          r.y(),
                                          r.z(),
                                          v.x(),
                                          v.y(),
                                          v.z(),
                                          test::stress_of(d.bead),
                                          d.landing_radius,
                                          d.radius,
                                          d.bead.mass,
                                          d.bead.charge,
                                          d.bead.volume,
                                          arc_length};
    EXPECT_EQ(rows[k], expected);
  }
}

TEST_F(Export, xyz_has_each_frame_with_its_count_its_time_and_its_species) {
  const RunReader run(folder_ / "run.h5");
  TextOutput output(folder_ / "run.xyz", false);
  export_xyz(run, {}, output);
  const std::vector<std::string> lines = lines_of(text_of(folder_ / "run.xyz"));
  std::size_t line = 0;
  for (std::size_t k = 0; k < 9; ++k) {
    const Frame f = run.frame(k);
    EXPECT_EQ(lines.at(line), std::to_string(f.rows()));
    EXPECT_TRUE(lines.at(line + 1).starts_with(
        "Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:stress:R:1:charge:R:1 Time="));
    const std::string time = lines[line + 1].substr(lines[line + 1].find("Time=") + 5);
    EXPECT_EQ(std::strtod(time.c_str(), nullptr), f.time);
    for (std::size_t b = 0; b < f.rows(); ++b) {
      const std::string& row = lines.at(line + 2 + b);
      const std::string kind = b == 0                ? "N"
                               : f["embryo"][b] != 0 ? "Es"
                               : f["landed"][b] != 0 ? "La"
                                                     : "B";
      EXPECT_EQ(row.substr(0, row.find(' ')), kind);
      const std::vector<double> expected = {f["x"][b],      f["y"][b],      f["z"][b],
                                            f["vx"][b],     f["vy"][b],     f["vz"][b],
                                            f["radius"][b], f["stress"][b], f["charge"][b]};
      EXPECT_EQ(numbers_in(row.substr(row.find(' ') + 1), ' '), expected);
    }
    line += 2 + f.rows();
  }
  EXPECT_EQ(line, lines.size());
}

TEST_F(Export, the_deposit_as_xyz_has_every_bead_that_landed) {
  const RunReader run(folder_ / "run.h5");
  const RunTable deposit = run.table("deposit");
  ASSERT_GT(deposit.rows(), 2U);
  TextOutput output(folder_ / "deposit.xyz", false);
  export_deposit_xyz(run, output);
  const std::vector<std::string> lines = lines_of(text_of(folder_ / "deposit.xyz"));
  ASSERT_EQ(lines.size(), deposit.rows() + 2);
  EXPECT_EQ(lines[0], std::to_string(deposit.rows()));
  EXPECT_NE(lines[1].find(":landing_radius:R:1"), std::string::npos);
  for (std::size_t k = 0; k < deposit.rows(); ++k) {
    ASSERT_TRUE(lines[k + 2].starts_with("La "));
    const std::vector<double> row = numbers_in(lines[k + 2].substr(3), ' ');
    std::size_t place = 0;
    for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "radius", "stress", "charge"})
      EXPECT_EQ(row.at(place++), deposit[name][k]) << name;
  }
}

TEST_F(Export, the_deposit_for_paraview_is_a_line_through_every_bead_that_landed) {
  const RunReader run(folder_ / "run.h5");
  TextOutput output(folder_ / "deposit.vtp", false);
  export_deposit_vtk(run, output);
  const std::string text = text_of(folder_ / "deposit.vtp");
  const std::string beads = std::to_string(run.table("deposit").rows());
  for (const std::string& part :
       {"NumberOfPoints=\"" + beads + "\"", std::string("NumberOfLines=\"1\""),
        "Name=\"connectivity\" NumberOfComponents=\"1\" NumberOfTuples=\"" + beads + "\"",
        std::string("Name=\"landing_radius\"")})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(Export, xdmf_refers_to_the_rows_of_each_frame) {
  const RunReader run(folder_ / "run.h5");
  std::filesystem::create_directory(folder_ / "below");
  TextOutput output(folder_ / "below/run.xdmf", false);
  export_xdmf(run, {}, folder_ / "below/run.xdmf", output);
  const std::string text = text_of(folder_ / "below/run.xdmf");
  std::size_t begin = 0, frames = 0;
  for (const double time : run.frame_times()) {
    const std::size_t beads = run.frame(frames++).rows();
    EXPECT_NE(text.find(fmt::format("<Time Value=\"{:.17g}\"/>", time)), std::string::npos);
    EXPECT_NE(text.find(fmt::format(">{} 1 {}</DataItem>", begin, beads)),
              std::string::npos);
    begin += beads;
  }
  EXPECT_NE(text.find(fmt::format("Dimensions=\"{}\" NumberType=\"Float\" Precision=\"8\" "
                                  "Format=\"HDF\">../run.h5:/beads/x<",
                                  begin)),
            std::string::npos);
  EXPECT_NE(text.find(":/beads/stress<"), std::string::npos);
}

TEST_F(Export, xyz_at_a_time_is_one_frame) {
  const RunReader run(folder_ / "run.h5");
  TextOutput output(folder_ / "run.xyz", false);
  export_xyz(run, 5e-5, output);
  EXPECT_EQ(lines_of(text_of(folder_ / "run.xyz")).size(), 2 + run.frame(5).rows());
}

// The numbers of a DataArray: base64 of their size in bytes and the bytes.
template <class T>
std::vector<T> data_array(const std::string& vtp, const std::string& name) {
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t begin = vtp.find('>', vtp.find("Name=\"" + name + "\"")) + 1;
  std::string bytes;
  std::uint32_t bits = 0, have = 0;
  for (std::size_t i = begin; vtp[i] != '<' && vtp[i] != '='; ++i) {
    bits = bits << 6U | static_cast<std::uint32_t>(digits.find(vtp[i]));
    have += 6;
    if (have < 8) continue;
    have -= 8;
    bytes += static_cast<char>(bits >> have & 255U);
  }
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), sizeof size);
  EXPECT_EQ(bytes.size(), sizeof size + size);
  std::vector<T> values(size / sizeof(T));
  std::memcpy(values.data(), bytes.data() + sizeof size, size);
  return values;
}

TEST_F(Export, vtk_has_one_poly_line_per_frame_that_keeps_every_bit) {
  const RunReader run(folder_ / "run.h5");
  export_vtk(run, {}, folder_ / "series.pvd", false);
  const std::string pvd = text_of(folder_ / "series.pvd");
  for (std::size_t k = 0; k < 9; ++k) {
    const std::string name = "series_vtk/frame_00000" + std::to_string(k) + ".vtp";
    EXPECT_NE(pvd.find("file=\"" + name + "\""), std::string::npos);
    const std::string vtp = text_of(folder_ / name);
    const Frame f = run.frame(k);
    EXPECT_NE(vtp.find("NumberOfPoints=\"" + std::to_string(f.rows()) + "\""),
              std::string::npos);
    EXPECT_EQ(data_array<double>(vtp, "TimeValue"), std::vector<double>{f.time});
    EXPECT_EQ(data_array<double>(vtp, "radius"), f["radius"]);
    EXPECT_EQ(data_array<double>(vtp, "stress"), f["stress"]);
    EXPECT_EQ(data_array<double>(vtp, "charge"), f["charge"]);
    const auto points = data_array<double>(vtp, "Points"),
               velocity = data_array<double>(vtp, "velocity");
    const auto connectivity = data_array<std::int64_t>(vtp, "connectivity");
    ASSERT_EQ(points.size(), 3 * f.rows());
    ASSERT_EQ(velocity.size(), 3 * f.rows());
    ASSERT_EQ(connectivity.size(), f.rows());
    for (std::size_t b = 0; b < f.rows(); ++b) {
      EXPECT_EQ(connectivity[b], static_cast<std::int64_t>(b));
      EXPECT_EQ(points[3 * b], f["x"][b]);
      EXPECT_EQ(points[3 * b + 2], f["z"][b]);
      EXPECT_EQ(velocity[3 * b + 1], f["vy"][b]);
    }
    EXPECT_EQ(data_array<std::int64_t>(vtp, "offsets"),
              std::vector<std::int64_t>{static_cast<std::int64_t>(f.rows())});
  }
}

TEST_F(Export, vtk_overwrites_only_on_demand_and_then_leaves_no_frame_of_the_old_series) {
  const RunReader run(folder_ / "run.h5");
  export_vtk(run, {}, folder_ / "run.pvd", false);
  EXPECT_THROW(export_vtk(run, {}, folder_ / "run.pvd", false), InputError);
  export_vtk(run, 2e-5, folder_ / "run.pvd", true);
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "run_vtk")) {
    files.push_back(entry.path().filename().string());
  }
  EXPECT_EQ(files, std::vector<std::string>{"frame_000002.vtp"});
}

TEST_F(Export, an_existing_file_is_overwritten_only_on_demand) {
  const RunReader run(folder_ / "run.h5");
  EXPECT_THROW(TextOutput(folder_ / "run.h5", false), InputError);
  EXPECT_THROW(TextOutput(folder_ / "absent/out.csv", false), InputError);
  TextOutput full("/dev/full", true);
  EXPECT_THROW(export_table(run, "deposit", full), RunError);
}

TEST_F(Export, a_part_that_is_absent_is_named_with_its_remedy_and_nothing_is_written) {
  {
    const auto bare =
        std::make_shared<RunFile>(folder_ / "bare.h5", false, Provenance{}, 1);
  }
  const RunReader run(folder_ / "bare.h5");
  try {
    TextOutput output(folder_ / "out.csv", false);
    export_table(run, "deposit", output);
    FAIL() << "exported";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              (folder_ / "bare.h5").string()
                  + " has no deposit: set output.deposit = true in the scene");
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.csv"));
  EXPECT_THROW(export_vtk(run, {}, folder_ / "out.pvd", false), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out_vtk"));
}

} // namespace
} // namespace ehdjet::testing
