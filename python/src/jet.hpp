#pragma once

#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/stage.hpp"
#include "ehdjet/observers/observer.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <pybind11/numpy.h>
#include <span>
#include <string>
#include <vector>

namespace ehdjet::python {

/// A jet that Python may hold longer than the simulation keeps it: before the simulation goes on, it hands out its own
/// columns to `kept`.
struct JetOwner {
  JetState kept;
};

/// A jet at one instant, for Python. The arrays of a jet with an owner refer to its columns. Without one, the
/// columns are there for one call only, and the arrays are copies.
class Jet {
public:
  Jet(const JetState& jet, std::shared_ptr<const JetOwner> owner);
  explicit Jet(const JetSnapshot& snapshot);
  Jet(const Stage& stage, const BeadTable& table);

  /// The call is over. Whoever asks for columns from now on gets an error instead.
  void end_call() { over_ = true; }

  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] std::size_t beads() const { return state_.beads; }
  [[nodiscard]] pybind11::dict units() const;
  [[nodiscard]] pybind11::array column(const std::string& name) const;
  [[nodiscard]] pybind11::array position() const;
  [[nodiscard]] pybind11::array velocity() const;
  [[nodiscard]] pybind11::array radius() const;
  [[nodiscard]] pybind11::array landed() const;
  [[nodiscard]] pybind11::array embryo() const;

private:
  void check() const;
  [[nodiscard]] pybind11::array vectors(std::size_t first_column) const;
  [[nodiscard]] pybind11::array values(std::span<const double> column) const;
  [[nodiscard]] pybind11::array show(const double* data,
                                     std::vector<pybind11::ssize_t> shape) const;

  double time_;
  JetColumns<const double> state_;
  std::vector<std::span<const double>> carried_;
  std::shared_ptr<const BeadTable> table_;
  std::size_t first_;
  std::span<const LandedBead> landed_;
  bool acting_ = false; // the volume is what has not evaporated yet
  std::shared_ptr<const JetOwner> owner_;
  bool over_ = false;
};

} // namespace ehdjet::python
