#pragma once

#include "ehdjet/core/columns.hpp"

#include <cstddef>
#include <span>
#include <vector>

#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// The charges of one call as the kernels want them, and the fields that they gather, one set per
/// thread. Coordinates and charges are scaled by powers of two, which change no digit, so that
/// nothing overflows whatever the units; kernels skip close pairs, which are added here from the
/// original coordinates, or counted as coincident.
class ScaledCharges {
public:
  explicit ScaledCharges(std::size_t targets_per_tile)
      : tile_(targets_per_tile) {}

  /// Room for n charges and the fields of so many threads; allocates only if there was less.
  void reserve(std::size_t n, std::size_t threads);
  void load(ConstVec3View r, std::span<const double> q);

  [[nodiscard]] std::size_t size() const { return size_; }              ///< n
  [[nodiscard]] std::size_t length() const { return lines_ * padding; } ///< of the columns
  [[nodiscard]] ChargeColumns columns() {
    return {column(0), column(1), column(2), column(3)};
  }
  [[nodiscard]] FieldColumns field(std::size_t thread);
  void clear_field(std::size_t thread);
  [[nodiscard]] unsigned char* close() { return close_.data(); }
  /// What a field of these columns is multiplied with, squared, to be in SI units but for k_C.
  [[nodiscard]] double root_unscale() const { return root_unscale_; }

  /// A sum of q q/|r - r| of these columns in SI units, k_C included [J].
  [[nodiscard]] double energy(double scaled) const;

  /// force += k_C q times the sum of the fields of `team` threads, for charges [begin, end).
  void add_forces(std::size_t team, std::size_t begin, std::size_t end, Vec3View force);
  /// What the kernels have skipped. Returns the number of coincident pairs.
  std::size_t add_close_pairs(ConstVec3View r, std::span<const double> q, Vec3View force);

private:
  struct alignas(64) CacheLine {
    double value[8];
  };
  static_assert(sizeof(CacheLine) / sizeof(double) == padding);
  [[nodiscard]] double* column(std::size_t k) { return charges_[k * lines_].value; }

  std::size_t tile_, size_ = 0, lines_ = 0; ///< lines_: cache lines per column
  double root_unscale_ = 1;
  int energy_exponent_ = 0;          ///< energies of these columns are larger by 2^-this
  std::vector<CacheLine> charges_;   ///< x, y, z, q
  std::vector<CacheLine> fields_;    ///< x, y, z of each thread
  std::vector<unsigned char> close_; ///< per tile of targets
};

} // namespace ehdjet::detail
