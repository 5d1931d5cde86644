#pragma once

#include "ehdjet/run_files/run_table.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace ehdjet {

class ReadableFile; // HDF5 stays inside src/run_files

/// Reads the frames of a run file, or of another HDF5 file that has /frames/time, /frames/offset
/// and /beads as a run file has them. The run may have been killed or be still going on.
///
/// Only whole frames count: a frame is whole if its time and both its offsets are there, every
/// column of /beads reaches to its end, and all frames before it are whole.
/// errors : InputError with the path if the file is missing, no HDF5 file or damaged, or has no
///          frames
class FrameReader {
public:
  explicit FrameReader(const std::filesystem::path& path);
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const;
  [[nodiscard]] std::vector<double> frame_times() const; ///< [s]
  [[nodiscard]] Frame frame(std::size_t index) const;
  /// Index of the frame nearest to `time`; of two equally near ones the earlier. Without a time:
  /// the last one. errors : InputError if there is no frame yet
  [[nodiscard]] std::size_t nearest_frame(std::optional<double> time) const;

protected:
  std::unique_ptr<ReadableFile> file_;
};

} // namespace ehdjet
