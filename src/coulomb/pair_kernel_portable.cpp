#include "expansions.hpp"

namespace ehdjet::detail {
namespace {

/// Two lanes, which every 64-bit processor has, and the exact root, which needs no correction.
struct Portable {
  typedef double Vector __attribute__((vector_size(16)));
  typedef long long Mask __attribute__((vector_size(16)));
  static constexpr int lanes = 2, targets = 2, vectors = 2, degree = 0;

  static Vector inverse_sqrt(Vector r2) {
    return 1.0 / Vector{__builtin_sqrt(r2[0]), __builtin_sqrt(r2[1])};
  }
  static Vector smaller(Vector a, Vector b) { return a < b ? a : b; }
  static bool any_below(Vector a, double bound) { return a[0] < bound || a[1] < bound; }
};

} // namespace

Kernels portable_kernels() {
  return {pair_kernel<Portable>(), expansion_kernel<Portable>()};
}

} // namespace ehdjet::detail
