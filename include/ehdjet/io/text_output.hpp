#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <memory>
#include <utility>

namespace ehdjet {

/// errors : InputError if the file or folder exists and `overwrite` is false
void refuse_existing(const std::filesystem::path& path, bool overwrite);

/// Text for the user, written to a file or to standard output.
///
/// The file is created with the first text, so that an export that fails before leaves no file.
/// errors : InputError if the file exists and `overwrite` is false, or cannot be created;
///          RunError if it cannot be written (disk full)
class TextOutput {
public:
  TextOutput() = default; ///< standard output
  TextOutput(const std::filesystem::path& path, bool overwrite);

  template <class... Arguments>
  void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format,
                   std::forward<Arguments>(arguments)...);
    if (text_.size() > buffer_size) drain();
  }
  /// Writes the rest of the text, which would be lost otherwise, and closes the file.
  void close();

private:
  void drain();
  [[noreturn]] void fail(int error) const;

  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  static constexpr std::size_t buffer_size = std::size_t{1} << 18U;
  std::filesystem::path path_; ///< empty: standard output
  std::unique_ptr<std::FILE, CloseFile> file_;
  fmt::memory_buffer text_;
};

} // namespace ehdjet
