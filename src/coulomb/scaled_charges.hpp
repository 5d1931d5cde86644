#pragma once

#include "ehdjet/coulomb/solver.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "close_pairs.hpp"
#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// Whether there is nobody to act on anybody.
/// errors : ContractViolation for sizes that differ, or 2^30 charges
bool nothing_to_do(std::span<const PointCharges> groups, const Vec3View& force);

/// The charges of one call as the kernels want them, and the fields that they gather, one set per
/// thread. Coordinates and charges are scaled by powers of two, which change no digit, so that
/// nothing overflows whatever the units; kernels skip close pairs, which are added here from the
/// original coordinates, or counted as coincident.
///
/// One group of charges that act on each other, or sources and behind them targets. The charges of
/// a group may be in another order than the caller's.
class ScaledCharges {
public:
  /// Charges [begin, begin + n) of the columns, then padding up to `end`.
  struct Group {
    PointCharges charges;
    std::size_t begin = 0, end = 0;
    std::span<const std::uint32_t> order = {}; ///< caller's number of each; empty: the same
  };

  /// Takes over the groups, with room for the fields of so many threads; allocates only if there
  /// was less.
  void load(std::span<const PointCharges> groups, std::size_t threads,
            bool with_moves = false);
  /// Brings a group into another order, which must live until the forces are added.
  void reorder(std::size_t group, std::span<const std::uint32_t> order);

  [[nodiscard]] const Group& sources() const { return groups_[0]; }
  [[nodiscard]] const Group& targets() const { return groups_[number_ - 1]; }
  [[nodiscard]] std::size_t length() const { return lines_ * padding; } ///< of the columns
  [[nodiscard]] ChargeColumns columns() const {
    return {column(0), column(1), column(2), column(3)};
  }
  /// Which charges move, null: all do, or nobody wants to know.
  [[nodiscard]] const std::uint8_t* moves() const {
    return any_rests_ ? moves_.data() : nullptr;
  }
  [[nodiscard]] FieldColumns field(std::size_t thread);
  void clear_field(std::size_t thread);
  [[nodiscard]] unsigned char* close() { return close_.data(); }

  /// A sum of q q/|r - r| of these columns in SI units, k_C included [J].
  [[nodiscard]] double energy(double scaled) const;

  /// force += k_C q times the sum of the fields of `team` threads, for targets [begin, end).
  void add_forces(std::size_t team, std::size_t begin, std::size_t end, Vec3View force);
  /// What the kernels have skipped; of pairs of one place `met_coincident` may know of more.
  /// Returns the number of coincident pairs.
  std::size_t add_close_pairs(Vec3View force, bool met_coincident = false);

private:
  struct alignas(64) CacheLine {
    double value[8];
  };
  static_assert(sizeof(CacheLine) / sizeof(double) == padding);
  [[nodiscard]] double* column(std::size_t k) { return charges_[k * lines_].value; }
  [[nodiscard]] const double* column(std::size_t k) const {
    return charges_[k * lines_].value;
  }
  void fill(const Group& group);

  std::array<Group, 2> groups_;
  std::size_t number_ = 1, lines_ = 0; ///< of groups; cache lines per column
  double scale_ = 1, charge_scale_ = 1, root_unscale_ = 1;
  int energy_exponent_ = 0;          ///< energies of these columns are larger by 2^-this
  std::vector<CacheLine> charges_;   ///< x, y, z, q
  std::vector<CacheLine> fields_;    ///< x, y, z of each thread
  std::vector<unsigned char> close_; ///< per tile of targets
  std::vector<std::uint8_t> moves_;
  bool any_rests_ = false;
  ClosePairs close_pairs_;
};

} // namespace ehdjet::detail
