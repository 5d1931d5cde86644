#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include "commands.hpp"
#include "options.hpp"

namespace ehdjet::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string run, output;
  std::optional<double> time;
  bool force = false;
};

/// Removes a temporary file at the end.
struct Scratch {
  fs::path path;
  explicit Scratch(fs::path p)
      : path(std::move(p)) {}
  ~Scratch() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

void run_gnuplot(const fs::path& script) {
  std::string program = "gnuplot", file = script.string();
  char* arguments[] = {program.data(), file.data(), nullptr};
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ);
  if (error == ENOENT) throw RunError("gnuplot not found: install gnuplot-nox");
  if (error != 0)
    throw RunError(std::string("cannot start gnuplot: ") + std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw RunError("gnuplot failed; its message is above");
}

void run_plot(const Options& options) {
  const RunReader run(options.run);
  const fs::path output = options.output.empty()
                              ? fs::path(options.run).replace_extension("png")
                              : fs::path(options.output);
  refuse_existing(output, options.force);
  // gnuplot draws to a temporary file: if it fails, an older plot stays as it was.
  const std::string id = std::to_string(::getpid());
  const Scratch drawn(
      output.parent_path()
      / ("." + output.stem().string() + "." + id + output.extension().string()));
  const Scratch script(fs::temp_directory_path() / ("ehdjet_plot." + id + ".gp"));
  TextOutput text(script.path, true);
  text.print("{}", plot_page(run, options.time, drawn.path));
  text.close();
  run_gnuplot(script.path);
  std::error_code error;
  fs::rename(drawn.path, output, error);
  if (error) throw InputError("cannot create " + output.string() + ": " + error.message());
}

} // namespace

void add_plot_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("plot", "Draw a run file on one page (needs gnuplot)");
  add_run_file_option(*command, options->run);
  command
      ->add_option("-o,--output", options->output,
                   "Page to draw; default: RUN.png beside the run file")
      ->type_name("FILE.{png,svg,pdf}");
  command
      ->add_option("--time", options->time,
                   "Draw the frame nearest to this time [s]; default: the last one")
      ->type_name("T");
  command->add_flag("--force", options->force, "Overwrite existing output");
  command->callback([options] { run_plot(*options); });
}

} // namespace ehdjet::cli
