#include "ehdjet/core/text_file.hpp"

#include "ehdjet/core/error.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ehdjet {

std::string read_text_file(const std::filesystem::path& file, const std::string& what) {
  constexpr std::size_t longest = std::size_t{1} << 24U;
  // Opening a pipe would otherwise wait for a program that writes to it.
  const int in = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); // NOLINT
  const auto refuse = [&](const std::string& why) {
    if (in >= 0) ::close(in);
    throw InputError("cannot read " + what + " " + file.string() + ": " + why);
  };
  struct stat status {};
  if (in < 0 || ::fstat(in, &status) != 0) refuse(std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse("it is a folder");

  std::string text;
  std::array<char, 65536> part{};
  for (bool first = true;; first = false) {
    const ssize_t n = ::read(in, part.data(), part.size());
    if (n < 0
        && errno == EAGAIN) // the program at the other end has not written yet: wait for it
      (void)::fcntl(in, F_SETFL, ::fcntl(in, F_GETFL) & ~O_NONBLOCK); // NOLINT
    else if (n < 0 && errno != EINTR)
      refuse(std::strerror(errno));
    else if (n == 0 && first && S_ISFIFO(status.st_mode))
      refuse("it is a pipe to which nobody writes");
    else if (n == 0)
      break;
    else if (n > 0)
      text.append(part.data(), static_cast<std::size_t>(n));
    if (text.size() > longest) refuse("it has more than 16 MiB");
  }
  ::close(in);
  return text;
}

} // namespace ehdjet
