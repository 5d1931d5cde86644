#pragma once

#include <string>
#include <vector>

/// What run files say of their scenes, each given as `resolved_toml`.
namespace ehdjet {

/// Empty if there is none.
std::string title_of(const std::string& resolved);

/// Whether the jet comes from a nozzle. A given chain need not have one.
bool has_nozzle(const std::string& resolved);

/// What distinguishes each scene from the others, title, output and end of the run aside: "key = value" with
/// commas between; empty if they are alike.
std::vector<std::string> distinctions(const std::vector<std::string>& resolved);

} // namespace ehdjet
