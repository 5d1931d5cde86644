#include "ehdjet/io/export.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "record_columns.hpp"
#include "xml_text.hpp"

namespace ehdjet {
namespace {

/// The run file as the XDMF file refers to it.
struct Source {
  std::string name;
  std::size_t rows; // of /beads

  /// The rows of a jet of one data set of /beads.
  [[nodiscard]] std::string slab(std::string_view column, BeadRange beads) const {
    return fmt::format(
        "<DataItem ItemType=\"HyperSlab\" Type=\"HyperSlab\" Dimensions=\"{0}\" "
        "NumberType=\"Float\" Precision=\"8\">"
        "<DataItem Dimensions=\"3 1\" Format=\"XML\">{1} 1 {0}</DataItem>"
        "<DataItem Dimensions=\"{2}\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">"
        "{3}:/beads/{4}</DataItem></DataItem>\n",
        beads.size(), beads.begin, rows, name, column);
  }
};

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// A jet in one frame: a line through its beads.
void print_jet(const Source& run, BeadRange beads, std::size_t number,
               const std::vector<RunTable::Column>& columns, TextOutput& output) {
  output.print("<Grid Name=\"jet {}\" GridType=\"Uniform\">\n"
               "<Topology TopologyType=\"Polyline\" NumberOfElements=\"1\" "
               "NodesPerElement=\"{}\"/>\n<Geometry GeometryType=\"X_Y_Z\">\n",
               number, beads.size());
  for (const char* axis : {"x", "y", "z"}) output.print("{}", run.slab(axis, beads));
  output.print("</Geometry>\n<Attribute Name=\"velocity\" AttributeType=\"Vector\" "
               "Center=\"Node\">\n<DataItem ItemType=\"Function\" "
               "Function=\"JOIN($0, $1, $2)\" Dimensions=\"{} 3\" NumberType=\"Float\" "
               "Precision=\"8\">\n",
               beads.size());
  for (const char* axis : {"vx", "vy", "vz"}) output.print("{}", run.slab(axis, beads));
  output.print("</DataItem>\n</Attribute>\n");
  for (const RunTable::Column& c : columns) {
    // Flags and numbers are no fields in space.
    if (is_one_of(c.name, {"x", "y", "z", "vx", "vy", "vz", "landed", "embryo", "jet"}))
      continue;
    const std::string name = xml_text(c.name);
    output.print("<Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Node\">\n{}"
                 "</Attribute>\n",
                 name, run.slab(name, beads));
  }
  output.print("</Grid>\n");
}

} // namespace

void export_xdmf(const RunReader& run, std::optional<double> time,
                 const std::filesystem::path& xdmf, TextOutput& output) {
  const std::size_t last = run.nearest_frame(time), first = time ? last : 0;
  const std::vector<BeadRange> rows = run.frame_rows();
  const std::vector<double> times = run.frame_times();
  const auto folder = std::filesystem::absolute(xdmf).parent_path();
  const Source source{xml_text(std::filesystem::proximate(run.path(), folder).string()),
                      rows.back().end};
  output.print("<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n"
               "<!-- SI units: lengths m, stress Pa, velocity m/s, charge C, time s -->\n"
               "<Domain>\n<Grid Name=\"jets\" GridType=\"Collection\" "
               "CollectionType=\"Temporal\">\n");
  const Frame start = run.frame(first);
  const bool array = start.find("jet") != nullptr;
  for (std::size_t k = first; k <= last; ++k) {
    std::vector<BeadRange> jets{{0, rows[k].size()}};
    if (array) jets = jets_of(run.frame(k));
    output.print(
        "<Grid Name=\"frame {}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
        "<Time Value=\"{:.17g}\"/>\n",
        k, times[k]);
    for (std::size_t j = 0; j < jets.size(); ++j)
      print_jet(source, {rows[k].begin + jets[j].begin, rows[k].begin + jets[j].end}, j,
                start.columns, output);
    output.print("</Grid>\n");
  }
  output.print("</Grid>\n</Domain>\n</Xdmf>\n");
  output.close();
}

} // namespace ehdjet
