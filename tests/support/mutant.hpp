#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace ehdjet::test {

/// Changes objects of a run file as a hostile or careless hand might: values, lengths, types, texts, links. The
/// file stays an HDF5 file.
struct Mutation {
  std::string text;            ///< what was done
  bool in_checkpoint = false;  ///< something in /checkpoint was changed
  bool with_checksums = false; ///< and its checksums were made to fit again
};

/// `choose(n)`: a number from 0 to n - 1.
using Choose = std::function<std::uint64_t(std::uint64_t n)>;
Mutation mutate(const std::filesystem::path& file, const Choose& choose);
/// The mutation of that number, always the same one.
Mutation mutate(const std::filesystem::path& file, std::uint64_t number);

} // namespace ehdjet::test
