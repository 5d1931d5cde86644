#pragma once

#include <filesystem>
#include <string>

namespace ehdjet::test {

struct Outcome {
  int exit_code = -1; ///< 128 + signal if a signal ended it
  std::string out, err;
};

/// A fresh folder that is removed with everything in it.
class Folder {
public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a text file and returns its path.
  std::string file(const std::string& name, const std::string& text) const;

private:
  std::filesystem::path path_;
};

/// Runs `ehdjet ARGUMENTS` in that folder through the shell, `before` in front of it.
Outcome command(const Folder& folder, const std::string& arguments,
                const std::string& before = "");

std::string text_of(const std::filesystem::path& file);

} // namespace ehdjet::test
