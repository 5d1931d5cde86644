#pragma once

#include <map>
#include <string>

namespace ehdjet::cli {

/// Version, commit, compiler, instruction set, threads and library versions, by name: what a run
/// file records and `--version` prints.
std::map<std::string, std::string> environment();

std::string version_text();

} // namespace ehdjet::cli
