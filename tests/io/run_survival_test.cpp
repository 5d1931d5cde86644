#include "ehdjet/core/error.hpp"
#include "ehdjet/io/run_file.hpp"
#include "ehdjet/io/run_reader.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
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

// A number that a child process and its parent both see.
class SharedCount {
public:
  SharedCount()
      : memory_(::mmap(nullptr, sizeof(Count), PROT_READ | PROT_WRITE,
                       MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    new (memory_) Count(0);
  }
  ~SharedCount() { ::munmap(memory_, sizeof(Count)); }
  SharedCount(const SharedCount&) = delete;
  SharedCount& operator=(const SharedCount&) = delete;
  using Count = std::atomic<std::uint64_t>;
  Count& operator*() const { return *static_cast<Count*>(memory_); }

private:
  void* memory_;
};

// Writes a frame, a row and a deposited bead at a time and flushes each, until it is killed.
[[noreturn]] void write_for_ever(const std::filesystem::path& path,
                                 SharedCount::Count& flushed) {
  RunFile file(path, true, fabricated_provenance(), 0);
  const auto observables = file.observables(1e-5), deposit = file.deposit();
  const auto shown = file.frames(1e-5, true);
  for (std::uint64_t k = 0;; ++k) {
    const FabricatedJet jet = fabricated_jet(k);
    observables->observe(jet.snapshot());
    deposit->deposit(fabricated_deposit(k));
    shown->observe(jet.snapshot());
    flushed = k + 1;
  }
}

void expect_intact(const RunReader& run, std::uint64_t flushed) {
  EXPECT_EQ(run.scene_resolved(), "resolved = 1\n");
  const std::size_t frames = run.has_frames() ? run.frame_times().size() : 0;
  ASSERT_GE(frames, flushed);
  for (std::size_t k = 0; k < frames; ++k) {
    const FabricatedJet made = fabricated_jet(k);
    const Frame read = run.frame(k);
    const auto velocity = made.snapshot().columns.velocity();
    ASSERT_EQ(read.time, made.time);
    ASSERT_EQ(read.vz, std::vector<double>(velocity.z.begin(), velocity.z.end()));
    ASSERT_EQ(read.charge, made.jet.charge);
  }
  ASSERT_GE(run.has_observables() ? run.observable("evaluations").size() : 0, flushed);
  const DepositTable deposit = run.has_deposit() ? run.deposit() : DepositTable{};
  ASSERT_GE(deposit.beads(), flushed);
  for (std::size_t k = 0; k < deposit.beads(); ++k) {
    ASSERT_EQ(deposit.volume[k], fabricated_deposit(k).bead.volume);
  }
}

TEST(RunSurvival, a_killed_run_keeps_every_frame_up_to_its_last_flush) {
  const ScratchFolder folder;
  std::mt19937 bits(20);
  std::uniform_int_distribution<std::uint64_t> frames(1, 40);
  std::uniform_int_distribution<unsigned> microseconds(0, 3000);
  for (int kill = 0; kill < 10; ++kill) {
    const SharedCount flushed;
    const pid_t child = ::fork();
    if (child == 0) write_for_ever(folder / "run.h5", *flushed);
    const std::uint64_t enough = frames(bits);
    while (*flushed < enough && ::waitpid(child, nullptr, WNOHANG) == 0) ::usleep(100);
    ::usleep(microseconds(bits));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    const RunReader run(folder / "run.h5");
    EXPECT_EQ(run.status(), "running");
    expect_intact(run, *flushed);
    if (HasFatalFailure()) return;
  }
}

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
    if (child == 0) {
      writes_to_live = writes;
      action();
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    survived = WIFEXITED(status);
    check();
    if (::testing::Test::HasFailure()) return;
    std::ofstream(path, std::ios::binary) << before;
  }
  action();
}

