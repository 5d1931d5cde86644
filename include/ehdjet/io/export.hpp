#pragma once

#include "ehdjet/io/text_output.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// Exports of a run. Numbers are in SI units; in text they have 17 digits, which give back the
/// same double. All functions throw an InputError if the run does not have the part.
namespace ehdjet {

/// Writes "observables", "deposit", "refinements" or "budget" as CSV: one row per output time,
/// deposited bead or refinement. The deposit also gets the arc length of each jet's fibre, from the first
/// bead that left the chain to the end of the bead's link, with link lengths at removal.
void export_table(const RunReader& run, const std::string& part, TextOutput& output);

/// Writes the observables as JETSPIN's statout.dat, in its units (cgs, angles in degrees): the number of steps, then t x yz n angl
/// lp vn vc rc curn curc in columns of 20 characters, below a line that begins with #.
void export_jetspin_statistics(const RunReader& run, TextOutput& output);

/// Writes one row per bead of the frame nearest to `time`, by default the last one (CSV).
void export_beads(const RunReader& run, std::optional<double> time, TextOutput& output);

/// Writes the time mean and minimum of the resolving power at each lambda (CSV), over the samples
/// with time >= `from` [s]; by default over the second half of the run.
/// errors : InputError if there is no such sample
void export_resolving_power(const RunReader& run, std::optional<double> from,
                            TextOutput& output);

/// Writes all frames, or the one nearest to `time`, as extended XYZ. OVITO reads all frames; VMD
/// requires the same number of beads in every frame and can therefore read a single frame.
/// Species: N nozzle, Es embryo, La landed, B any other bead. They are names of elements, because ASE
/// takes no others.
void export_xyz(const RunReader& run, std::optional<double> time, TextOutput& output);

/// Writes the deposited fibre, bead by bead and one jet after the other, as extended XYZ or as one
/// poly-line per jet (VTK XML PolyData).
void export_deposit_xyz(const RunReader& run, TextOutput& output);
void export_deposit_vtk(const RunReader& run, TextOutput& output);

/// Writes an XDMF 2 file that shows ParaView all frames in the run file itself, or the one nearest to
/// `time`. `xdmf` is its path: it refers to the run file from its folder on.
void export_xdmf(const RunReader& run, std::optional<double> time,
                 const std::filesystem::path& xdmf, TextOutput& output);

/// Writes all frames, or the one nearest to `time`, for ParaView: the collection `pvd` and one
/// poly-line per frame and jet (VTK XML PolyData) in the folder <name of pvd>_vtk beside it.
void export_vtk(const RunReader& run, std::optional<double> time,
                const std::filesystem::path& pvd, bool overwrite);

} // namespace ehdjet
