#include "ehdjet/io/export.hpp"

#include "selected_frames.hpp"

namespace ehdjet {

namespace {

char species(const Frame& frame, std::size_t bead) {
  if (bead == 0) return 'N';
  if (frame.embryo[bead] != 0) return 'E';
  return frame.landed[bead] != 0 ? 'L' : 'B';
}

void print(const Frame& f, TextOutput& output) {
  output.print(
      "{}\nProperties=species:S:1:pos:R:3:velo:R:3:radius:R:1:stress:R:1:charge:R:1 "
      "Time={:.17g} Units=\"s m m/s m Pa C\"\n",
      f.beads(), f.time);
  for (std::size_t k = 0; k < f.beads(); ++k) {
    output.print(
        "{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n",
        species(f, k), f.x[k], f.y[k], f.z[k], f.vx[k], f.vy[k], f.vz[k], f.radius[k],
        f.stress[k], f.charge[k]);
  }
}

} // namespace

void export_xyz(const RunReader& run, std::optional<double> time, TextOutput& output) {
  const FrameRange range = selected_frames(run, time);
  for (std::size_t k = range.first; k < range.end; ++k) print(run.frame(k), output);
  output.close();
}

} // namespace ehdjet
