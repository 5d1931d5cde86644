#include "ehdjet/scene/chain_file.hpp"

#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

#include "chain_formats.hpp"

namespace ehdjet {
namespace {

/// HDF5 files begin with these eight bytes (HDF5 File Format Specification 3.0, II.A).
bool is_hdf5(std::ifstream& in) {
  std::array<char, 8> begin{};
  in.read(begin.data(), begin.size());
  return std::string_view(begin.data(), begin.size()) == "\x89HDF\r\n\x1a\n";
}

} // namespace

const std::vector<ChainColumn>& chain_columns() {
  static const auto all = [] {
    constexpr std::array members{
        &ChainBeads::x,      &ChainBeads::y,    &ChainBeads::z,
        &ChainBeads::vx,     &ChainBeads::vy,   &ChainBeads::vz,
        &ChainBeads::volume, &ChainBeads::mass, &ChainBeads::charge};
    std::vector<ChainColumn> list;
    const auto table = BeadTable::basic();
    for (const auto columns : {table->integrated(), table->carried()})
      for (const BeadColumn& c : columns)
        list.push_back({.csv = csv_name(c.name, c.unit),
                        .hdf5 = c.name,
                        .values = members[list.size()],
                        .csv_required = c.unit != "m/s"});
    return list;
  }();
  return all;
}

void ChainBeads::copy_to(const BeadColumn& column, std::span<double> out) const {
  const std::vector<double>* values = nullptr;
  const auto& given = chain_columns();
  const auto basic = std::ranges::find(given, column.name, &ChainColumn::hdf5);
  if (basic != given.end()) {
    values = &(this->*basic->values);
  } else if (const auto other = others.find(csv_name(column.name, column.unit));
             other != others.end()) {
    if (!other->second.fault.empty()) throw InputError(other->second.fault);
    values = &other->second.values;
  }
  EHDJET_EXPECTS(values == nullptr || values->size() == out.size());
  std::ranges::fill(out, column.unless_given);
  if (values != nullptr) std::ranges::copy(*values, out.begin());
}

ChainBeads read_chain(const std::filesystem::path& file, std::optional<double> time) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw InputError(fmt::format("cannot read the chain file {} (chain.file): {}",
                                 file.string(),
                                 in ? "it is a folder" : std::strerror(errno)));
  if (is_hdf5(in)) return read_chain_hdf5(file, time);
  if (time)
    throw InputError(
        fmt::format("chain.time = {} s, but {} is no HDF5 file: it has a single frame",
                    *time, file.string()));
  return read_chain_csv(file);
}

void check_chain(
    const ChainBeads& beads,
    const std::function<std::string(std::size_t bead, std::string_view column)>& where) {
  const auto refuse = [&](std::size_t bead, std::string_view column,
                          const std::string& why) {
    throw InputError(fmt::format("{}: {}", where(bead, column), why));
  };
  const std::size_t n = beads.size();
  if (n < 2)
    refuse(n == 0 ? 0 : n - 1, "",
           fmt::format("a chain of {} bead(s): needs at least 2", n));
  for (std::size_t i = 0; i < n; ++i) {
    for (const auto& column : chain_columns())
      if (const double value = (beads.*column.values)[i]; !std::isfinite(value))
        refuse(i, column.csv, fmt::format("{} = {}: must be finite", column.csv, value));
    if (!(beads.mass[i] > 0))
      refuse(i, "mass_kg",
             fmt::format("mass_kg = {}: must be greater than 0", beads.mass[i]));
    if (!(i == 0 ? beads.volume[i] >= 0 : beads.volume[i] > 0))
      refuse(i, "volume_m3",
             fmt::format("volume_m3 = {}: must be greater than 0 (bead 0: at least 0)",
                         beads.volume[i]));
    if (i > 0
        && !(std::hypot(beads.x[i] - beads.x[i - 1], beads.y[i] - beads.y[i - 1],
                        beads.z[i] - beads.z[i - 1])
             > 0))
      refuse(i, "",
             fmt::format("bead {} is in the same place as bead {}: a link must have a "
                         "length",
                         i, i - 1));
  }
}

} // namespace ehdjet
