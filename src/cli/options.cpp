#include "options.hpp"

#include "ehdjet/core/printable.hpp"
#include "ehdjet/core/thread_count.hpp"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <unistd.h>

#include "scenes.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {

CLI::Option* SceneOptions::add_to(CLI::App& command) {
  CLI::Option* option = command.add_option("SCENE", scene,
                                           "Scene file (TOML), name of one of the scenes "
                                           "that `ehdjet scenes` lists, or run file, whose "
                                           "scene is taken");
  add_set_option(command, overrides, "Override a key: table.key=value (repeatable)");
  add_calibration_option(command, calibration);
  return option;
}

Scene SceneOptions::read() const {
  std::vector<std::string> all = overrides;
  if (!calibration.empty()) // a relative path in a scene would be relative to the scene
    all.push_back(fmt::format("coulomb.calibration=\"{}\"",
                              std::filesystem::absolute(calibration).string()));
  return read_scene_or_run(find_scene(scene), all);
}

void add_set_option(CLI::App& command, std::vector<std::string>& overrides,
                    const std::string& help) {
  command.add_option("--set", overrides, help)
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_calibration_option(CLI::App& command, std::string& file) {
  command
      .add_option("--calibration", file,
                  "Costs by which solver = \"auto\" chooses, written by `ehdjet calibrate`")
      ->type_name("FILE");
}

void add_run_file_option(CLI::App& command, std::string& file) {
  command.add_option("run", file, "Run file (HDF5)")->required()->type_name("RUN.h5");
}

CLI::Validator finite_number() {
  const auto refusal = [](const std::string& given) {
    char* end = nullptr;
    const double value = std::strtod(given.c_str(), &end);
    return *end == '\0' && !std::isfinite(value) ? given + ": must be finite"
                                                 : std::string();
  };
  return CLI::Validator(refusal, "");
}

void say_written(const std::filesystem::path& file, bool given) {
  if (!given || ::isatty(STDOUT_FILENO) != 0)
    print_result("written to {}\n", printable(file.string()));
}

void add_threads_option(CLI::App& command, std::optional<std::size_t>& threads) {
  command.add_option("--threads", threads, "Number of threads; default: all processors")
      ->check(CLI::Range(1, 4096));
}

void warn_of_threads(std::optional<std::size_t> asked) {
  const std::size_t wanted =
      asked.value_or(static_cast<std::size_t>(omp_get_max_threads()));
  if (const std::size_t granted = granted_threads(wanted); granted < wanted)
    message("warning: {} thread{} instead of {}, because of OMP_THREAD_LIMIT. Results "
            "depend on their number in the last digits\n",
            granted, granted == 1 ? " runs" : "s run", wanted);
}

} // namespace ehdjet::cli
