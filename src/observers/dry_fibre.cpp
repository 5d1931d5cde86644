#include "ehdjet/observers/dry_fibre.hpp"

#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ehdjet {

DryFibre::DryFibre(std::shared_ptr<const BeadTable> table, double from)
    : table_(std::move(table))
    , from_(from) {
  EHDJET_EXPECTS(table_->drying());
}

void DryFibre::deposit(const DepositedBead& d) {
  if (d.time < from_ || !(d.radius > 0)) return;
  const BeadTable::DryingColumn& drying = *table_->drying();
  const double lost = column_values(d.bead, *table_)[drying.column];
  const double length =
      d.bead.volume * (1 - lost) / (std::numbers::pi * d.radius * d.radius);
  const double diameter = 2 * d.radius * std::sqrt(drying.dry / (1 - lost));
  length_ += length, diameter_ += length * diameter;
  square_ += length * diameter * diameter;
  evaporated_ += length * lost, speed_ += length * d.bead.velocity.norm();
}

void DryFibre::archive(const Archive& a) {
  const Archive own = a.part("dry_fibre");
  if (a.is_reading() && own.names().empty()) return;
  own("from", from_), own("length", length_), own("diameter", diameter_);
  own("square", square_), own("evaporated", evaporated_), own("speed", speed_);
}

std::optional<DryFibre::Summary> DryFibre::summary() const {
  if (!(length_ > 0)) return std::nullopt;
  const double mean = diameter_ / length_;
  return Summary{.since = from_,
                 .diameter = mean,
                 .scatter = std::sqrt(std::max(square_ / length_ - mean * mean, 0.0)),
                 .evaporated = evaporated_ / length_,
                 .speed = speed_ / length_,
                 .length = length_};
}

} // namespace ehdjet
