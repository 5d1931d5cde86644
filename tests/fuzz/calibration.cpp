#include "ehdjet/scene/calibration_file.hpp"

#include "fuzz/target.hpp"

// A calibration. What is read is written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ehdjet;
  static const fuzz::InputFile file, again;
  return fuzz::refusing([&] {
    const std::string text = calibration_text(read_calibration(file.with(data, size)), "");
    const CostModel model = read_calibration(
        again.with(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    if (calibration_text(model, "") != text) __builtin_trap();
    (void)model.crossover(1e-6);
  });
}
