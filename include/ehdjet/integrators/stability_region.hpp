#pragma once

#include "ehdjet/integrators/butcher_tableau.hpp"

#include <complex>

namespace ehdjet {

/// R(z): what a step of the method multiplies y by if y' = s y and z = s h.
[[nodiscard]] std::complex<double> amplification(const ButcherTableau& method,
                                                 std::complex<double> z);

/// Longest step h for which the method damps y' = s y (or keeps it), |R(s h)| <= 1. Infinite for
/// s = 0. `s` does not grow: its real part is at most 0.
[[nodiscard]] double longest_stable_step(const ButcherTableau& method,
                                         std::complex<double> s);

} // namespace ehdjet
