#include "ehdjet/core/error.hpp"
#include "ehdjet/core/printable.hpp"
#include "ehdjet/io/export.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "record_columns.hpp"
#include "xml_text.hpp"

namespace ehdjet {
namespace {

namespace fs = std::filesystem;

/// The name of an element for each bead, which readers that know only elements take, too.
std::vector<std::string_view> species(const Frame& frame) {
  const auto &embryo = frame["embryo"], &landed = frame["landed"];
  std::vector<std::string_view> all(frame.rows(), "B");
  for (std::size_t k = 0; k < all.size(); ++k)
    if (embryo[k] != 0)
      all[k] = "Es";
    else if (landed[k] != 0)
      all[k] = "La";
  for (const BeadRange& jet : jets_of(frame)) all[jet.begin] = "N";
  return all;
}

/// Beads with the columns that all exports have, and with `further` ones. `remark`: behind the properties.
void print_xyz(const RunTable& beads, const std::vector<std::string_view>& species,
               std::vector<RunTable::Column> further, const std::string& remark,
               TextOutput& output) {
  std::vector<std::vector<double>> columns;
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz", "radius", "stress", "charge"})
    columns.push_back(column_or_zeros(beads, name));
  std::string properties, units;
  for (RunTable::Column& c : further) {
    properties += fmt::format(":{}:R:1", printable(c.name));
    units += fmt::format(" {}", printable(c.unit));
    columns.push_back(std::move(c.values));
  }
  output.print(
      "{}\nProperties=species:S:1:pos:R:3:velo:R:3:radius:R:1:stress:R:1:charge:R:1{} "
      "{}Units=\"s m m/s m Pa C{}\"\n",
      beads.rows(), properties, remark, units);
  for (std::size_t k = 0; k < beads.rows(); ++k) {
    output.print("{}", species[k]);
    for (const auto& column : columns) output.print(" {:.17g}", column[k]);
    output.print("\n");
  }
}

/// Base64 with padding (RFC 4648).
std::string base64(std::span<const unsigned char> bytes) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t given = std::min<std::size_t>(bytes.size() - i, 3);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8U | (j < given ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j)
      text += j <= given ? digits[group >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

/// An array of a VTK XML file: the number of its bytes and the bytes, in base64.
template <class T>
void print_array(TextOutput& output, const char* type, const std::string& name,
                 int components, const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::vector<unsigned char> bytes(sizeof size + size);
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  output.print(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" NumberOfTuples=\"{}\" "
      "format=\"binary\">{}</DataArray>\n",
      type, name, components, values.size() / static_cast<std::size_t>(components),
      base64(bytes));
}

std::vector<double> vectors(const RunTable& frame, const char* x, const char* y,
                            const char* z) {
  std::vector<double> all;
  all.reserve(3 * frame.rows());
  const auto &xs = frame[x], &ys = frame[y], &zs = frame[z];
  for (std::size_t k = 0; k < frame.rows(); ++k)
    all.insert(all.end(), {xs[k], ys[k], zs[k]});
  return all;
}

/// One poly-line per jet, with the columns that all exports have and with `further` ones.
void print_poly_lines(const RunTable& beads, const std::vector<BeadRange>& jets,
                      const std::vector<RunTable::Column>& further,
                      std::optional<double> time, TextOutput& output) {
  std::vector<std::int64_t> connectivity(beads.rows()), ends;
  std::iota(connectivity.begin(), connectivity.end(), 0);
  for (const BeadRange& jet : jets) ends.push_back(static_cast<std::int64_t>(jet.end));
  output.print("<?xml version=\"1.0\"?>\n"
               "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
               "header_type=\"UInt64\">\n<PolyData>\n");
  if (time) {
    output.print("<FieldData>\n");
    print_array(output, "Float64", "TimeValue", 1, std::vector<double>{*time});
    output.print("</FieldData>\n");
  }
  output.print("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" "
               "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
               "<PointData Scalars=\"radius\" Vectors=\"velocity\">\n",
               beads.rows(), ends.size());
  print_array(output, "Float64", "radius", 1, beads["radius"]);
  print_array(output, "Float64", "stress", 1, column_or_zeros(beads, "stress"));
  print_array(output, "Float64", "velocity", 3, vectors(beads, "vx", "vy", "vz"));
  print_array(output, "Float64", "charge", 1, beads["charge"]);
  for (const RunTable::Column& c : further)
    print_array(output, "Float64", xml_text(printable(c.name)), 1, c.values);
  output.print("</PointData>\n<Points>\n");
  print_array(output, "Float64", "Points", 3, vectors(beads, "x", "y", "z"));
  output.print("</Points>\n<Lines>\n");
  print_array(output, "Int64", "connectivity", 1, connectivity);
  print_array(output, "Int64", "offsets", 1, ends);
  output.print("</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  output.complete();
}

/// The deposit, the fibre of one jet after the other.
struct Fibres {
  RunTable beads;
  std::vector<BeadRange> jets;
  std::vector<RunTable::Column> further; // that not all exports have

  explicit Fibres(const RunReader& run)
      : beads(run.table("deposit")) {
    if (const RunTable::Column* jet = beads.find("jet")) {
      std::vector<std::size_t> order(beads.rows());
      std::iota(order.begin(), order.end(), 0U);
      const std::vector<double> number = jet->values;
      std::ranges::stable_sort(order, {}, [&](std::size_t k) { return number[k]; });
      for (RunTable::Column& c : beads.columns) {
        const std::vector<double> given = c.values;
        std::ranges::transform(order, c.values.begin(),
                               [&](std::size_t k) { return given[k]; });
      }
    }
    if (beads.rows() > 0) jets = jets_of(beads);
    constexpr std::string_view common[] = {"x",  "y",      "z",      "vx",    "vy",
                                           "vz", "radius", "stress", "charge"};
    for (const RunTable::Column& c : beads.columns)
      if (std::ranges::find(common, c.name) == std::end(common)) further.push_back(c);
  }
};

/// Creates the folder for the frames.
void prepare(const fs::path& folder, bool overwrite) {
  std::error_code error;
  if (!overwrite && fs::exists(folder, error))
    throw InputError(folder.string()
                     + " exists: choose another name with -o or overwrite it with --force");
  fs::create_directory(folder, error);
  if (error) throw InputError("cannot create " + folder.string() + ": " + error.message());
}

/// Removes the frames of an earlier export that are not among the new ones.
void remove_other_frames(const fs::path& folder, const std::set<std::string>& frames) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && name.ends_with(".vtp") && !frames.contains(name))
      fs::remove(entry.path(), error);
  }
}

} // namespace

