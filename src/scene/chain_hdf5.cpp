#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"
#include "ehdjet/run_files/run_reader.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "chain_formats.hpp"

namespace ehdjet {

ChainBeads read_chain_hdf5(const std::filesystem::path& file, std::optional<double> time) {
  const FrameReader run(file);
  const std::size_t index = run.nearest_frame(time);
  Frame frame = run.frame(index);
  if (frame.find("jet") != nullptr)
    throw InputError(fmt::format("{} is a run with [array]: its frames have several jets, "
                                 "and a scene can start from one chain only",
                                 file.string()));
  ChainBeads beads;
  // What is read is moved, so that a long chain is not in memory twice.
  const RunTable::Column* marked = frame.find("embryo"); // is no bead of a chain
  const std::vector<double> embryo =
      marked != nullptr ? marked->values : std::vector<double>();
  const auto without_embryo = [&embryo](std::vector<double> values) {
    for (std::size_t i = embryo.size(); i-- > 0;)
      if (embryo[i] != 0) values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
    return values;
  };
  for (const auto& column : chain_columns()) {
    const auto given =
        std::ranges::find(frame.columns, column.hdf5, &RunTable::Column::name);
    if (given == frame.columns.end())
      throw InputError(
          fmt::format("{} has no dataset /beads/{}", file.string(), column.hdf5));
    beads.*column.values = without_embryo(std::move(given->values));
  }
  for (RunTable::Column& c : frame.columns) // the others
    if (std::ranges::find(chain_columns(), c.name, &ChainColumn::hdf5)
        == chain_columns().end())
      beads.others[csv_name(c.name, c.unit)].values = without_embryo(std::move(c.values));
  check_chain(beads, [&](std::size_t bead, std::string_view) {
    return fmt::format("{}: frame {} (t = {} s), bead {}", file.string(), index, frame.time,
                       bead);
  });
  return beads;
}

} // namespace ehdjet
