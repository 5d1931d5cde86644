#include "ehdjet/core/error.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "io/fabricated_run.hpp"

namespace ehdjet::testing {
namespace {

namespace fs = std::filesystem;

std::vector<double> as_vector(std::span<const double> values) {
  return {values.begin(), values.end()};
}

void expect_same(const Frame& read, const FabricatedJet& made) {
  const JetColumns<const double> columns = made.snapshot().columns;
  EXPECT_EQ(read.time, made.time);
  EXPECT_EQ(read["x"], as_vector(columns.position().x));
  EXPECT_EQ(read["y"], as_vector(columns.position().y));
  EXPECT_EQ(read["z"], as_vector(columns.position().z));
  EXPECT_EQ(read["vx"], as_vector(columns.velocity().x));
  EXPECT_EQ(read["vy"], as_vector(columns.velocity().y));
  EXPECT_EQ(read["vz"], as_vector(columns.velocity().z));
  if (test::has_stress(columns)) {
    EXPECT_EQ(read["stress"], as_vector(test::stress_of(columns)));
  }
  EXPECT_EQ(read["volume"], made.jet.volume);
  EXPECT_EQ(read["mass"], made.jet.mass);
  EXPECT_EQ(read["charge"], made.jet.charge);
  for (std::size_t k = 0; k < read.rows(); ++k) {
    EXPECT_EQ(read["landed"][k] != 0, !made.jet.landed.empty() && k + 2 >= read.rows());
    EXPECT_EQ(read["embryo"][k] != 0, made.jet.has_embryo && k == 1);
  }
}

// The names in a group, read by the HDF5 library alone.
std::vector<std::string> names_in(const fs::path& path, const char* group) {
  std::vector<std::string> names;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t id = H5Gopen2(file, group, H5P_DEFAULT);
  H5Literate(
      id, H5_INDEX_NAME, H5_ITER_INC, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
        static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        return 0;
      },
      &names);
  H5Gclose(id), H5Fclose(file);
  return names;
}

using Names = std::vector<std::string>;

// No object of the file has a time of its own, so that the same run gives the same bytes.
TEST(RunFile, has_no_times_in_it) {
  const Folder folder;
  {
    const auto file =
        std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
    record_frames(file, 1e-5, *test::table_with_stress())
        ->observe(fabricated_jet(0).snapshot());
    file->keep(fabricated_checkpoint(0));
    file->finish("complete", "", {}, {});
  }
  const hid_t file = H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  Names with_times, all;
  std::pair<Names*, Names*> found{&with_times, &all};
  H5Ovisit2(
      file, H5_INDEX_NAME, H5_ITER_INC,
      [](hid_t, const char* name, const H5O_info_t* info, void* to) -> herr_t {
        const auto& [timed, every] = *static_cast<std::pair<Names*, Names*>*>(to);
        every->emplace_back(name);
        if (info->mtime != 0 || info->ctime != 0 || info->btime != 0)
          timed->emplace_back(name);
        return 0;
      },
      &found, H5O_INFO_TIME);
  H5Fclose(file);
  EXPECT_GT(all.size(), 10U);
  EXPECT_EQ(with_times, Names{});
}

TEST(RunFile, what_was_written_is_read_back_bit_for_bit) {
  const Folder folder;
  constexpr std::size_t frames = 300; // 9,600 beads: more than two chunks
  write_run(folder / "run.h5", frames);
  const RunReader run(folder / "run.h5");
  ASSERT_EQ(run.frame_times().size(), frames);
  for (std::size_t k = 0; k < frames; ++k) expect_same(run.frame(k), fabricated_jet(k));
  const RunTable deposit = run.table("deposit");
  ASSERT_EQ(deposit.rows(), frames);
  for (std::size_t k = 0; k < frames; ++k) {
    const DepositedBead made = fabricated_deposit(k);
    EXPECT_EQ(deposit["time"][k], made.time);
    EXPECT_EQ(deposit["removal_time"][k], made.removal_time);
    EXPECT_EQ(Vec3(deposit["x"][k], deposit["y"][k], deposit["z"][k]), made.bead.position);
    EXPECT_EQ(Vec3(deposit["vx"][k], deposit["vy"][k], deposit["vz"][k]),
              made.bead.velocity);
    EXPECT_EQ(deposit["stress"][k], test::stress_of(made.bead));
    EXPECT_EQ(deposit["landing_radius"][k], made.landing_radius);
    EXPECT_EQ(deposit["radius"][k], made.radius);
    EXPECT_EQ(deposit["mass"][k], made.bead.mass);
    EXPECT_EQ(deposit["charge"][k], made.bead.charge);
    EXPECT_EQ(deposit["volume"][k], made.bead.volume);
  }
  EXPECT_EQ(run.column("observables", "evaluations")[13], 700. * 13);
}

TEST(RunFile, says_where_it_came_from_and_how_it_ended) {
  const Folder folder;
  write_run(folder / "run.h5", 3);
  const RunReader run(folder / "run.h5");
  EXPECT_EQ(run.attribute("status"), "complete");
  EXPECT_EQ(run.attribute("message"), "all is well");
  EXPECT_EQ(run.scene("given"), "given = \"ä\"\n");
  EXPECT_EQ(run.scene("resolved"), "resolved = 1\n");
  EXPECT_EQ(run.attribute("scene_file"), "scenes/made up.toml");
  EXPECT_EQ(run.attribute("threads"), "2");
}

TEST(RunFile, has_only_the_parts_that_were_asked_for) {
  const Folder folder;
  {
    const auto bare = std::make_shared<RunFile>(folder / "bare.h5", false, Provenance{}, 1);
  }
  EXPECT_EQ(names_in(folder / "bare.h5", "/"), Names{"scene"});
  {
    const auto some = std::make_shared<RunFile>(folder / "some.h5", false, Provenance{}, 1);
    record_observables(some, 1);
    some->finish("complete", "", {}, {});
  }
  EXPECT_EQ(names_in(folder / "some.h5", "/"),
            (Names{"ledger", "observables", "scene", "statistics"}));
  {
    const auto inviscid =
        std::make_shared<RunFile>(folder / "inviscid.h5", false, Provenance{}, 1);
    record_frames(inviscid, 1, *BeadTable::basic())
        ->observe(fabricated_jet(5, false).snapshot());
  }
  EXPECT_EQ(names_in(folder / "inviscid.h5", "/"), (Names{"beads", "frames", "scene"}));
  EXPECT_EQ(names_in(folder / "inviscid.h5", "/beads"),
            (Names{"charge", "embryo", "landed", "mass", "radius", "volume", "vx", "vy",
                   "vz", "x", "y", "z"}));
  const RunReader read(folder / "inviscid.h5");
  EXPECT_EQ(read.frame(0).find("stress"), nullptr);
  EXPECT_THROW(static_cast<void>(read.frame(0)["stress"]), InputError);
  EXPECT_THROW(static_cast<void>(read.column("observables", "time")), InputError);
  EXPECT_THROW(static_cast<void>(read.table("deposit")), InputError);
}

TEST(RunFile, nobody_writes_to_one_that_is_finished) {
  const Folder folder;
  const auto file = std::make_shared<RunFile>(folder / "run.h5", false, Provenance{}, 1);
  const auto shown = record_frames(file, 1, *test::table_with_stress());
  file->finish("complete", "", {}, {});
  EXPECT_THROW(shown->observe(fabricated_jet(1).snapshot()), ContractViolation);
  EXPECT_THROW(file->finish("complete", "", {}, {}), ContractViolation);
}

TEST(RunFile, records_the_method_if_it_was_chosen) {
  const Folder folder;
  const auto records = [&](const std::optional<MethodRecord>& method) {
    RunStatistics statistics;
    statistics.method = method;
    {
      const auto run = std::make_shared<RunFile>(folder / "run.h5", true, Provenance{}, 1);
      run->finish("complete", "", statistics, {});
    }
    const hid_t file = H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    bool all = true, any = false;
    for (const char* name : {"method", "method_since", "method_changes"}) {
      const bool there = H5Aexists_by_name(file, "statistics", name, H5P_DEFAULT) > 0;
      all = all && there, any = any || there;
    }
    H5Fclose(file);
    EXPECT_EQ(all, any);
    return any;
  };
  EXPECT_FALSE(records(std::nullopt));
  EXPECT_TRUE(records(MethodRecord{.in_use = "ros34pw2", .since = 0.1, .changes = 2}));
}

TEST(RunFile, every_data_set_has_a_unit_and_a_description) {
  const Folder folder;
  write_run(folder / "run.h5", 2);
  const hid_t file = H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  std::size_t data_sets = 0;
  for (const char* group : {"/observables", "/frames", "/beads", "/deposit"}) {
    for (const std::string& name : names_in(folder / "run.h5", group)) {
      const hid_t data_set = H5Dopen2(file, (group + ("/" + name)).c_str(), H5P_DEFAULT);
      EXPECT_GT(H5Aexists(data_set, "unit"), 0) << group << "/" << name;
      EXPECT_GT(H5Aexists(data_set, "description"), 0) << group << "/" << name;
      H5Dclose(data_set);
      ++data_sets;
    }
  }
  H5Fclose(file);
  EXPECT_EQ(data_sets, 14U + 2 + 13 + 14);
}

TEST(RunFile, the_radius_in_a_frame_keeps_the_volume_of_each_link) {
  const Folder folder;
  write_run(folder / "run.h5", 20);
  const RunReader run(folder / "run.h5");
  for (std::size_t k = 0; k < 20; ++k) {
    const Frame f = run.frame(k);
    const std::size_t first = f.rows() > 1 && f["embryo"][1] != 0 ? 2 : 1;
    EXPECT_EQ(f["radius"][0], f["radius"][first]);
    for (std::size_t b = 1; b < f.rows(); ++b) {
      const std::size_t up = b == first ? 0 : b - 1; // an embryo is not a neighbour
      const double l = std::hypot(f["x"][b] - f["x"][up], f["y"][b] - f["y"][up],
                                  f["z"][b] - f["z"][up]);
      const double volume = std::numbers::pi * f["radius"][b] * f["radius"][b] * l;
      EXPECT_NEAR(volume, f["volume"][b],
                  8 * std::numeric_limits<double>::epsilon() * f["volume"][b]);
    }
  }
}

// A triangle 3-4-5 in the plane through the axis, so that each length is known.
FabricatedJet triangle(double time, double inserted, double removed) {
  FabricatedJet made;
  made.time = time;
  made.jet.mass = made.jet.charge = made.jet.volume = {1, 1, 1};
  made.jet.y.assign(18, 0);
  made.values = {0, 3, 3, 0, 0, 0, 0, 4, 0,
                 0, 0, 0, 0, 0, 0, 0, 0, 0}; // x: 0 3 3, z: 0 4 0
  made.values[8] = 3;                        // z of the tip
  made.ledger.inserted_charge = inserted, made.ledger.removed_charge = removed;
  made.ledger.release_speed = 7, made.ledger.impact_speed = 8,
  made.ledger.collector_radius = 9;
  made.statistics.evaluations = 10, made.statistics.steps = 11,
  made.statistics.rejected = 12;
  return made;
}

TEST(RunFile, observables_are_what_their_definitions_say) {
  const Folder folder;
  {
    const auto file = std::make_shared<RunFile>(folder / "run.h5", false, Provenance{}, 1);
    const auto observables = record_observables(file, 0.5);
    EXPECT_EQ(observables->next_time(), 0);
    observables->observe(triangle(0, 5, 0).snapshot());
    EXPECT_EQ(observables->next_time(), 0.5);
    observables->observe(triangle(0.5, 7, 1).snapshot());
    EXPECT_EQ(observables->next_time(), 1);
  }
  const RunReader run(folder / "run.h5");
  Names columns;
  for (const auto& column : run.table("observables").columns)
    columns.push_back(column.name);
  EXPECT_EQ(columns,
            (Names{"aperture", "beads", "collector_radius", "current_in", "current_out",
                   "evaluations", "impact_speed", "nozzle_speed", "path_length", "rejected",
                   "steps", "time", "tip_x", "tip_yz"}));
  const auto last = [&](const char* column) {
    return run.column("observables", column)[1];
  };
  EXPECT_EQ(last("time"), 0.5);
  EXPECT_EQ(last("beads"), 3);
  EXPECT_EQ(last("tip_x"), 3);
  EXPECT_EQ(last("tip_yz"), 3);
  EXPECT_EQ(last("path_length"), 5 + 1);
  EXPECT_NEAR(last("aperture"), 90, 1e-13 * 90);
  EXPECT_EQ(last("current_in"), (7 - 5) / 0.5);
  EXPECT_EQ(last("current_out"), (1 - 0) / 0.5);
  EXPECT_EQ(run.column("observables", "current_in")[0], 0);
  EXPECT_EQ(run.column("observables", "current_out")[0], 0);
  EXPECT_EQ(last("nozzle_speed"), 7);
  EXPECT_EQ(last("impact_speed"), 8);
  EXPECT_EQ(last("collector_radius"), 9);
  EXPECT_EQ(last("evaluations"), 10);
  EXPECT_EQ(last("steps"), 11);
  EXPECT_EQ(last("rejected"), 12);
}

TEST(RunFile, an_existing_file_is_overwritten_only_on_demand) {
  const Folder folder;
  write_run(folder / "run.h5", 5);
  const std::string before = text_of(folder / "run.h5");
  try {
    const auto file = std::make_shared<RunFile>(folder / "run.h5", false, Provenance{}, 1);
    FAIL() << "overwritten";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              (folder / "run.h5").string()
                  + " exists: choose another name with -o or overwrite it with --force");
  }
  EXPECT_EQ(text_of(folder / "run.h5"), before);
  { const auto file = std::make_shared<RunFile>(folder / "run.h5", true, Provenance{}, 1); }
  EXPECT_FALSE(RunReader(folder / "run.h5").has("frames"));
}

