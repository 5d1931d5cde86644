#pragma once

#include "ehdjet/observers/observer.hpp"

#include <memory>
#include <optional>

namespace ehdjet {

/// The fibre that a drying jet has laid down: means over its length (model 2.2).
class DryFibre final : public Observer {
public:
  /// Of beads that land from `from` on [s], of a jet whose table says what evaporates.
  DryFibre(std::shared_ptr<const BeadTable> table, double from);
  void deposit(const DepositedBead& bead) override;
  void archive(const Archive& a) override;

  struct Summary {
    double since = 0;      ///< of beads that landed from then on [s]
    double diameter = 0;   ///< dry [m]
    double scatter = 0;    ///< its standard deviation [m]
    double evaporated = 0; ///< of the volume at the nozzle, at the landing [-]
    double speed = 0;      ///< at the landing [m/s]
    double length = 0;     ///< of the fibre [m]
  };
  /// None if nothing has landed.
  [[nodiscard]] std::optional<Summary> summary() const;

private:
  std::shared_ptr<const BeadTable> table_;
  double from_;
  // Sums over the links, weighted with their lengths.
  double length_ = 0, diameter_ = 0, square_ = 0, evaporated_ = 0, speed_ = 0;
};

} // namespace ehdjet
