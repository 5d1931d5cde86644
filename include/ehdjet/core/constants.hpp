#pragma once

/// Physical constants and unit factors. All quantities are in SI units; Gaussian units appear only
/// in tests and in conversions of published tables.
namespace ehdjet::constants {

/// Coulomb constant 1/(4 pi eps0) = c^2 1e-7 [N m^2/C^2]. This value, rather than the
/// CODATA-2018 one (5.4e-10 smaller), makes SI and Gaussian results agree to round-off.
inline constexpr double coulomb = 8.9875517873681764e9;

/// Standard acceleration of gravity [m/s^2] (3rd CGPM, 1901).
inline constexpr double standard_gravity = 9.80665;

/// Statcoulombs in one coulomb [statC/C], = 10 c in SI digits.
inline constexpr double statcoulomb_per_coulomb = 2.99792458e9;

/// Volts in one statvolt [V/statV], = c 1e-6 in SI digits.
inline constexpr double volt_per_statvolt = 299.792458;

} // namespace ehdjet::constants
