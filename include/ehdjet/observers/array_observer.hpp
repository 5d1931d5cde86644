#pragma once

#include "ehdjet/core/checkpoint.hpp"
#include "ehdjet/jet/jet_state.hpp"
#include "ehdjet/jet/ledger.hpp"
#include "ehdjet/observers/observer.hpp"

#include <cstddef>
#include <limits>
#include <span>

namespace ehdjet {

/// All jets of an array at one instant, in coordinates from the axis of the array. Nozzles and
/// embryos are at their prescribed places.
struct ArraySnapshot {
  double time = 0;                 ///< [s]
  std::span<const JetState> jets;  ///< at `time`
  std::span<const Ledger> ledgers; ///< of each jet
  const RunStatistics& statistics; ///< of all jets together

  [[nodiscard]] JetSnapshot jet(std::size_t j) const {
    return {time, jets[j].columns(), jets[j], ledgers[j], statistics};
  }
};

/// Observes the jets of an array without changing them: what Observer is for a single jet.
class ArrayObserver {
public:
  virtual ~ArrayObserver() = default;

  /// The next time at which `observe` is called, or infinity [s].
  [[nodiscard]] virtual double next_time() const {
    return std::numeric_limits<double>::infinity();
  }
  /// Called with the jets at `next_time()`, after the events at that time.
  virtual void observe(const ArraySnapshot& /*snapshot*/) {}
  /// Called when the run continues from a checkpoint: `next_time` must not be before `time` [s].
  virtual void skip_to(double /*time*/) {}
  /// What its next calls depend on, under a name of its own in `a`. It is read after `skip_to`, from the
  /// checkpoint of a run that may not have had this observer.
  virtual void archive(const Archive& /*a*/) {}
  /// Called when a bead has left jet j.
  virtual void deposit(std::size_t /*j*/, const DepositedBead& /*bead*/) {}
  /// Called after a refinement of jet j, if the run records refinements.
  virtual void refined(std::size_t /*j*/, const RefinementRecord& /*record*/) {}
  /// Called with everything that is needed to continue the run, if the run makes checkpoints.
  virtual void checkpoint(const Checkpoint& /*checkpoint*/) {}
};

} // namespace ehdjet
