#include "ehdjet/core/error.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "standard_streams.hpp"
#include "version.hpp"
#include "words.hpp"

namespace ehdjet::cli {
namespace {

void add_commands(CLI::App& app) {
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text);
  add_run_command(app);
  add_check_command(app);
  add_scenes_command(app);
  add_info_command(app);
  add_forces_command(app);
  add_export_command(app);
  add_plot_command(app);
  add_import_command(app);
  add_sweep_command(app);
  add_gather_command(app);
  add_bench_command(app);
  add_calibrate_command(app);
  add_command_tree_commands(app);
}

int refuse(const std::string& text) {
  message("{}\nRun with --help for more information.\n", text);
  return 2;
}

/// Help and versions are results, all else is a message.
int show(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream results, messages;
  const int code = app.exit(error, results, messages);
  write_message(messages.str());
  write_result(results.str());
  return code == 0 ? 0 : 2;
}

int exit_code_of(CLI::App& app, int argc, char** argv) {
  try {
    add_commands(app);
    if (const std::string text = unknown_command(app, argc, argv); !text.empty())
      return refuse(text);
    app.parse(argc, argv); // runs the subcommand
  } catch (const CLI::ExtrasError& e) {
    const std::string text = unknown_options(app);
    return refuse(text.empty() ? e.what() : text);
  } catch (const CLI::ParseError& e) {
    return show(app, e);
  }
  return 0;
}

} // namespace
} // namespace ehdjet::cli

// Exit codes: 0 success, 1 the run failed, 2 the input is wrong, 3 a bug in ehdjet.
// NOLINTNEXTLINE(bugprone-exception-escape): the handlers themselves might throw
int main(int argc, char** argv) {
  using namespace ehdjet::cli;
  prepare_standard_streams();
  bound_waiting(argv);
  CLI::App app{"ehdjet: electrically charged jets as chains of beads", "ehdjet"};
  try {
    const int code = exit_code_of(app, argc, argv);
    finish_standard_output();
    return code;
  } catch (const ehdjet::Error& e) {
    message("ehdjet: {}\n", e.what());
    return e.exit_code();
  } catch (const std::bad_alloc&) {
    message("ehdjet: out of memory\n");
    return 1;
  } catch (const std::system_error& e) { // files and folders
    message("ehdjet: {}\n", e.what());
    return 1;
  } catch (const std::exception& e) {
    message("ehdjet: {}. This is a bug in ehdjet; please report it\n", e.what());
    return 3;
  }
}
