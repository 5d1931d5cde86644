#include "ehdjet/core/error.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "io/fabricated_run.hpp"

namespace {

// Counts down the writes this process may still begin; it dies in the middle of the last one,
// between two pages of the file if the write spans more than one.
std::uint64_t writes_to_live = 0; // 0: for ever

} // namespace

// Stands in for the C library's function in this program.
extern "C" ssize_t pwrite(int file, const void* from, size_t size, off_t at) {
  constexpr size_t page = 4096;
  const bool dies = writes_to_live > 0 && --writes_to_live == 0;
  if (dies) {
    const auto offset = static_cast<size_t>(at);
    const size_t boundary = (offset + size / 2) / page * page;
    size = boundary > offset ? boundary - offset : 0;
  }
  const ssize_t written = ::syscall(SYS_pwrite64, file, from, size, at);
  if (dies) ::raise(SIGKILL);
  return written;
}

namespace ehdjet::testing {
namespace {

// Does `action` in a process that dies within its first write, its second and so on; `check`
// sees what each leaves behind. Then does it here.
template <class Check, class Action>
void die_within_every_write(const std::filesystem::path& path, Check&& check,
                            Action&& action) {
  const std::string before = text_of(path);
  bool survived = false;
  for (std::uint64_t writes = 1; !survived; ++writes) {
    SCOPED_TRACE("write " + std::to_string(writes));
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      writes_to_live = writes;
      action();
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    survived = WIFEXITED(status);
    check();
    if (::testing::Test::HasFailure()) break;
    std::ofstream(path, std::ios::binary) << before;
  }
  action();
}

TEST(RunSurvival, dying_within_any_write_of_a_small_run_keeps_the_last_flush) {
  const Folder folder;
  const auto path = folder / "run.h5";
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  std::unique_ptr<Observer> frames, deposit, observables;
  std::uint64_t written = 0, flushed = 0;
  const auto check = [&] {
    const RunReader run(path);
    EXPECT_TRUE(run.attribute("status") == "running"
                || run.attribute("status") == "complete")
        << run.attribute("status");
    EXPECT_EQ(run.attribute("message"), "");
    expect_intact(run, flushed);
  };
  die_within_every_write(
      path, check, [&] { frames = record_frames(file, 1e-5, *test::table_with_stress()); });
  die_within_every_write(
      path, check, [&] { deposit = record_deposit(file, test::table_with_stress()); });
  die_within_every_write(path, check,
                         [&] { observables = record_observables(file, 1e-5); });
  for (const std::uint64_t more : {4U, 20U}) {
    for (; written < flushed + more; ++written) {
      const FabricatedJet jet = fabricated_jet(written);
      observables->observe(jet.snapshot());
      deposit->deposit(fabricated_deposit(written));
      frames->observe(jet.snapshot());
    }
    die_within_every_write(path, check, [&] { file->flush(); });
    flushed = written;
  }
  die_within_every_write(path, check, [&] { file->finish("complete", "", {}, {}); });
}

TEST(RunSurvival, dying_while_the_chunk_index_is_split_keeps_the_last_flush) {
  const Folder folder;
  const auto path = folder / "run.h5";
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  const auto frames = record_frames(file, 1e-5, *test::table_with_stress());
  FabricatedJet jet;
  jet.jet.mass = jet.jet.charge = jet.jet.volume =
      std::vector<double>(4096, 1); // beads of one chunk
  std::size_t flushed = 0;
  const auto check = [&] {
    const RunReader run(path);
    ASSERT_GE(run.frame_times().size(), flushed);
    for (const std::size_t k : {std::size_t{0}, flushed / 2, flushed - 1}) {
      ASSERT_EQ(run.frame(k)["y"], std::vector<double>(4096, static_cast<double>(k)));
    }
  };
  std::size_t written = 0;
  const auto write_until = [&](std::size_t end) {
    for (; written < end; ++written) {
      jet.values.assign(7 * jet.jet.beads(), static_cast<double>(written));
      frames->observe(jet.snapshot());
    }
  };
  // A node of the index has room for 64 chunks. The root is split by moving what it had into two
  // new nodes; then the last of those fills up, and part of it moves to a new sibling.
  for (const std::size_t chunks : {63U, 64U, 65U, 121U, 122U}) {
    write_until(chunks);
    SCOPED_TRACE("chunk " + std::to_string(chunks));
    if (flushed == 0) {
      file->flush();
    } else {
      die_within_every_write(path, check, [&] { file->flush(); });
    }
    flushed = chunks;
  }
}

/// The last checkpoint, without the numbers of rows that the file had then.
Checkpoint checkpoint_in(const std::filesystem::path& path) {
  Checkpoint c = RunReader(path).checkpoint();
  std::erase_if(c, [](const auto& part) { return part.first.starts_with("rows."); });
  return c;
}

TEST(RunSurvival, dying_while_a_checkpoint_is_written_keeps_the_last_one_or_has_the_next) {
  const Folder folder;
  const auto path = folder / "run.h5";
  const auto file = std::make_shared<RunFile>(path, false, fabricated_provenance(), 1e9);
  const auto frames = record_frames(file, 1e-5, *test::table_with_stress());
  for (std::uint64_t k = 0; k < 5; ++k) {
    SCOPED_TRACE("checkpoint " + std::to_string(k));
    frames->observe(fabricated_jet(k).snapshot());
    const auto check = [&] {
      try {
        const Checkpoint c = checkpoint_in(path);
        EXPECT_TRUE(c == fabricated_checkpoint(k)
                    || (k > 0 && c == fabricated_checkpoint(k - 1)));
      } catch (const InputError& e) {
        EXPECT_EQ(k, 0U) << e.what();
      }
    };
    die_within_every_write(path, check, [&] { file->keep(fabricated_checkpoint(k)); });
    EXPECT_EQ(checkpoint_in(path), fabricated_checkpoint(k));
  }
}

} // namespace
} // namespace ehdjet::testing
