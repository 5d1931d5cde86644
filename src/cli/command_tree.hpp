#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// What is made from the commands and options themselves, so that it is never out of date.
namespace ehdjet::cli {

/// A script for bash that completes commands and options; other words are names of files.
std::string bash_completion(const CLI::App& app);

/// The manual page, section 1 (man(7) macros): every command with its options.
std::string manual_page(const CLI::App& app);

} // namespace ehdjet::cli
