// Wide vectors without wide registers change how they are passed; nothing here is exported.
#pragma GCC diagnostic ignored "-Wpsabi"

#include "coulomb/all_solvers.hpp"

#include "ehdjet/coulomb/make_solver.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "coulomb/expansions.hpp"
#include "coulomb/solvers.hpp"

namespace ehdjet::detail {
namespace {

/// Lanes, tile and polynomial of the AVX-512 kernel on any processor. The estimate is cut to
/// 14 bits, the accuracy of `vrsqrt14pd`, so that the polynomial has as much to do.
struct EightLanes {
  typedef double Vector __attribute__((vector_size(64)));
  typedef long long Mask __attribute__((vector_size(64)));
  static constexpr int lanes = 8, targets = 2, vectors = 2, degree = 3;

  static Vector inverse_sqrt(const Vector& r2) {
    Vector y{};
    for (int lane = 0; lane < lanes; ++lane) {
      const double exact = 1 / std::sqrt(r2[lane]);
      std::uint64_t bits = 0;
      std::memcpy(&bits, &exact, sizeof bits);
      bits = (bits + (1ULL << 38)) & ~((1ULL << 39) - 1); // to 13 stored bits: within 2^-14
      double rounded = 0;
      std::memcpy(&rounded, &bits, sizeof bits);
      y[lane] = rounded;
    }
    return y;
  }
  static Vector smaller(const Vector& a, const Vector& b) { return a < b ? a : b; }
  static bool any_below(const Vector& a, double bound) {
    for (int lane = 0; lane < lanes; ++lane)
      if (a[lane] < bound) return true;
    return false;
  }
};

/// The same with a tile wider than a vector of targets is long, as none of ours is today.
struct FourTargets : EightLanes {
  static constexpr int targets = 4, vectors = 1;
};

template <class Simd>
std::unique_ptr<CoulombSolver> direct_sum_on() {
  return make_direct_sum_with(pair_kernel<Simd>());
}

Kernels eight_lane_kernels() {
  return {pair_kernel<EightLanes>(), expansion_kernel<EightLanes>()};
}

} // namespace
} // namespace ehdjet::detail

namespace ehdjet::test {
namespace {

template <SimdLevel level>
std::unique_ptr<CoulombSolver> direct_sum() {
  return level <= best_simd_level() ? make_direct_sum(level) : nullptr;
}

// The laws below are about each bead, whatever its charge.
constexpr char fmm[] = "fmm", treecode[] = "treecode", automatic[] = "auto";
template <const char* name, int digits>
std::unique_ptr<CoulombSolver> per_bead() {
  return make_coulomb_solver({.solver = name,
                              .tolerance = std::pow(10.0, -digits),
                              .norm = ToleranceNorm::per_bead});
}
template <auto make, auto kernels>
std::unique_ptr<CoulombSolver> with_kernels() {
  return detail::make_cluster_solver(
      kernels(),
      {.tolerance = 1e-8, .norm = ToleranceNorm::per_bead, .order = 11, .leaf = 16},
      make());
}

} // namespace

const std::vector<SolverCase>& all_solvers() {
  static const std::vector<SolverCase> cases = {
      {"direct", [] { return make_coulomb_solver({.solver = "direct"}); }},
      {"direct_portable", direct_sum<SimdLevel::portable>},
      {"direct_avx2", direct_sum<SimdLevel::avx2>},
      {"direct_avx512", direct_sum<SimdLevel::avx512>},
      {"direct_eight_lanes", detail::direct_sum_on<detail::EightLanes>},
      {"direct_four_targets", detail::direct_sum_on<detail::FourTargets>},
      {"fmm", per_bead<fmm, 6>},
      {"fmm_tight", per_bead<fmm, 11>},
      {"fmm_portable", with_kernels<detail::make_fast_multipole, detail::portable_kernels>},
      {"fmm_eight_lanes",
       with_kernels<detail::make_fast_multipole, detail::eight_lane_kernels>},
      {"treecode", per_bead<treecode, 6>},
      {"treecode_tight", per_bead<treecode, 11>},
      {"treecode_eight_lanes",
       with_kernels<detail::make_treecode, detail::eight_lane_kernels>},
      {"automatic", per_bead<automatic, 6>},
  };
  return cases;
}

} // namespace ehdjet::test
