#pragma once

#include "ehdjet/io/run_reader.hpp"
#include "ehdjet/io/text_output.hpp"

#include <filesystem>
#include <optional>

namespace ehdjet {

// Every number is written with the 17 digits that bring back the same double, in SI units that
// the header of its column names. InputError if the run has no such part.

/// One row per output time (CSV).
void export_observables(const RunReader& run, TextOutput& output);

/// One row per bead of the frame nearest to `time`, the last one by default (CSV).
void export_beads(const RunReader& run, std::optional<double> time, TextOutput& output);

/// One row per deposited bead (CSV).
void export_deposit(const RunReader& run, TextOutput& output);

/// All frames, or the one nearest to `time`, as extended XYZ: OVITO reads all of it; VMD wants
/// the same number of beads in every frame, so give it one frame.
/// Species: N nozzle, E embryo, L landed, B any other bead.
void export_xyz(const RunReader& run, std::optional<double> time, TextOutput& output);

/// All frames, or the one nearest to `time`, for ParaView: the collection `pvd` and, in the
/// folder <name of pvd>_vtk beside it, one poly-line per frame (VTK XML PolyData).
void export_vtk(const RunReader& run, std::optional<double> time,
                const std::filesystem::path& pvd, bool overwrite);

} // namespace ehdjet
