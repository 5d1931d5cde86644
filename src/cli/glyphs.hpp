#pragma once

#include <string>
#include <vector>

/// Characters that can be drawn.
namespace ehdjet::cli {

/// Writes ? for every character that no font of this machine has, because programs that draw would put a box of
/// its number there, which may be as large as the page. Returns those characters as U+ and their
/// hexadecimal number, with commas between.
std::string replace_without_glyphs(std::vector<std::string>& texts);

} // namespace ehdjet::cli
