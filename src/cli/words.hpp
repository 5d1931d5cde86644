#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Words that a command line has and the program does not know.
namespace ehdjet::cli {

/// " (did you mean b?)" with the nearest of `known`, or nothing if none is near.
[[nodiscard]] std::string nearest_name(std::string_view wrong,
                                       const std::vector<std::string>& known);

/// What is wrong with the name of a command, or nothing.
[[nodiscard]] std::string unknown_command(const CLI::App& app, int argc, char** argv);
/// What is wrong with the words that are left over when everything else has been understood.
[[nodiscard]] std::string unknown_options(const CLI::App& app);

} // namespace ehdjet::cli
