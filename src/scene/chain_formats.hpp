#pragma once

#include "ehdjet/scene/config.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// A column that every jet has, by its names in CSV and in the HDF5 files of a run.
struct ChainColumn {
  std::string csv, hdf5;
  std::vector<double> ChainBeads::*values;
  bool csv_required;
};
const std::vector<ChainColumn>& chain_columns();

ChainBeads read_chain_csv(const std::filesystem::path& file);
ChainBeads read_chain_hdf5(const std::filesystem::path& file, std::optional<double> time);

/// The laws of read_chain that do not depend on the format. `where(bead)` and
/// `where(bead, column)` say where a bead or one of its numbers stands.
void check_chain(
    const ChainBeads& beads,
    const std::function<std::string(std::size_t bead, std::string_view column)>& where);

} // namespace ehdjet
