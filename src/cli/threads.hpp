#pragma once

#include <cstddef>
#include <optional>

namespace CLI {
class App;
}

namespace ehdjet::cli {

/// --threads N
void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads);

/// Sets the number of threads of everything that follows; without a number, all processors.
void use_threads(std::optional<std::size_t> threads);

} // namespace ehdjet::cli
