#include "ehdjet/scene/chain_file.hpp"

#include "fuzz/target.hpp"

// A chain of beads as CSV.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ehdjet;
  static const fuzz::InputFile file;
  // HDF5 files are the library's to parse; the target run_file changes what is in them.
  if (size > 3 && fuzz::text_of(data, 4) == "\x89HDF") return 0;
  return fuzz::refusing([&] {
    const ChainBeads beads = read_chain(file.with(data, size));
    if (beads.size() < 2) __builtin_trap();
  });
}
