#include "ehdjet/scene/read_scene.hpp"

#include <sstream>
#include <vector>

#include "fuzz/target.hpp"

// What follows --set, one per line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ehdjet;
  std::istringstream lines(fuzz::text_of(data, size));
  std::vector<std::string> overrides;
  for (std::string line; std::getline(lines, line);) overrides.push_back(line);
  return fuzz::refusing(
      [&] { (void)read_scene(EHDJET_SCENES "/quickstart.toml", overrides); });
}