TEST(RunSurvival, dying_within_any_write_of_a_small_run_keeps_the_last_flush) {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  RunFile file(path, false, fabricated_provenance(), 1e9);
  std::unique_ptr<Observer> frames, deposit, observables;
  std::uint64_t written = 0, flushed = 0;
  const auto check = [&] {
    const RunReader run(path);
    EXPECT_TRUE(run.status() == "running" || run.status() == "complete") << run.status();
    EXPECT_EQ(run.message(), "");
    expect_intact(run, flushed);
  };
  die_within_every_write(path, check, [&] { frames = file.frames(1e-5, true); });
  die_within_every_write(path, check, [&] { deposit = file.deposit(); });
  die_within_every_write(path, check, [&] { observables = file.observables(1e-5); });
  for (const std::uint64_t more : {3U, 1U, 20U}) {
    for (; written < flushed + more; ++written) {
      const FabricatedJet jet = fabricated_jet(written);
      observables->observe(jet.snapshot());
      deposit->deposit(fabricated_deposit(written));
      frames->observe(jet.snapshot());
    }
    die_within_every_write(path, check, [&] { file.flush(); });
    flushed = written;
  }
  die_within_every_write(path, check, [&] { file.finish("complete", "", {}, {}); });
}

TEST(RunSurvival, dying_while_the_chunk_index_is_split_keeps_the_last_flush) {
  const ScratchFolder folder;
  const auto path = folder / "run.h5";
  RunFile file(path, false, fabricated_provenance(), 1e9);
  const auto frames = file.frames(1e-5, true);
  FabricatedJet jet;
  jet.jet.mass = jet.jet.charge = jet.jet.volume =
      std::vector<double>(4096, 1); // beads of one chunk
  std::size_t flushed = 0;
  const auto check = [&] {
    const RunReader run(path);
    ASSERT_GE(run.frame_times().size(), flushed);
    for (const std::size_t k : {std::size_t{0}, flushed / 2, flushed - 1}) {
      ASSERT_EQ(run.frame(k).y, std::vector<double>(4096, static_cast<double>(k)));
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
  for (const std::size_t chunks : {63U, 64U, 65U, 119U, 120U, 121U, 122U, 123U, 124U}) {
    write_until(chunks);
    SCOPED_TRACE("chunk " + std::to_string(chunks));
    if (flushed == 0) {
      file.flush();
    } else {
      die_within_every_write(path, check, [&] { file.flush(); });
    }
    flushed = chunks;
  }
}

// Limits how long this process may make a file: the next best thing to a full disk.
class ShortFiles {
public:
  explicit ShortFiles(rlim_t bytes)
      : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~ShortFiles() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  ShortFiles(const ShortFiles&) = delete;
  ShortFiles& operator=(const ShortFiles&) = delete;

private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(RunSurvival, a_full_disk_ends_the_run_and_leaves_the_last_flush) {
  const ScratchFolder folder;
  std::uint64_t flushed = 0;
  {
    const ShortFiles limit(600 * 1024);
    RunFile file(folder / "run.h5", false, fabricated_provenance(), 1e9);
    const auto observables = file.observables(1e-5), deposit = file.deposit();
    const auto shown = file.frames(1e-5, true);
    FabricatedJet jet;
    std::string message;
    for (std::uint64_t k = 0; message.empty() && k < 100000; ++k) {
      jet = fabricated_jet(k);
      try {
        observables->observe(jet.snapshot());
        deposit->deposit(fabricated_deposit(k));
        shown->observe(jet.snapshot());
        if (k % 10 != 9) continue;
        file.flush();
        flushed = k + 1;
      } catch (const RunError& error) {
        message = error.what();
      }
    }
    EXPECT_EQ(message, "cannot write " + (folder / "run.h5").string()
                           + ": File too large. It is readable up to the last flush");
    EXPECT_THROW(shown->observe(jet.snapshot()), RunError);
    EXPECT_THROW(file.flush(), RunError);
    file.finish("failed", message, jet.statistics, jet.ledger);
  }
  const RunReader run(folder / "run.h5");
  EXPECT_EQ(run.status(), "failed");
  EXPECT_NE(run.message().find("File too large"), std::string::npos);
  ASSERT_EQ(run.frame_times().size(), flushed);
  EXPECT_GT(flushed, 0U);
  for (std::size_t k = 0; k < flushed; ++k)
    EXPECT_EQ(run.frame(k).charge, fabricated_jet(k).jet.charge);
}

TEST(RunSurvival, a_disk_that_is_full_from_the_start_leaves_no_file) {
  const ScratchFolder folder;
  const ShortFiles limit(1000);
  EXPECT_THROW(RunFile(folder / "run.h5", false, fabricated_provenance(), 1), RunError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace ehdjet::testing
