#include "ehdjet/core/error.hpp"
#include "ehdjet/io/records.hpp"
#include "ehdjet/run_files/run_file.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <random>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/fabricated_run.hpp"

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
  const auto file = std::make_shared<RunFile>(path, true, fabricated_provenance(), 0);
  const auto observables = record_observables(file, 1e-5),
             deposit = record_deposit(file, test::table_with_stress());
  const auto shown = record_frames(file, 1e-5, *test::table_with_stress());
  for (std::uint64_t k = 0;; ++k) {
    const FabricatedJet jet = fabricated_jet(k);
    observables->observe(jet.snapshot());
    deposit->deposit(fabricated_deposit(k));
    shown->observe(jet.snapshot());
    flushed = k + 1;
  }
}

TEST(RunSurvival, a_killed_run_keeps_every_frame_up_to_its_last_flush) {
  const Folder folder;
  std::mt19937 bits(20);
  std::uniform_int_distribution<std::uint64_t> frames(1, 40);
  std::uniform_int_distribution<unsigned> microseconds(0, 3000);
  for (int kill = 0; kill < 10; ++kill) {
    const SharedCount flushed;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) write_for_ever(folder / "run.h5", *flushed);
    // It is not reaped before it is killed: until then its number is nobody else's.
    const std::uint64_t enough = frames(bits);
    for (int wait = 0; *flushed < enough && wait < 100000; ++wait) ::usleep(100);
    ::usleep(microseconds(bits));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    const RunReader run(folder / "run.h5");
    EXPECT_EQ(run.attribute("status"), "running");
    expect_intact(run, *flushed);
    if (HasFatalFailure()) return;
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
  const Folder folder;
  std::uint64_t flushed = 0;
  {
    const ShortFiles limit(600 * 1024);
    const auto file =
        std::make_shared<RunFile>(folder / "run.h5", false, fabricated_provenance(), 1e9);
    const auto observables = record_observables(file, 1e-5),
               deposit = record_deposit(file, test::table_with_stress());
    const auto shown = record_frames(file, 1e-5, *test::table_with_stress());
    FabricatedJet jet;
    std::string message;
    for (std::uint64_t k = 0; message.empty() && k < 100000; ++k) {
      jet = fabricated_jet(k);
      try {
        observables->observe(jet.snapshot());
        deposit->deposit(fabricated_deposit(k));
        shown->observe(jet.snapshot());
        if (k % 10 != 9) continue;
        file->flush();
        flushed = k + 1;
      } catch (const RunError& error) {
        message = error.what();
      }
    }
    EXPECT_EQ(message, "cannot write " + (folder / "run.h5").string()
                           + ": File too large. It is readable up to the last flush");
    EXPECT_THROW(shown->observe(jet.snapshot()), RunError);
    EXPECT_THROW(file->flush(), RunError);
    file->finish("failed", message, jet.statistics, jet.ledger);
  }
  const RunReader run(folder / "run.h5");
  EXPECT_EQ(run.attribute("status"), "failed");
  EXPECT_NE(run.attribute("message").find("File too large"), std::string::npos);
  ASSERT_EQ(run.frame_times().size(), flushed);
  EXPECT_GT(flushed, 0U);
  for (std::size_t k = 0; k < flushed; ++k)
    EXPECT_EQ(run.frame(k)["charge"], fabricated_jet(k).jet.charge);
}

TEST(RunSurvival, a_disk_that_is_full_from_the_start_leaves_no_file) {
  const Folder folder;
  const ShortFiles limit(1000);
  EXPECT_THROW(RunFile(folder / "run.h5", false, fabricated_provenance(), 1), RunError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace ehdjet::testing
