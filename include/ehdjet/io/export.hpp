#pragma once

#include "ehdjet/io/text_output.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace ehdjet {

// Every number is written with the 17 digits that bring back the same double, in SI units that
// the header of its column names. InputError if the run has no such part.

/// One row per output time, deposited bead, refinement or time of the budget (CSV): the part
/// "observables", "deposit", "refinements" or "budget". A deposited bead has the arc length of the
/// fibre up to the end of its link, from the first bead that left the chain; links are as long as
/// when they left.
void export_table(const RunReader& run, const std::string& part, TextOutput& output);

/// One row per bead of the frame nearest to `time`, the last one by default (CSV).
void export_beads(const RunReader& run, std::optional<double> time, TextOutput& output);

/// Time mean and minimum of the resolving power at each lambda (CSV), over the samples from time
/// `from` on [s]; by default the later half of the run.
/// errors : InputError if there is no sample that late
void export_resolving_power(const RunReader& run, std::optional<double> from,
                            TextOutput& output);

/// All frames, or the one nearest to `time`, as extended XYZ: OVITO reads all of it; VMD wants
/// the same number of beads in every frame, so give it one frame.
/// Species: N nozzle, E embryo, L landed, B any other bead.
void export_xyz(const RunReader& run, std::optional<double> time, TextOutput& output);

/// All frames, or the one nearest to `time`, for ParaView: the collection `pvd` and, in the
/// folder <name of pvd>_vtk beside it, one poly-line per frame (VTK XML PolyData).
void export_vtk(const RunReader& run, std::optional<double> time,
                const std::filesystem::path& pvd, bool overwrite);

} // namespace ehdjet
