#pragma once

#include <filesystem>
#include <string>

namespace ehdjet {

/// Stops with an InputError if the output would be written onto that input, also through links.
void refuse_input(const std::filesystem::path& output, const std::filesystem::path& input);

/// A file that gets its name when it is whole. Until then it has a temporary name in the same folder, so that
/// a failure leaves an older file of that name as it was.
///
/// The name may be a link, which is followed also to a file that is not there yet. A name that appears while
/// the file is being written is not replaced unless `overwrite` is true: of several programs that write to
/// one name, one succeeds.
/// errors : InputError if the name exists and `overwrite` is false, is that of a folder, or cannot be created
class NewFile {
public:
  /// Checks the name and changes nothing.
  NewFile(const std::filesystem::path& name, bool overwrite);
  ~NewFile(); ///< removes a file that was not published
  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&&) = delete;
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// An existing device or pipe: it has no temporary file and is written to directly.
  [[nodiscard]] bool is_stream() const { return stream_; }
  /// The file behind the name, an absolute path.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

  /// Creates the file, empty, and returns its temporary path; the target itself of a stream.
  const std::filesystem::path& create();
  /// Gives it its name.
  void publish();

private:
  [[noreturn]] void refuse_existing() const;
  [[noreturn]] void fail(const std::string& why) const;

  std::filesystem::path name_, target_, temporary_;
  bool overwrite_, stream_ = false, created_ = false;
};

} // namespace ehdjet
