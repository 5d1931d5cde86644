#pragma once

#include <cstddef>

#include "expansion_tables.hpp"
#include "pair_kernel.hpp"

namespace ehdjet {
enum class SimdLevel;

namespace detail {

/// The operators of a fast multipole method on coefficient sets (expansion_tables.hpp), compiled
/// once per instruction set. Each vector lane treats a different cluster.
///
/// The coordinates of expansions are those of the charge columns times `unit`, and the charges are
/// those of the columns. Nothing can overflow in any unit of the user.
struct ExpansionKernel {
  static constexpr double unit = 1 / 0x1p57;
  static constexpr std::size_t most_lanes = 8;

  /// One pair of clusters per lane, and the vector from the first to the second centre.
  struct Batch {
    /// Coefficients of the first and the second cluster, with padding as in Expansions::set.
    const double* from[2][most_lanes];
    double* to[2][most_lanes]; ///< the results are added here
    double dx[most_lanes], dy[most_lanes], dz[most_lanes];
  };

  std::size_t lanes;
  /// multipole = sum over charges [begin, end) of q R(r - centre). `begin` is a multiple of
  /// `padding`, `end` need not be.
  void (*charges_to_multipole)(const ExpansionNumbers&, const ChargeColumns&,
                               std::size_t begin, std::size_t end, const double* centre,
                               double* multipole);
  /// Adds the field of a local expansion at charges [begin, end), multiples of `padding`.
  void (*local_to_charges)(const ExpansionNumbers&, const ChargeColumns&, FieldColumns,
                           std::size_t begin, std::size_t end, const double* centre,
                           const double* local);
  /// For both directions of a pair: to[1] += local expansion of from[0], to[0] += that of from[1].
  void (*multipoles_to_locals)(const ExpansionNumbers&, const Batch&);
  /// to[0] += from[0] shifted from the first to the second centre.
  void (*shift_multipoles)(const ExpansionNumbers&, const Batch&);
  void (*shift_locals)(const ExpansionNumbers&, const Batch&);
  /// Computes the gradient of a multipole, 3 (p+2)^2 numbers, for `multipole_to_charges`.
  void (*multipole_gradient)(const ExpansionNumbers&, const double* multipole,
                             double* gradient);
  /// Adds the field of a multipole at charges [begin, end), multiples of `padding`.
  void (*multipole_to_charges)(const ExpansionNumbers&, const ChargeColumns&, FieldColumns,
                               std::size_t begin, std::size_t end, const double* centre,
                               const double* gradient);
  /// Sum of q times the potential of a multipole over charges [begin, end), multiples of `padding`.
  double (*energy_in_multipole)(const ExpansionNumbers&, const ChargeColumns&,
                                std::size_t begin, std::size_t end, const double* centre,
                                const double* multipole);
};

/// The kernels of one instruction set.
struct Kernels {
  PairKernel pairs;
  ExpansionKernel expansions;
};

Kernels portable_kernels();
Kernels avx2_kernels();
Kernels avx512_kernels();

/// errors : ContractViolation if this processor does not have the instruction set
Kernels kernels_of(SimdLevel level);

} // namespace detail
} // namespace ehdjet
