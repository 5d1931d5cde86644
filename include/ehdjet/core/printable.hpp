#pragma once

#include <string>
#include <string_view>

namespace ehdjet {

/// The text with every control character written as \xNN, and every byte that is not UTF-8. Names and titles
/// come from users and from files of others: shown on a terminal or passed to another program, a control
/// character would be a command. `keep` lists control characters that stay.
std::string printable(std::string_view text, std::string_view keep = {});

} // namespace ehdjet
