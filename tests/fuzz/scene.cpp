#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/scene/scene_report.hpp"

#include "fuzz/target.hpp"

// A scene file, as `ehdjet check` reads it. What it resolves to must be a scene again, and the same one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ehdjet;
  return fuzz::refusing([&] {
    const Scene scene =
        read_scene_text(fuzz::text_of(data, size), "scene.toml", EHDJET_SCENES);
    (void)scene_report(scene);
    const std::string resolved = resolved_toml(scene.config);
    if (difference_from(resolved, scene.config)) __builtin_trap();
  });
}
