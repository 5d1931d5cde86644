#include "standard_streams.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/printable.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <unistd.h>

namespace ehdjet::cli {
namespace {

constexpr std::string_view kept = "\n\t";

int output_error = 0; // errno of the first write to standard output that failed

void write_all(std::FILE* to, std::string_view text) noexcept {
  const bool written = std::fwrite(text.data(), 1, text.size(), to) == text.size();
  if (!written && to == stdout && output_error == 0) output_error = errno;
}

} // namespace

void prepare_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // In the wrong direction: what is written there is not lost in silence. The lowest free descriptor is taken.
    const int direction = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    (void)::open("/dev/null", direction); // NOLINT: POSIX declares it so
  }
  std::signal(SIGXFSZ, SIG_IGN);
}

void finish_standard_output() {
  if (std::fflush(stdout) != 0 && output_error == 0) output_error = errno;
  if (std::ferror(stdout) != 0 && output_error == 0) output_error = EIO;
  if (output_error != 0)
    throw RunError(std::string("cannot write standard output: ")
                   + std::strerror(output_error));
}

void write_result(std::string_view text) {
  write_all(stdout, printable(text, kept));
}

void write_message(std::string_view text) noexcept {
  try {
    write_all(stderr, printable(text, kept));
  } catch (const std::exception&) { // no memory for a message
  }
}

void write_to_terminal(std::string_view text) noexcept {
  write_all(stderr, text);
  std::fflush(stderr);
}

} // namespace ehdjet::cli
