#pragma once

#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "callables.hpp"
#include "jet.hpp"

namespace ehdjet::python {

/// A simulation whose loop Python has in its hands.
///
/// Nobody but the loop may look at the jet while it runs, and a jet whose step was cut off by an exception is not run on.
class PythonSimulation {
public:
  PythonSimulation(const Scene& scene, std::optional<std::size_t> threads,
                   const std::vector<std::string>& forces,
                   const std::vector<std::optional<double>>& observers);
  ~PythonSimulation();
  PythonSimulation(const PythonSimulation&) = delete;
  PythonSimulation& operator=(const PythonSimulation&) = delete;

  /// `forces`, `observers`: the functions, in the order of the constructor.
  void run_until(double end_time, const pybind11::list& forces,
                 const pybind11::list& observers, const pybind11::object& progress);
  /// False: the jet is there already.
  bool step(double end_time, const pybind11::list& forces, const pybind11::list& observers);

  [[nodiscard]] double time() const;
  [[nodiscard]] Jet jet();
  [[nodiscard]] pybind11::dict statistics() const;
  [[nodiscard]] pybind11::dict ledger() const;

private:
  enum class State { idle, running, failed };

  void check_idle() const;
  void keep_views();
  template <class Advancing>
  void advance(double end_time, const pybind11::list& forces,
               const pybind11::list& observers, pybind11::handle progress,
               const Advancing& advancing);

  std::shared_ptr<Callables> callables_ = std::make_shared<Callables>();
  std::unique_ptr<Simulation> simulation_;
  std::optional<std::size_t> threads_;
  std::weak_ptr<JetOwner> viewed_; // arrays that refer to the jet of the simulation
  State state_ = State::idle;
};

} // namespace ehdjet::python
