#include "ehdjet/io/export.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "record_columns.hpp"
#include "selected_frames.hpp"

namespace ehdjet {

namespace {

char species(const Frame& frame, std::size_t bead) {
  if (bead == 0) return 'N';
  if (frame["embryo"][bead] != 0) return 'E';
  return frame["landed"][bead] != 0 ? 'L' : 'B';
}

void print(const Frame& frame, TextOutput& output) {
  std::vector<std::vector<double>> columns;
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "radius", "stress", "charge"})
    columns.push_back(column_or_zeros(frame, name));
  std::string properties, units;
  for (RunTable::Column& c : further_columns(frame)) {
    properties += ":" + c.name + ":R:1", units += " " + c.unit;
    columns.push_back(std::move(c.values));
  }
  output.print(
      "{}\nProperties=species:S:1:pos:R:3:velo:R:3:radius:R:1:stress:R:1:charge:R:1{} "
      "Time={:.17g} Units=\"s m m/s m Pa C{}\"\n",
      frame.rows(), properties, frame.time, units);
  for (std::size_t k = 0; k < frame.rows(); ++k) {
    output.print("{}", species(frame, k));
    for (const auto& column : columns) output.print(" {:.17g}", column[k]);
    output.print("\n");
  }
}

} // namespace

void export_xyz(const RunReader& run, std::optional<double> time, TextOutput& output) {
  const FrameRange range = selected_frames(run, time);
  for (std::size_t k = range.first; k < range.end; ++k) print(run.frame(k), output);
  output.close();
}

} // namespace ehdjet
