#include "callables.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/schedule.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <utility>

#include "jet.hpp"

namespace py = pybind11;

namespace ehdjet::python {
namespace {

/// "ValueError: its text", in one line.
std::string one_line(const py::error_already_set& error) {
  const auto name = error.type().attr("__name__").cast<std::string>();
  const auto text = py::str(error.value()).cast<std::string>();
  return text.empty() ? name : name + ": " + text;
}

/// Calls `body(jet)` with a jet that ends with the call.
template <class Body>
auto with_jet(Jet&& jet, const Body& body) {
  const py::object shown = py::cast(std::move(jet));
  struct End {
    Jet& jet;
    ~End() { jet.end_call(); }
  } const end{shown.cast<Jet&>()};
  return body(shown);
}

class PythonForce final : public ForceTerm {
public:
  PythonForce(std::string name, std::size_t index,
              std::shared_ptr<const Callables> callables)
      : name_(std::move(name))
      , index_(index)
      , callables_(std::move(callables)) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  void bind(const BeadTable& table) override { table_ = &table; }

  void add_force(const Stage& stage, Vec3View force) override {
    const py::gil_scoped_acquire lock;
    const auto values = call(stage);
    const auto f = values.unchecked<2>();
    const BeadRange targets = stage.targets.within(stage.beads());
    for (std::size_t k = targets.begin; k < targets.end; ++k) {
      const auto row = static_cast<py::ssize_t>(k);
      force.add(k, {f(row, 0), f(row, 1), f(row, 2)});
    }
  }

private:
  using Values = py::array_t<double, py::array::forcecast>;

  // Ctrl-C within the function must not spoil the step: it is called again, and the run ends with the step.
  Values call(const Stage& stage) const {
    try {
      return call_once(stage);
    } catch (py::error_already_set& error) {
      Attention& attention = *callables_->attention;
      if (!error.matches(PyExc_KeyboardInterrupt) || attention.stopped())
        throw CallableFailed(fmt::format("force {}", name_), std::move(error));
      attention.stop(std::move(error));
    }
    try {
      return call_once(stage);
    } catch (py::error_already_set& error) {
      throw CallableFailed(fmt::format("force {}", name_), std::move(error));
    }
  }

  [[nodiscard]] Values call_once(const Stage& stage) const {
    const py::object result = with_jet(Jet(stage, *table_), callables_->forces.at(index_));
    const auto values = Values::ensure(result);
    if (!values) throw py::error_already_set();
    if (values.ndim() == 2 && values.shape(0) == static_cast<py::ssize_t>(stage.beads())
        && values.shape(1) == 3)
      return values;
    std::string shape;
    for (py::ssize_t i = 0; i < values.ndim(); ++i)
      shape += fmt::format("{}{}", i > 0 ? ", " : "", values.shape(i));
    PyErr_SetString(PyExc_ValueError,
                    fmt::format("the force {} returned an array of shape ({}); expected is "
                                "({}, 3), in newtons",
                                name_, shape, stage.beads())
                        .c_str());
    throw py::error_already_set();
  }

  std::string name_;
  std::size_t index_;
  std::shared_ptr<const Callables> callables_;
  const BeadTable* table_ = nullptr; // of the jet, which keeps it
};

class PythonObserver final : public Observer {
public:
  PythonObserver(std::optional<double> interval, std::size_t index,
                 std::shared_ptr<const Callables> callables)
      : index_(index)
      , callables_(std::move(callables)) {
    if (interval) schedule_.emplace(*interval);
  }

  [[nodiscard]] double next_time() const override {
    return schedule_ ? schedule_->next() : Observer::next_time();
  }
  void skip_to(double time) override {
    if (schedule_) schedule_->skip_to(time);
  }
  void observe(const JetSnapshot& snapshot) override {
    call(snapshot);
    schedule_->advance();
  }
  [[nodiscard]] Interest interest() const override { return {.ends_of_steps = !schedule_}; }
  void after_step(const JetSnapshot& snapshot) override { call(snapshot); }

private:
  void call(const JetSnapshot& snapshot) const {
    const py::gil_scoped_acquire lock;
    try {
      with_jet(Jet(snapshot), callables_->observers.at(index_));
    } catch (py::error_already_set& error) {
      Attention& attention = *callables_->attention;
      if (error.matches(PyExc_KeyboardInterrupt) && !attention.stopped())
        attention.stop(std::move(error)); // at the end of the step
      else
        throw CallableFailed("an observer", std::move(error));
    }
  }

  std::optional<Schedule> schedule_;
  std::size_t index_;
  std::shared_ptr<const Callables> callables_;
};

} // namespace

CallableFailed::CallableFailed(const std::string& whose, py::error_already_set&& error)
    : error_(std::make_shared<py::error_already_set>(std::move(error)))
    , text_(std::make_shared<const std::string>(whose + ": " + one_line(*error_))) {}

Attention::Attention(py::handle progress)
    : progress_(progress) {}

const char* Attention::look(const Advance& advance) {
  const py::gil_scoped_acquire lock;
  if (!stopped_) {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (progress_ && !progress_.is_none()) progress_(advance);
    } catch (py::error_already_set& error) {
      stop(std::move(error));
    }
  }
  if (!stopped_) return nullptr;
  return reason_.c_str();
}

void Attention::stop(py::error_already_set&& error) {
  reason_ = one_line(error);
  stopped_.emplace(std::move(error));
}

void Attention::raise(const std::string& kept) {
  py::error_already_set error = std::move(*stopped_);
  stopped_.reset();
  error.value().attr("add_note")(kept);
  throw error;
}

std::vector<std::unique_ptr<ForceTerm>>
force_terms(const std::vector<std::string>& names,
            const std::shared_ptr<const Callables>& callables) {
  std::vector<std::unique_ptr<ForceTerm>> terms;
  for (const std::string& name : names)
    terms.push_back(std::make_unique<PythonForce>(name, terms.size(), callables));
  return terms;
}

std::vector<std::shared_ptr<Observer>>
observers(const std::vector<std::optional<double>>& intervals,
          const std::shared_ptr<const Callables>& callables) {
  std::vector<std::shared_ptr<Observer>> all;
  for (const auto& interval : intervals)
    all.push_back(std::make_shared<PythonObserver>(interval, all.size(), callables));
  return all;
}

} // namespace ehdjet::python
