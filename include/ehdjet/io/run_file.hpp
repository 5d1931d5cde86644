#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/observers/observer.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace ehdjet {

class RunWriter; // HDF5 stays inside src/io

/// What a run file says about where it came from. Written as root attributes.
struct Provenance {
  std::string scene_file, scene_given, scene_resolved;
  std::map<std::string, std::string>
      environment; ///< version, commit, compiler, simd, threads, ...
};

/// One run, one HDF5 file, written as the run goes. Layout: src/io/README.md.
///
/// Readable without this project (h5py, h5dump) and, up to the last flush, after the process
/// was killed. Only the parts that are asked for exist in the file.
/// errors : InputError if the file exists and `overwrite` is false, or cannot be created;
///          RunError if writing fails (disk full)
class RunFile {
public:
  RunFile(const std::filesystem::path& path, bool overwrite, const Provenance& provenance,
          double flush_interval);
  ~RunFile(); ///< closes; a file without `finish` keeps the status "running"
  RunFile(const RunFile&) = delete;
  RunFile& operator=(const RunFile&) = delete;

  /// Observers that write to this file; they must not outlive it. `interval` in [s].
  std::unique_ptr<Observer> observables(double interval, bool with_coulomb_error = false);
  std::unique_ptr<Observer> frames(double interval, bool with_stress);
  std::unique_ptr<Observer> deposit();
  std::unique_ptr<Observer> refinements(bool with_coulomb_energy);
  /// Rows of energy and momentum; `accounts` must outlive the observer.
  std::unique_ptr<Observer> budget(double interval, Accounts& accounts);
  /// R = link_length/l along the jet; `link_length`: l_step [m].
  std::unique_ptr<Observer> resolving_power(double interval, double link_length);

  /// Keeps each checkpoint that it is shown.
  std::unique_ptr<Observer> checkpoints();

  /// Keeps a checkpoint instead of the last one, which stays until the new one is complete, and
  /// flushes. All of a run have the same names.
  void keep(const Checkpoint& checkpoint);
  /// Makes everything written so far readable by others.
  void flush();
  /// How the Coulomb force was computed, a root attribute.
  void note_coulomb(const std::string& method);
  /// Last words: status "complete", "interrupted" or "failed", a message, the run's cost and
  /// what entered and left the jet.
  void finish(const std::string& status, const std::string& message,
              const RunStatistics& statistics, const Ledger& ledger);

private:
  std::unique_ptr<RunWriter> writer_;
};

} // namespace ehdjet
