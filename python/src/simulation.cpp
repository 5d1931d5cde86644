#include "simulation.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/runs/run_scene.hpp"
#include "ehdjet/simulation/build.hpp"

#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <utility>

#include "bindings.hpp"

namespace py = pybind11;

namespace ehdjet::python {
namespace {

namespace fs = std::filesystem;

std::vector<py::handle> handles(const py::list& list) {
  return {list.begin(), list.end()};
}

/// Gives the terms and observers of a simulation their functions, as long as it exists. Needs the lock.
class Lent {
public:
  Lent(Callables& callables, const py::list& forces, const py::list& observers,
       Attention& attention)
      : callables_(callables) {
    callables_.forces = handles(forces), callables_.observers = handles(observers);
    callables_.attention = &attention;
  }
  ~Lent() { callables_ = {}; }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

private:
  Callables& callables_;
};

Advance advance_of(const Simulation& s, double end_time) {
  return {.time = s.jet().time,
          .end_time = end_time,
          .links = s.jet().links(),
          .statistics = s.statistics()};
}
Advance advance_of(const ArraySimulation& s, double end_time) {
  return {.time = s.time(),
          .end_time = end_time,
          .links = s.links(),
          .statistics = s.statistics()};
}

py::dict to_dict(const RunStatistics& s) {
  py::dict d;
  d["evaluations"] = s.evaluations, d["steps"] = s.steps, d["rejected"] = s.rejected;
  d["insertions"] = s.insertions, d["releases"] = s.releases, d["landings"] = s.landings;
  if (s.refinements) d["refinements"] = *s.refinements;
  if (s.method) d["method"] = std::string(s.method->in_use);
  if (s.two_rates) d["full_sums"] = s.two_rates->full_sums;
  if (s.coulomb_error) d["coulomb_error"] = *s.coulomb_error;
  d["coincident_pairs"] = s.coincident_pairs;
  d["shortest_step"] = s.shortest_step, d["longest_step"] = s.longest_step;
  d["wall_time"] = s.wall_time;
  return d;
}

py::dict to_dict(const Ledger& l) {
  py::dict d;
  d["inserted_beads"] = l.inserted_beads, d["removed_beads"] = l.removed_beads;
  const auto amount = [&](const char* name, double inserted, double removed) {
    d[py::str(fmt::format("inserted_{}", name))] = inserted;
    d[py::str(fmt::format("removed_{}", name))] = removed;
  };
  amount("mass", l.inserted_mass, l.removed_mass);
  amount("charge", l.inserted_charge, l.removed_charge);
  amount("volume", l.inserted_volume, l.removed_volume);
  d["release_speed"] = l.release_speed, d["impact_speed"] = l.impact_speed;
  d["collector_radius"] = l.collector_radius;
  return d;
}

/// What a run is told besides its scene and its file.
struct RunArguments {
  bool overwrite;
  std::optional<std::size_t> threads;
  std::optional<fs::path> continue_from;
  std::string scene_file;
  std::vector<std::string> force_names;
  std::vector<std::optional<double>> intervals;
};

void run(const Scene& scene, const fs::path& output, const RunArguments& arguments,
         const py::list& forces, const py::list& observing, const py::object& progress) {
  Attention attention(progress);
  const auto callables = std::make_shared<Callables>();
  const Lent lent(*callables, forces, observing, attention);
  RunOptions options;
  options.overwrite = arguments.overwrite, options.threads = arguments.threads;
  options.continue_from = arguments.continue_from;
  options.scene_file = arguments.scene_file;
  options.extras.forces = force_terms(arguments.force_names, callables);
  options.extras.observers = observers(arguments.intervals, callables);
  const double end_time = scene.config.run.end_time;
  std::function<Advance()> advance;
  const auto started = [&](auto& simulation) {
    advance = [&simulation, end_time] { return advance_of(simulation, end_time); };
  };
  options.started = started, options.array_started = started;
  options.interrupted = [&] { return attention.reason_to_stop(advance); };

  const std::string kept = fmt::format("everything up to then is in {}", output.string());
  RunResult result;
  try {
    const py::gil_scoped_release unlocked;
    result = run_scene(scene, output, std::move(options));
  } catch (const CallableFailed& e) {
    e.error().value().attr("add_note")(fmt::format("{}; {}", e.what(), kept));
    throw;
  }
  if (attention.stopped()) attention.raise(fmt::format("{}; {}", result.message, kept));
}

} // namespace

PythonSimulation::PythonSimulation(const Scene& scene, std::optional<std::size_t> threads,
                                   const std::vector<std::string>& forces,
                                   const std::vector<std::optional<double>>& observing)
    : threads_(threads ? threads : scene.config.run.threads) {
  Extras extras;
  extras.forces = force_terms(forces, callables_);
  extras.observers = observers(observing, callables_);
  const ThreadCount count(threads_);
  simulation_ = build_simulation(scene, std::move(extras));
}

PythonSimulation::~PythonSimulation() {
  keep_views();
}

void PythonSimulation::check_idle() const {
  if (state_ == State::running)
    throw std::runtime_error(
        "the simulation is running: a force or an observer sees the jet "
        "that it is called with");
}

// Arrays that somebody still has keep the columns to which they refer.
void PythonSimulation::keep_views() {
  if (const auto owner = viewed_.lock()) owner->kept = simulation_->hand_out_jet();
  viewed_.reset();
}

template <class Advancing>
void PythonSimulation::advance(double end_time, const py::list& forces,
                               const py::list& observing, py::handle progress,
                               const Advancing& advancing) {
  check_idle();
  if (state_ == State::failed)
    throw std::runtime_error(
        "the simulation has failed and cannot go on; Simulation.jet is "
        "the jet after its last step");
  keep_views();
  Attention attention(progress);
  const Lent lent(*callables_, forces, observing, attention);
  state_ = State::running;
  try {
    const py::gil_scoped_release unlocked;
    const ThreadCount count(threads_);
    advancing([&] {
      return attention.reason_to_stop([&] { return advance_of(*simulation_, end_time); });
    });
  } catch (...) {
    state_ = State::failed;
    throw;
  }
  state_ = State::idle;
  if (attention.stopped())
    attention.raise(fmt::format("stopped at t = {:.9g} s; the simulation can go on",
                                simulation_->jet().time));
}

void PythonSimulation::run_until(double end_time, const py::list& forces,
                                 const py::list& observing, const py::object& progress) {
  advance(end_time, forces, observing, progress, [&](const auto& reason_to_stop) {
    while (reason_to_stop() == nullptr && simulation_->step(end_time)) {
    }
  });
}

bool PythonSimulation::step(double end_time, const py::list& forces,
                            const py::list& observing) {
  bool stepped = false;
  advance(end_time, forces, observing, py::none(),
          [&](const auto& /*reason_to_stop*/) { stepped = simulation_->step(end_time); });
  return stepped;
}

double PythonSimulation::time() const {
  check_idle();
  return simulation_->jet().time;
}

Jet PythonSimulation::jet() {
  check_idle();
  auto owner = viewed_.lock();
  if (!owner) {
    owner = std::make_shared<JetOwner>();
    viewed_ = owner;
  }
  return {simulation_->jet(), std::move(owner)};
}

py::dict PythonSimulation::statistics() const {
  check_idle();
  RunStatistics statistics = simulation_->statistics();
  statistics.coincident_pairs = simulation_->dynamics().coincident_pairs();
  return to_dict(statistics);
}

py::dict PythonSimulation::ledger() const {
  check_idle();
  return to_dict(simulation_->ledger());
}

void bind_simulation(py::module_& module) {
  py::class_<Advance>(module, "Advance", "How far a run has got.")
      .def_readonly("time", &Advance::time, "Simulated time [s].")
      .def_readonly("end_time", &Advance::end_time, "End of the run [s].")
      .def_readonly("links", &Advance::links,
                    "Links of the jet, or of all jets of an array.")
      .def_property_readonly(
          "statistics", [](const Advance& a) { return to_dict(a.statistics); },
          "Cost so far, by name.");

  module.def(
      "run",
      [](const Scene& scene, const fs::path& output, bool overwrite,
         std::optional<std::size_t> threads, std::optional<fs::path> continue_from,
         const std::string& scene_file, const std::vector<std::string>& force_names,
         const py::list& forces, const std::vector<std::optional<double>>& intervals,
         const py::list& observing, const py::object& progress) {
        run(scene, output,
            {.overwrite = overwrite,
             .threads = threads,
             .continue_from = std::move(continue_from),
             .scene_file = scene_file,
             .force_names = force_names,
             .intervals = intervals},
            forces, observing, progress);
      },
      py::arg("scene"), py::arg("output"), py::arg("overwrite"), py::arg("threads"),
      py::arg("continue_from"), py::arg("scene_file"), py::arg("force_names"),
      py::arg("forces"), py::arg("intervals"), py::arg("observers"), py::arg("progress"));

  py::class_<PythonSimulation>(module, "Simulation")
      .def(py::init<const Scene&, std::optional<std::size_t>,
                    const std::vector<std::string>&,
                    const std::vector<std::optional<double>>&>(),
           py::arg("scene"), py::arg("threads"), py::arg("force_names"),
           py::arg("intervals"))
      .def("run_until", &PythonSimulation::run_until, py::arg("end_time"),
           py::arg("forces"), py::arg("observers"), py::arg("progress"))
      .def("step", &PythonSimulation::step, py::arg("end_time"), py::arg("forces"),
           py::arg("observers"))
      .def_property_readonly("time", &PythonSimulation::time)
      .def_property_readonly("jet", &PythonSimulation::jet)
      .def_property_readonly("statistics", &PythonSimulation::statistics)
      .def_property_readonly("ledger", &PythonSimulation::ledger);
}

} // namespace ehdjet::python
