#include "ehdjet/core/error.hpp"
#include "ehdjet/run_files/frame_reader.hpp"

#include <fmt/format.h>

#include "chain_formats.hpp"

namespace ehdjet {

ChainBeads read_chain_hdf5(const std::filesystem::path& file, std::optional<double> time) {
  const FrameReader run(file);
  const std::size_t index = run.nearest_frame(time);
  const Frame frame = run.frame(index);
  ChainBeads beads;
  for (const auto& column : chain_columns) {
    const RunTable::Column* given = frame.find(column.hdf5);
    if (given == nullptr && column.hdf5_required)
      throw InputError(
          fmt::format("{} has no dataset /beads/{}", file.string(), column.hdf5));
    beads.*column.values =
        given != nullptr ? given->values : std::vector<double>(frame.rows());
  }
  if (const RunTable::Column* embryo = frame.find("embryo")) // is no bead of a chain
    for (std::size_t i = frame.rows(); i-- > 0;)
      if (embryo->values[i] != 0)
        for (const auto& column : chain_columns) {
          auto& values = beads.*column.values;
          values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
        }
  check_chain(beads, [&](std::size_t bead, const char*) {
    return fmt::format("{}: frame {} (t = {} s), bead {}", file.string(), index, frame.time,
                       bead);
  });
  return beads;
}

} // namespace ehdjet
