#pragma once

#include "ehdjet/core/constants.hpp"

/// Units of the published tables, in SI. Write `0.02 * cm`.
namespace ehdjet::test {

inline constexpr double cm = 1e-2, gram = 1e-3, erg = 1e-7, dyn = 1e-5;
inline constexpr double dyn_cm2 = 0.1; ///< [Pa]
inline constexpr double dyn_cm = 1e-3; ///< [N/m]
inline constexpr double poise = 0.1;   ///< [Pa s]
inline constexpr double cm3 = 1e-6;
inline constexpr double statC = 1 / constants::statcoulomb_per_coulomb;
inline constexpr double statV = constants::volt_per_statvolt;

} // namespace ehdjet::test
