#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "record_columns.hpp"

namespace ehdjet {
namespace {

namespace fs = std::filesystem;

/// Of each bead.
std::string species(const Frame& frame) {
  const auto &embryo = frame["embryo"], &landed = frame["landed"];
  std::string all(frame.rows(), 'B');
  for (std::size_t k = 0; k < all.size(); ++k)
    if (embryo[k] != 0)
      all[k] = 'E';
    else if (landed[k] != 0)
      all[k] = 'L';
  for (const BeadRange& jet : jets_of(frame)) all[jet.begin] = 'N';
  return all;
}

void print_xyz(const Frame& frame, TextOutput& output) {
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
  const std::string kinds = species(frame);
  for (std::size_t k = 0; k < frame.rows(); ++k) {
    output.print("{}", kinds[k]);
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

std::vector<double> vectors(const Frame& frame, const char* x, const char* y,
                            const char* z) {
  std::vector<double> all;
  all.reserve(3 * frame.rows());
  const auto &xs = frame[x], &ys = frame[y], &zs = frame[z];
  for (std::size_t k = 0; k < frame.rows(); ++k)
    all.insert(all.end(), {xs[k], ys[k], zs[k]});
  return all;
}

/// One poly-line per jet.
void print_poly_lines(const Frame& frame, TextOutput& output) {
  std::vector<std::int64_t> connectivity(frame.rows()), ends;
  std::iota(connectivity.begin(), connectivity.end(), 0);
  for (const BeadRange& jet : jets_of(frame))
    ends.push_back(static_cast<std::int64_t>(jet.end));
  output.print("<?xml version=\"1.0\"?>\n"
               "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
               "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n");
  print_array(output, "Float64", "TimeValue", 1, std::vector<double>{frame.time});
  output.print("</FieldData>\n"
               "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" "
               "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
               "<PointData Scalars=\"radius\" Vectors=\"velocity\">\n",
               frame.rows(), ends.size());
  print_array(output, "Float64", "radius", 1, frame["radius"]);
  print_array(output, "Float64", "stress", 1, column_or_zeros(frame, "stress"));
  print_array(output, "Float64", "velocity", 3, vectors(frame, "vx", "vy", "vz"));
  print_array(output, "Float64", "charge", 1, frame["charge"]);
  for (const RunTable::Column& c : further_columns(frame))
    print_array(output, "Float64", c.name, 1, c.values);
  output.print("</PointData>\n<Points>\n");
  print_array(output, "Float64", "Points", 3, vectors(frame, "x", "y", "z"));
  output.print("</Points>\n<Lines>\n");
  print_array(output, "Int64", "connectivity", 1, connectivity);
  print_array(output, "Int64", "offsets", 1, ends);
  output.print("</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  output.close();
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

/// Creates the folder for the frames, or removes the frames of an earlier export from it: they
/// might be more than the new ones.
void prepare(const fs::path& folder, bool overwrite) {
  refuse_existing(folder, overwrite);
  std::error_code error;
  if (fs::create_directory(folder, error); !error)
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("frame_") && name.ends_with(".vtp"))
        fs::remove(entry.path(), error);
    }
  if (error) throw InputError("cannot create " + folder.string() + ": " + error.message());
}

} // namespace

void export_xyz(const RunReader& run, std::optional<double> time, TextOutput& output) {
  const std::size_t last = run.nearest_frame(time);
  for (std::size_t k = time ? last : 0; k <= last; ++k) print_xyz(run.frame(k), output);
  output.close();
}

void export_vtk(const RunReader& run, std::optional<double> time, const fs::path& pvd,
                bool overwrite) {
  const std::size_t last = run.nearest_frame(time);
  TextOutput collection(pvd, overwrite);
  const std::string folder = pvd.stem().string() + "_vtk";
  prepare(pvd.parent_path() / folder, overwrite);
  collection.print(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<!-- SI units: radius m, stress Pa, velocity m/s, charge C, time s -->\n"
      "<Collection>\n");
  for (std::size_t k = time ? last : 0; k <= last; ++k) {
    const Frame frame = run.frame(k);
    const std::string file = fmt::format("{}/frame_{:06}.vtp", folder, k);
    TextOutput output(pvd.parent_path() / file, overwrite);
    print_poly_lines(frame, output);
    collection.print("<DataSet timestep=\"{:.17g}\" group=\"\" part=\"0\" file=\"{}\"/>\n",
                     frame.time, escaped(file));
  }
  collection.print("</Collection>\n</VTKFile>\n");
  collection.close();
}

} // namespace ehdjet
