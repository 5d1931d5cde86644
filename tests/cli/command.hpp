#pragma once

#include <filesystem>
#include <string>

#include "support/folder.hpp"

namespace ehdjet::test {

struct Outcome {
  int exit_code = -1; ///< 128 + signal if a signal ended it
  std::string out, err;
};

/// Runs `ehdjet ARGUMENTS` in that folder through the shell, `before` in front of it.
Outcome command(const Folder& folder, const std::string& arguments,
                const std::string& before = "");

std::string text_of(const std::filesystem::path& file);

} // namespace ehdjet::test
