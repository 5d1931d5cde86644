#pragma once

namespace ehdjet::cli {

/// While an object of this class exists, SIGINT, SIGTERM, SIGHUP (unless it is ignored, as under nohup) and
/// SIGXCPU are recorded instead of ending the process. A run can then stop between two steps and close its
/// file. A second SIGINT or SIGTERM ends the process at once.
class InterruptGuard {
public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Name of the signal that has arrived, or nullptr.
  [[nodiscard]] static const char* signal_name();
  /// Whether SIGUSR1 has arrived since the last call: the run is to make a checkpoint and go on.
  [[nodiscard]] static bool checkpoint_wanted();
};

} // namespace ehdjet::cli
