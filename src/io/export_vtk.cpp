#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"

#include <cstring>
#include <numeric>
#include <string>
#include <system_error>
#include <vector>

#include "base64.hpp"
#include "record_columns.hpp"
#include "selected_frames.hpp"

namespace ehdjet {

namespace fs = std::filesystem;

namespace {

// An array of a VTK XML file: its bytes after their number, in base64.
template <class T>
void print_array(TextOutput& output, const char* type, const char* name, int components,
                 const std::vector<T>& values) {
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

void print_poly_line(const Frame& frame, TextOutput& output) {
  std::vector<std::int64_t> connectivity(frame.rows());
  std::iota(connectivity.begin(), connectivity.end(), 0);
  output.print("<?xml version=\"1.0\"?>\n"
               "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
               "header_type=\"UInt64\">\n<PolyData>\n");
  output.print("<FieldData>\n");
  print_array(output, "Float64", "TimeValue", 1, std::vector<double>{frame.time});
  output.print("</FieldData>\n");
  output.print("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"1\" "
               "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
               frame.rows());
  output.print("<PointData Scalars=\"radius\" Vectors=\"velocity\">\n");
  print_array(output, "Float64", "radius", 1, frame["radius"]);
  print_array(output, "Float64", "stress", 1, column_or_zeros(frame, "stress"));
  print_array(output, "Float64", "velocity", 3, vectors(frame, "vx", "vy", "vz"));
  print_array(output, "Float64", "charge", 1, frame["charge"]);
  for (const RunTable::Column& c : further_columns(frame))
    print_array(output, "Float64", c.name.c_str(), 1, c.values);
  output.print("</PointData>\n<Points>\n");
  print_array(output, "Float64", "Points", 3, vectors(frame, "x", "y", "z"));
  output.print("</Points>\n<Lines>\n");
  print_array(output, "Int64", "connectivity", 1, connectivity);
  print_array(output, "Int64", "offsets", 1,
              std::vector<std::int64_t>{static_cast<std::int64_t>(frame.rows())});
  output.print("</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  output.close();
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
    case '&':
      result += "&amp;";
      break;
    case '<':
      result += "&lt;";
      break;
    case '"':
      result += "&quot;";
      break;
    default:
      result += c;
    }
  }
  return result;
}

bool is_frame(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("frame_") && name.ends_with(".vtp");
}

// The folder for the frames; those of an earlier, longer export would be taken for ours.
void prepare(const fs::path& folder, bool overwrite) {
  std::error_code error;
  if (fs::exists(folder, error)) {
    if (!overwrite) {
      throw InputError(
          folder.string()
          + " exists: choose another name with -o or overwrite it with --force");
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (is_frame(entry.path())) fs::remove(entry.path(), error);
    }
  } else {
    fs::create_directory(folder, error);
  }
  if (error) throw InputError("cannot create " + folder.string() + ": " + error.message());
}

} // namespace

void export_vtk(const RunReader& run, std::optional<double> time, const fs::path& pvd,
                bool overwrite) {
  const FrameRange range = selected_frames(run, time);
  TextOutput collection(pvd, overwrite);
  const std::string folder = pvd.stem().string() + "_vtk";
  prepare(pvd.parent_path() / folder, overwrite);
  collection.print(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<!-- SI units: radius m, stress Pa, velocity m/s, charge C, time s -->\n"
      "<Collection>\n");
  for (std::size_t k = range.first; k < range.end; ++k) {
    const Frame frame = run.frame(k);
    const std::string file = fmt::format("{}/frame_{:06}.vtp", folder, k);
    TextOutput output(pvd.parent_path() / file, overwrite);
    print_poly_line(frame, output);
    collection.print("<DataSet timestep=\"{:.17g}\" group=\"\" part=\"0\" file=\"{}\"/>\n",
                     frame.time, escaped(file));
  }
  collection.print("</Collection>\n</VTKFile>\n");
  collection.close();
}

} // namespace ehdjet
