#include "ehdjet/run_files/run_reader.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <exception>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "io/fabricated_run.hpp"

namespace {
bool has_locks = true;
}

// Takes the place of the C library's, also for the HDF5 library.
extern "C" int flock(int file, int operation) noexcept {
  if (has_locks) return static_cast<int>(::syscall(SYS_flock, file, operation));
  errno = ENOLCK;
  return -1;
}

namespace ehdjet::testing {
namespace {

TEST(Locks, that_the_file_system_does_not_have_are_not_needed_to_read) {
  const Folder folder;
  write_run(folder / "run.h5", 3);
  has_locks = false;
  EXPECT_EQ(RunReader(folder / "run.h5").frame_times().size(), 3U);
  has_locks = true;
}

TEST(Locks, of_another_program_are_respected_and_named) {
  const Folder folder;
  write_run(folder / "run.h5", 3);
  const int other = ::open((folder / "run.h5").c_str(), O_RDWR | O_CLOEXEC); // NOLINT
  ASSERT_EQ(::flock(other, LOCK_EX | LOCK_NB), 0);
  try {
    const RunReader run(folder / "run.h5");
    FAIL() << "read";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("open for writing in another program"),
              std::string::npos);
  }
  ::close(other);
  EXPECT_EQ(RunReader(folder / "run.h5").frame_times().size(), 3U);
}

} // namespace
} // namespace ehdjet::testing
