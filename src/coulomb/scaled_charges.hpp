#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "close_pairs.hpp"
#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// Whether a group is empty, so that there are no forces.
/// errors : ContractViolation if sizes differ or a group has 2^30 charges
bool nothing_to_do(std::span<const PointCharges> groups, const Vec3View& force);

/// The charges of one call in the form that the kernels need, and one set of fields per thread.
/// Coordinates and charges are scaled by powers of two, which is exact and prevents overflow in any
/// unit. This class adds the forces of close pairs, which the kernels skip, from the original
/// coordinates, and counts coincident pairs.
///
/// There is one group of charges that act on each other, or a group of sources followed by a group
/// of targets. The order of the charges in a group may differ from the caller's order.
class ScaledCharges {
public:
  /// Charges [begin, begin + n) of the columns, then padding up to `end`.
  struct Group {
    PointCharges charges;
    std::size_t begin = 0, end = 0;
    std::span<const std::uint32_t> order = {}; ///< caller's indices; empty: the same order
  };

  /// Copies the groups. Allocates only if the memory is too small for them and the fields.
  void load(std::span<const PointCharges> groups, std::size_t threads,
            bool with_moves = false);
  /// Changes the order of a group. `order` must exist until the forces have been added.
  void reorder(std::size_t group, std::span<const std::uint32_t> order);

  [[nodiscard]] const Group& sources() const { return groups_[0]; }
  [[nodiscard]] const Group& targets() const { return groups_[number_ - 1]; }
  /// Of coordinates and charges. Powers of two.
  [[nodiscard]] std::pair<double, double> scales() const { return {scale_, charge_scale_}; }
  [[nodiscard]] std::size_t length() const { return lines_ * padding; } ///< of the columns
  [[nodiscard]] ChargeColumns columns() const {
    return {column(0), column(1), column(2), column(3)};
  }
  /// Whether each charge moves; null if all move or `load` was called without `with_moves`.
  [[nodiscard]] const std::uint8_t* moves() const {
    return any_rests_ ? moves_.data() : nullptr;
  }
  [[nodiscard]] FieldColumns field(std::size_t thread);
  void clear_field(std::size_t thread);
  [[nodiscard]] unsigned char* close() { return close_.data(); }

  /// Converts a sum of q q/|r - r| of these columns to SI units, including k_C [J].
  [[nodiscard]] double energy(double scaled) const;

  /// force += k_C q times the sum of the fields of `team` threads, for targets [begin, end).
  void add_forces(std::size_t team, std::size_t begin, std::size_t end, Vec3View force);
  /// Adds the forces of close pairs if the kernels have met any, or if `met_coincident`. Returns the
  /// number of coincident pairs.
  std::size_t add_close_pairs(Vec3View force, bool met_coincident = false);

private:
  [[nodiscard]] double* column(std::size_t k) { return charges_[k * lines_].value; }
  [[nodiscard]] const double* column(std::size_t k) const {
    return charges_[k * lines_].value;
  }
  void fill(const Group& group);

  std::array<Group, 2> groups_;
  std::size_t number_ = 1, lines_ = 0; ///< number of groups; cache lines per column
  double scale_ = 1, charge_scale_ = 1, root_unscale_ = 1;
  int energy_exponent_ = 0;          ///< SI energies are those of the columns times 2^this
  std::vector<CacheLine> charges_;   ///< x, y, z, q
  std::vector<CacheLine> fields_;    ///< x, y, z of each thread
  std::vector<unsigned char> close_; ///< per tile of targets
  std::vector<std::uint8_t> moves_;
  bool any_rests_ = false;
  ClosePairs close_pairs_;
};

} // namespace ehdjet::detail