TEST(RunFile, one_that_cannot_be_created_destroys_nothing_and_leaves_nothing) {
  const Folder folder;
  EXPECT_THROW(RunFile(folder / "absent/run.h5", false, {}, 1), InputError);
  EXPECT_THROW(RunFile(folder.path(), true, {}, 1), InputError);
  EXPECT_THROW(RunFile("/dev/null", true, {}, 1), InputError);
  EXPECT_THROW(RunFile("/proc/run.h5", true, {}, 1),
               InputError); // not writable, even for root
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(RunFile, is_readable_at_every_flush_while_it_grows) {
  const Folder folder;
  const auto file =
      std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
  const auto shown = record_frames(file, 1e-5, *test::table_with_stress());
  for (std::size_t k = 0; k < 30; ++k) {
    shown->observe(fabricated_jet(k).snapshot());
    EXPECT_EQ(RunReader(folder / "run.h5").frame_times().size(), k);
    file->flush();
    const RunReader run(folder / "run.h5");
    ASSERT_EQ(run.frame_times().size(), k + 1);
    EXPECT_EQ(run.attribute("status"), "running");
    expect_same(run.frame(k), fabricated_jet(k));
  }
}

// Chunks that are complete at once are packed by all threads, not by the HDF5 library, which reads
// them all the same.
TEST(RunFile, columns_of_many_beads_are_read_back_whatever_the_number_of_threads) {
  constexpr std::size_t chunk = 256;
  for (const std::size_t threads : {1U, 3U}) {
    const ThreadCount count(threads);
    const Folder folder;
    RunFile file(folder / "run.h5", false, Provenance{}, 1e9);
    Column& real = file.add_column("budget", {"real", "m", "", ColumnType::real}, chunk);
    Column& flag = file.add_column("budget", {"flag", "1", "", ColumnType::flag}, chunk);
    std::vector<double> reals, flags;
    // Whole chunks, on top of a chunk that has been begun, a single one, more than are packed at once.
    for (const std::size_t rows : {3 * chunk, chunk / 2, 5 * chunk + 7, std::size_t{1},
                                   chunk, 100 * chunk, 2 * chunk - 8}) {
      const std::size_t first = reals.size();
      for (std::size_t i = first; i < first + rows; ++i) {
        reals.push_back(std::sin(0.01 * static_cast<double>(i)));
        flags.push_back(i % 3 == 0 ? 1 : 0);
      }
      file.write([&] {
        real.append(std::span(reals).subspan(first));
        flag.append(std::span(flags).subspan(first));
      });
      file.flush();
      EXPECT_EQ(RunReader(folder / "run.h5").column("budget", "real"), reals) << rows;
      EXPECT_EQ(RunReader(folder / "run.h5").column("budget", "flag"), flags) << rows;
    }
  }
}

TEST(RunFile, many_flushes_do_not_make_a_large_file) {
  const Folder folder;
  const auto size_with = [&](const std::string& name, double flush_interval) {
    {
      const auto file =
          std::make_shared<RunFile>(folder / name, false, Provenance{}, flush_interval);
      const auto shown = record_frames(file, 1e-5, *test::table_with_stress());
      for (std::size_t k = 0; k < 100; ++k) shown->observe(fabricated_jet(k).snapshot());
    }
    return fs::file_size(folder / name);
  };
  // An incomplete chunk leaves two or three shorter copies of itself behind, whatever the number
  // of flushes; without reuse of their space it would be a hundred.
  EXPECT_LT(size_with("often.h5", 0), 3 * size_with("once.h5", 1e9));
}

} // namespace
} // namespace ehdjet::testing
