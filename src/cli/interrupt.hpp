#pragma once

namespace ehdjet::cli {

/// While an object of this class exists, SIGINT and SIGTERM are recorded instead of ending the
/// process. A run can then stop between two steps and close its file. A second signal ends the
/// process at once.
class InterruptGuard {
public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Name of the signal that has arrived, or nullptr.
  [[nodiscard]] static const char* signal_name();
};

} // namespace ehdjet::cli
