#pragma once

#include "ehdjet/forces/force_term.hpp"
#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/observers/observer.hpp"

#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

/// Python functions within a run: forces, observers, progress, Ctrl-C. A run does not hold the lock of the interpreter;
/// what calls Python takes it for the call.
namespace ehdjet::python {

/// A Python function has raised. The Python error goes through the C++ code in this.
class CallableFailed final : public std::exception {
public:
  CallableFailed(const std::string& whose, pybind11::error_already_set&& error);
  [[nodiscard]] const char* what() const noexcept override { return text_->c_str(); }
  [[nodiscard]] pybind11::error_already_set& error() const { return *error_; }

private:
  // Shared, because exceptions are copied where nobody holds the lock.
  std::shared_ptr<pybind11::error_already_set> error_;
  std::shared_ptr<const std::string> text_;
};

/// How far a run has got.
struct Advance {
  double time = 0, end_time = 0; // [s]
  std::size_t links = 0;
  RunStatistics statistics;
};

/// Looks several times per second whether Python has a signal to handle (Ctrl-C), and tells it how far the run is.
class Attention {
public:
  /// `progress`: None, or a function of an `Advance`. Both are borrowed.
  explicit Attention(pybind11::handle progress);
  /// To be called between steps. The reason to stop the run, or nullptr.
  template <class MakeAdvance>
  const char* reason_to_stop(const MakeAdvance& advance) {
    const auto now = Clock::now();
    if (now < next_ && !stopped_) return nullptr;
    next_ = now + interval;
    return look(advance());
  }
  /// Stops the run between two steps, and not within one, because of an exception that is none of the run's.
  void stop(pybind11::error_already_set&& error);
  [[nodiscard]] bool stopped() const { return stopped_.has_value(); }
  /// Raises the exception that stopped the run, with a text on what has been kept. Needs the lock.
  [[noreturn]] void raise(const std::string& kept);

private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds interval{50};
  const char* look(const Advance& advance);

  pybind11::handle progress_;
  Clock::time_point next_ = Clock::now() + interval;
  std::optional<pybind11::error_already_set> stopped_;
  std::string reason_;
};

/// The functions of one call of `run` or `run_until`, which own them. Terms and observers find them here: they never
/// own a Python object, so that Python's garbage collector sees all references.
struct Callables {
  std::vector<pybind11::handle> forces, observers;
  Attention* attention = nullptr;
};

/// `forces` names, `observers` intervals [s]; none: at the end of each step.
std::vector<std::unique_ptr<ForceTerm>>
force_terms(const std::vector<std::string>& names,
            const std::shared_ptr<const Callables>& callables);
std::vector<std::shared_ptr<Observer>>
observers(const std::vector<std::optional<double>>& intervals,
          const std::shared_ptr<const Callables>& callables);

} // namespace ehdjet::python
