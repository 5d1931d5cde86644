#include "threads.hpp"

#include <omp.h>

#include <CLI/CLI.hpp>

namespace ehdjet::cli {

void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads) {
  command.add_option("--threads", threads, "Number of threads; default: all processors")
      ->check(CLI::Range(1, 4096));
}

void use_threads(std::optional<std::size_t> threads) {
  if (threads) omp_set_num_threads(static_cast<int>(*threads));
}

} // namespace ehdjet::cli
