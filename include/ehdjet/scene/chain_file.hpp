#pragma once

#include "ehdjet/scene/config.hpp"

#include <filesystem>
#include <optional>

namespace ehdjet {

/// Reads the beads of a chain scene, from CSV or from an HDF5 file written by a run.
///
/// CSV: a header line, columns in any order; lines that start with # are comments. Required: x_m,
/// y_m, z_m, mass_kg, charge_c, volume_m3. Optional, default 0: vx_m_s, vy_m_s, vz_m_s. A column
/// `bead` must count 0, 1, 2, ...; a column `embryo` must be 0.
/// HDF5: datasets /frames/{time,offset} and /beads/{x,y,z,vx,vy,vz,volume,mass,charge,
/// embryo?}; frame k is rows offset[k] to offset[k+1]. All other columns, as stress_pa or
/// /beads/stress, are kept for a jet that has such a column (ChainBeads::others). The frame
/// nearest to `time` (default: the last) is read, without its embryo: its neighbours are linked
/// to each other as long as it exists (model 4.1).
///
/// units  : SI
/// laws   : two beads at least; all numbers finite; mass > 0; volume > 0 (bead 0: >= 0); no two
///          neighbours in the same place
/// errors : InputError with file, line and column (CSV) or frame and bead (HDF5)
ChainBeads read_chain(const std::filesystem::path& file, std::optional<double> time = {});

} // namespace ehdjet
