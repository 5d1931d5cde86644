#include "ehdjet/io/export.hpp"
#include "ehdjet/io/plot_page.hpp"
#include "ehdjet/run_files/run_reader.hpp"
#include "ehdjet/runs/run_scene.hpp"
#include "ehdjet/scene/chain_file.hpp"

#include "fuzz/target.hpp"
#include "support/folder.hpp"
#include "support/mutant.hpp"

// A run file in which the input changes values, types, lengths and links. Everything that reads it does so, and the run
// goes on for a few steps.
namespace {

namespace fs = std::filesystem;
using namespace ehdjet;

struct Original {
  Original() {
    RunOptions options;
    options.threads = 1;
    run_scene(scene, folder / "whole.h5", std::move(options));
    scene.config.run.end_time = 1;
  }

  Scene scene =
      read_scene(EHDJET_SCENES "/pvp.toml",
                 {"collector.distance=0.004", "field.potential=225", "run.end_time=4e-3",
                  "output.frames=1e-3", "output.observables=1e-3",
                  "output.checkpoints=1e-3", "output.resolving_power=1e-3"});
  test::Folder folder;
};

void go_on(const Original& original, const fs::path& file) {
  int attempts = 0;
  RunOptions options;
  options.continue_from = file, options.overwrite = true, options.threads = 1;
  options.interrupted = [&]() -> const char* {
    return ++attempts > 10 ? "the target" : nullptr;
  };
  const RunResult end =
      run_scene(original.scene, original.folder / "on.h5", std::move(options));
  if (!all_finite(end.jet.y)) __builtin_trap();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Original original;
  const fs::path file = original.folder / "mutant.h5";
  fs::copy_file(original.folder / "whole.h5", file, fs::copy_options::overwrite_existing);
  // Eight bytes of the input are a choice; behind its end every choice is the first one.
  std::size_t read = 0;
  (void)test::mutate(file, [&](std::uint64_t n) {
    std::uint64_t value = 0;
    for (int byte = 0; byte < 8 && (n >> (8 * byte)) != 0; ++byte)
      value = value << 8U | (read < size ? data[read++] : 0U);
    return value % n;
  });
  for (const char* part : {"observables", "deposit"})
    fuzz::refusing([&] { (void)RunReader(file).table(part); });
  fuzz::refusing([&] { (void)RunReader(file).resolving_power(); });
  fuzz::refusing([&] {
    const RunReader run(file);
    (void)PlotPage({{&run, "run"}}, "", {}).draw({});
  });
  fuzz::refusing([&] { (void)read_chain(file); });
  return fuzz::refusing([&] { go_on(original, file); });
}
