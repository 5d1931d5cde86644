#include "ehdjet/core/error.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fmt/format.h>
#include <new>

#include "commands.hpp"
#include "version.hpp"

// Exit codes: 0 success, 1 the run failed, 2 the input is wrong, 3 a bug in ehdjet.
// NOLINTNEXTLINE(bugprone-exception-escape): the handlers themselves might throw
int main(int argc, char** argv) {
  ehdjet::cli::bound_waiting(argv);
  CLI::App app{"ehdjet: electrically charged jets as chains of beads", "ehdjet"};
  try {
    app.require_subcommand(1);
    app.set_version_flag("--version", ehdjet::cli::version_text);
    ehdjet::cli::add_run_command(app);
    ehdjet::cli::add_check_command(app);
    ehdjet::cli::add_forces_command(app);
    ehdjet::cli::add_export_command(app);
    ehdjet::cli::add_plot_command(app);
    ehdjet::cli::add_bench_command(app);
    ehdjet::cli::add_calibrate_command(app);
    app.parse(argc, argv); // runs the subcommand
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const ehdjet::Error& e) {
    fmt::print(stderr, "ehdjet: {}\n", e.what());
    return e.exit_code();
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "ehdjet: out of memory\n");
    return 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "ehdjet: {}. This is a bug in ehdjet; please report it\n", e.what());
    return 3;
  }
  return 0;
}
