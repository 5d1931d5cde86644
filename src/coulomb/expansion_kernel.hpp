#pragma once

#include <cstddef>

#include "expansion_tables.hpp"
#include "pair_kernel.hpp"

namespace ehdjet::detail {

/// The operators of a fast multipole method on coefficient sets (expansion_tables.hpp), compiled
/// once per instruction set. Several clusters are worked on at once, one per vector lane.
///
/// Coordinates of expansions are those of the charge columns times `unit`, charges are theirs:
/// nothing overflows whatever the user's units.
struct ExpansionKernel {
  static constexpr double unit = 1 / 0x1p57;
  static constexpr std::size_t most_lanes = 8;

  /// Pointers of one batch, and the vector from the first to the second centre.
  struct Batch {
    const double* from[2][most_lanes]; ///< coefficients of the first and the second cluster
    double* to[2][most_lanes];         ///< added to
    double dx[most_lanes], dy[most_lanes], dz[most_lanes];
  };

  std::size_t lanes;
  /// multipole = sum over charges [begin, end) of q R(r - centre). `begin` is a multiple of
  /// `padding`; the charges up to the next multiple of it behind `end` are padding or another
  /// cluster's and do not count.
  void (*charges_to_multipole)(const ExpansionNumbers&, const ChargeColumns&,
                               std::size_t begin, std::size_t end, const double* centre,
                               double* multipole);
  /// field += that of the local expansion, at charges [begin, end), begin and end multiples of
  /// `padding`.
  void (*local_to_charges)(const ExpansionNumbers&, const ChargeColumns&, FieldColumns,
                           std::size_t begin, std::size_t end, const double* centre,
                           const double* local);
  /// to[1] += local expansion of from[0], to[0] += that of from[1]: both sides of a pair.
  void (*multipoles_to_locals)(const ExpansionNumbers&, const Batch&);
  /// to[0] += from[0] moved from the first to the second centre.
  void (*shift_multipoles)(const ExpansionNumbers&, const Batch&);
  void (*shift_locals)(const ExpansionNumbers&, const Batch&);
  /// What `multipole_to_charges` needs of a multipole: 3 (p+2)^2 numbers.
  void (*multipole_gradient)(const ExpansionNumbers&, const double* multipole,
                             double* gradient);
  /// field += that of a multipole, at charges [begin, end), multiples of `padding`.
  void (*multipole_to_charges)(const ExpansionNumbers&, const ChargeColumns&, FieldColumns,
                               std::size_t begin, std::size_t end, const double* centre,
                               const double* gradient);
  /// Sum over charges [begin, end), multiples of `padding`, of q times the potential of a
  /// multipole.
  double (*energy_in_multipole)(const ExpansionNumbers&, const ChargeColumns&,
                                std::size_t begin, std::size_t end, const double* centre,
                                const double* multipole);
};

ExpansionKernel portable_expansion_kernel();
ExpansionKernel avx2_expansion_kernel();
ExpansionKernel avx512_expansion_kernel();

} // namespace ehdjet::detail
