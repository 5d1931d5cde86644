#pragma once

#include "ehdjet/core/new_file.hpp"

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

namespace ehdjet {

/// Text for the user, written to a file or to standard output.
///
/// The file appears when it is closed. If something fails before, there is no file, or the older one stays.
/// errors : InputError if the file exists and `overwrite` is false, cannot be created, or is the `input` that
///          the text is made from;
///          RunError if it cannot be written (disk full)
class TextOutput {
public:
  TextOutput() = default; ///< standard output
  TextOutput(const std::filesystem::path& path, bool overwrite,
             const std::filesystem::path& input = {});

  template <class... Arguments>
  void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format,
                   std::forward<Arguments>(arguments)...);
    if (text_.size() > buffer_size) drain();
  }
  /// Writes the rest of the text, which would be lost otherwise, and publishes the file.
  void close() {
    complete();
    publish();
  }
  /// The two parts of `close`, for files that are published together.
  void complete();
  void publish();

private:
  void drain();
  [[noreturn]] void fail(int error) const;

  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  static constexpr std::size_t buffer_size = std::size_t{1} << 18U;
  std::filesystem::path path_; ///< empty: standard output
  std::optional<NewFile> target_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  fmt::memory_buffer text_;
};

} // namespace ehdjet
