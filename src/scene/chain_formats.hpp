#pragma once

#include "ehdjet/scene/config.hpp"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace ehdjet {

/// A column of a chain, by its names in CSV and in the HDF5 files of a run.
struct ChainColumn {
  const char* csv;
  const char* hdf5;
  std::vector<double> ChainBeads::*values;
  bool csv_required, hdf5_required;
};
inline constexpr std::array<ChainColumn, 10> chain_columns{{
    {"x_m", "x", &ChainBeads::x, true, true},
    {"y_m", "y", &ChainBeads::y, true, true},
    {"z_m", "z", &ChainBeads::z, true, true},
    {"vx_m_s", "vx", &ChainBeads::vx, false, true},
    {"vy_m_s", "vy", &ChainBeads::vy, false, true},
    {"vz_m_s", "vz", &ChainBeads::vz, false, true},
    {"stress_pa", "stress", &ChainBeads::stress, false, false},
    {"volume_m3", "volume", &ChainBeads::volume, true, true},
    {"mass_kg", "mass", &ChainBeads::mass, true, true},
    {"charge_c", "charge", &ChainBeads::charge, true, true},
}};

ChainBeads read_chain_csv(const std::filesystem::path& file);
ChainBeads read_chain_hdf5(const std::filesystem::path& file, std::optional<double> time);

/// The laws of read_chain that do not depend on the format. `where(bead)` and
/// `where(bead, column)` say where a bead or one of its numbers stands.
void check_chain(
    const ChainBeads& beads,
    const std::function<std::string(std::size_t bead, const char* column)>& where);

} // namespace ehdjet
