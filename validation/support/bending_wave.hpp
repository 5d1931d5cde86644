#pragma once

#include "ehdjet/scene/read_scene.hpp"
#include "ehdjet/simulation/simulation.hpp"

#include <cstddef>
#include <vector>

/// Bending waves on a straight chain, whose growth has a closed form.
namespace ehdjet::validation {

/// A free straight chain of PVP beads, displaced sideways by cosines with phase 0 in the middle.
/// While they are small each grows by itself as cosh(s t), with (an infinite chain)
///
///     s^2 = 2 Gamma^2 C(kappa) - 4/(m l) pi a^2 alpha/l sin^2(kappa/2),   kappa = 2 pi/n,
///     C = sum_(p >= 1) (1 - cos p kappa)/p^3,   Gamma^2 = k q^2/(m l^3)
///
/// n beads per wavelength; the second term is the paper's surface tension.
class BendingWave {
public:
  /// wavelengths: n of each cosine [beads]
  explicit BendingWave(std::vector<double> wavelengths);

  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] double link_length() const;
  /// t with Gamma t = `gammas` [s]
  [[nodiscard]] double time(double gammas) const;
  [[nodiscard]] double theory(double wavelength) const; ///< s [1/s]
  /// Each cosine's amplitude over its first one, a least-squares fit to the middle 200 beads.
  [[nodiscard]] std::vector<double> growth(const JetState& jet) const;
  /// arccosh(growth)/t [1/s]
  [[nodiscard]] double growth_rate(const JetState& jet, double wavelength) const;

private:
  [[nodiscard]] double cosine(double wavelength, std::size_t bead) const;

  static constexpr std::size_t beads = 801; // odd
  static constexpr double amplitude = 1e-7; // in links

  std::vector<double> wavelengths_;
  Scene scene_;
};

} // namespace ehdjet::validation
