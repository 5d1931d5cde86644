#pragma once

#include "ehdjet/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

/// What the targets have in common. Input may be refused, with an InputError; anything else ends the target, and
/// libFuzzer keeps the input.
namespace ehdjet::fuzz {

/// A file in memory with the input as its content.
class InputFile {
public:
  InputFile()
      : descriptor_(::memfd_create("input", MFD_CLOEXEC))
      , path_("/proc/self/fd/" + std::to_string(descriptor_)) {
    if (descriptor_ < 0) __builtin_trap();
  }
  ~InputFile() { ::close(descriptor_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& with(const std::uint8_t* data, std::size_t size) const {
    if (::ftruncate(descriptor_, 0) != 0
        || ::pwrite(descriptor_, data, size, 0) != static_cast<ssize_t>(size))
      __builtin_trap();
    return path_;
  }

private:
  int descriptor_;
  std::filesystem::path path_;
};

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {data, data + size};
}

/// Calls `use`, which may refuse the input. A run that fails is no fault of the input's reader.
template <class Use>
int refusing(const Use& use) {
  try {
    use();
  } catch (const Error& e) {
    if (e.exit_code() == 3) throw;
  }
  return 0;
}

} // namespace ehdjet::fuzz