void export_xyz(const RunReader& run, std::optional<double> time, TextOutput& output) {
  const std::size_t last = run.nearest_frame(time);
  for (std::size_t k = time ? last : 0; k <= last; ++k) {
    const Frame frame = run.frame(k);
    print_xyz(frame, species(frame), further_columns(frame),
              fmt::format("Time={:.17g} ", frame.time), output);
  }
  output.close();
}

void export_deposit_xyz(const RunReader& run, TextOutput& output) {
  const Fibres fibres(run);
  print_xyz(fibres.beads, std::vector<std::string_view>(fibres.beads.rows(), "La"),
            fibres.further, "", output);
  output.close();
}

void export_deposit_vtk(const RunReader& run, TextOutput& output) {
  const Fibres fibres(run);
  print_poly_lines(fibres.beads, fibres.jets, fibres.further, std::nullopt, output);
  output.publish();
}

void export_vtk(const RunReader& run, std::optional<double> time, const fs::path& pvd,
                bool overwrite) {
  const std::size_t last = run.nearest_frame(time);
  TextOutput collection(pvd, overwrite, run.path());
  const std::string folder = pvd.stem().string() + "_vtk";
  prepare(pvd.parent_path() / folder, overwrite);
  collection.print(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<!-- SI units: radius m, stress Pa, velocity m/s, charge C, time s -->\n"
      "<Collection>\n");
  std::deque<TextOutput> frames; // published when all of them are whole
  std::set<std::string> names;
  for (std::size_t k = time ? last : 0; k <= last; ++k) {
    const Frame frame = run.frame(k);
    const std::string name = fmt::format("frame_{:06}.vtp", k);
    names.insert(name);
    print_poly_lines(
        frame, jets_of(frame), further_columns(frame), frame.time,
        frames.emplace_back(pvd.parent_path() / folder / name, overwrite, run.path()));
    collection.print(
        "<DataSet timestep=\"{:.17g}\" group=\"\" part=\"0\" file=\"{}/{}\"/>\n",
        frame.time, xml_text(folder), name);
  }
  collection.print("</Collection>\n</VTKFile>\n");
  collection.complete();
  for (TextOutput& frame : frames) frame.publish();
  collection.publish();
  remove_other_frames(pvd.parent_path() / folder, names);
}

} // namespace ehdjet
