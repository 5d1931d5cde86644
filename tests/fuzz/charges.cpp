#include "ehdjet/core/csv_table.hpp"

#include <cmath>

#include "fuzz/target.hpp"

// The charges of `ehdjet forces`.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ehdjet;
  static const fuzz::InputFile file;
  return fuzz::refusing([&] {
    CsvTable table(file.with(data, size), {"x", "y", "z", "q"}, {});
    while (table.next_row())
      for (std::size_t column = 0; column < 4; ++column)
        if (!std::isfinite(table.value(column))) __builtin_trap();
  });
}
