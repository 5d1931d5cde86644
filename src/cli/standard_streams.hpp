#pragma once

#include <fmt/format.h>
#include <string_view>
#include <utility>

/// Standard output has results, and standard error has messages. Control characters in them, which only names
/// and titles can have, are shown as \xNN.
namespace ehdjet::cli {

/// Opens those of the descriptors 0, 1 and 2 that are closed, so that no file of the program becomes one of
/// them; reading and writing there still fail. Makes a write beyond a limit of the file size fail instead of
/// ending the process. Call before anything is opened.
void prepare_standard_streams();

/// Throws a RunError if something could not be written to standard output.
void finish_standard_output();

void write_result(std::string_view text);
/// Never fails: a full disk that takes no messages is no reason to stop a run.
void write_message(std::string_view text) noexcept;
/// The same for text with controls of the terminal.
void write_to_terminal(std::string_view text) noexcept;

/// Prints to standard output.
template <class... Arguments>
void print_result(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_result(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Prints to standard error.
template <class... Arguments>
void message(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_message(fmt::format(format, std::forward<Arguments>(arguments)...));
}

} // namespace ehdjet::cli
