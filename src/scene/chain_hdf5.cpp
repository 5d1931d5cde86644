#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "chain_formats.hpp"

namespace ehdjet {

ChainBeads read_chain_hdf5(const std::filesystem::path& file, std::optional<double> time) {
  const FrameReader run(file);
  const std::size_t index = run.nearest_frame(time);
  const Frame frame = run.frame(index);
  ChainBeads beads;
  const RunTable::Column* embryo = frame.find("embryo"); // is no bead of a chain
  const auto without_embryo = [&](std::vector<double> values) {
    for (std::size_t i = frame.rows(); embryo != nullptr && i-- > 0;)
      if (embryo->values[i] != 0)
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
    return values;
  };
  for (const auto& column : chain_columns()) {
    const RunTable::Column* given = frame.find(column.hdf5);
    if (given == nullptr)
      throw InputError(
          fmt::format("{} has no dataset /beads/{}", file.string(), column.hdf5));
    beads.*column.values = without_embryo(given->values);
  }
  for (const RunTable::Column& c : frame.columns) // the others
    if (std::ranges::find(chain_columns(), c.name, &ChainColumn::hdf5)
        == chain_columns().end())
      beads.others[csv_name(c.name, c.unit)].values = without_embryo(c.values);
  check_chain(beads, [&](std::size_t bead, std::string_view) {
    return fmt::format("{}: frame {} (t = {} s), bead {}", file.string(), index, frame.time,
                       bead);
  });
  return beads;
}

} // namespace ehdjet
