#pragma once

#include <map>
#include <string>

namespace ehdjet::cli {

/// Version, commit, compiler, instruction set, threads and library versions, by name. A run file
/// records them, and `--version` prints them.
std::map<std::string, std::string> environment();

std::string version_text();

} // namespace ehdjet::cli
