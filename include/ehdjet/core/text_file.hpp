#pragma once

#include <filesystem>
#include <string>

namespace ehdjet {

/// Reads a file of text that people write: a regular file, or a pipe to which a program writes.
///
/// errors : InputError "cannot read `what` FILE: ..." if it is a folder, cannot be read, is a pipe to which
///          nobody writes, or has more than 16 MiB (a device may have no end)
std::string read_text_file(const std::filesystem::path& file, const std::string& what);

} // namespace ehdjet
