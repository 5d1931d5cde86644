#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/jet/bead_range.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ehdjet {

/// Named columns of equal length from a run file, in SI units. Counts and flags are also stored as
/// doubles, which are exact up to 2^53.
struct RunTable {
  struct Column {
    std::string name, unit;
    std::vector<double> values;
  };
  std::vector<Column> columns;
  std::string origin = "the run file"; ///< where it is from, for messages

  [[nodiscard]] std::size_t rows() const {
    return columns.empty() ? 0 : columns.front().values.size();
  }
  /// Null if there is no column of that name.
  [[nodiscard]] const Column* find(std::string_view name) const;
  /// errors : InputError if there is no column of that name
  [[nodiscard]] const std::vector<double>& operator[](std::string_view name) const;
};

/// The chain at one instant, bead 0 (the nozzle) first: the columns of /beads.
struct Frame : RunTable {
  double time = 0; ///< [s]
};

class ReadableFile; // HDF5 is used only inside src/run_files

/// Reads the frames of a run file, or of another HDF5 file with /frames/time, /frames/offset and
/// /beads like those of a run file. The run may have been killed or may still be running.
///
/// Only whole frames are read. A frame is whole if the file has its time and both its offsets, if
/// every column of /beads reaches to its end, and if all frames before it are whole.
/// errors : InputError with the path if the file does not exist, is not an HDF5 file, is damaged or
///          has no frames
class FrameReader {
public:
  explicit FrameReader(const std::filesystem::path& path);
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const;
  [[nodiscard]] std::vector<double> frame_times() const; ///< [s]
  [[nodiscard]] Frame frame(std::size_t index) const;
  [[nodiscard]] std::vector<BeadRange>
  frame_rows() const; ///< of each frame in the columns of /beads
  /// Index of the frame nearest to `time` (of two equally near frames, the earlier), or of the last
  /// frame without a time. errors : InputError if there is no frame yet, or none so early or so late: the
  /// last one stands for times up to the next one that would follow it
  [[nodiscard]] std::size_t nearest_frame(std::optional<double> time) const;

protected:
  std::unique_ptr<ReadableFile> file_;
};

/// Samples of R = l_step/l along the jet.
struct ResolvingPowerTable {
  std::vector<double> lambda; ///< positions along the jet, 0 ... 1
  std::vector<double> time;   ///< of each sample [s]
  std::vector<double> r;      ///< (time * lambda), sample after sample
};

/// Reads a file that a RunFile wrote. The run may have been killed or may still be running.
///
/// errors : InputError with the path if the file does not exist, is not an HDF5 file, is truncated,
///          is not a run or has a later format version, or if it does not have the requested part
class RunReader final : public FrameReader {
public:
  explicit RunReader(const std::filesystem::path& path);

  /// A root attribute with text: "status" ("running" if the run was killed), "message", or one of
  /// the Provenance.
  [[nodiscard]] std::string attribute(const std::string& name) const;
  [[nodiscard]] bool has_attribute(const std::string& name) const;
  /// Whether a run writes the file at this moment, as far as the file system can tell.
  [[nodiscard]] bool is_being_written() const;
  /// The scene: "given" as it was read, or "resolved" with all defaults.
  [[nodiscard]] std::string scene(const std::string& form) const;
  /// The numbers of /statistics, by name; none while the run goes on and after it was killed.
  [[nodiscard]] std::map<std::string, double> statistics() const;

  /// Whether the file has a part: "observables", "frames", "deposit", "refinements", "budget" or
  /// "resolving_power".
  [[nodiscard]] bool has(const std::string& part) const;
  /// All columns of a part other than frames and resolving power, in the order that the file gives,
  /// or otherwise alphabetically.
  [[nodiscard]] RunTable table(const std::string& part) const;
  /// One column of such a part.
  [[nodiscard]] std::vector<double> column(const std::string& part,
                                           const std::string& name) const;
  [[nodiscard]] ResolvingPowerTable resolving_power() const;
  [[nodiscard]] std::optional<Checkpoint> last_checkpoint() const;
  /// The same. errors : InputError if there is none
  [[nodiscard]] Checkpoint checkpoint() const;
};

} // namespace ehdjet
