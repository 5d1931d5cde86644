#pragma once

#include <cstddef>

namespace ehdjet {

/// Modulus and relaxation rate of the fluid in link k: everywhere the same.
///
/// The laws of viscoelasticity take these two from a class with the members of this one, so that a
/// fluid whose properties differ from link to link is another such class and no branch.
struct UniformFluid {
  double elastic_modulus = 0; ///< G [Pa]
  double relaxation = 0;      ///< 1/tau, G/mu [1/s]

  [[nodiscard]] double modulus(std::size_t /*link*/) const { return elastic_modulus; }
  [[nodiscard]] double relaxation_rate(std::size_t /*link*/) const { return relaxation; }
  /// The scale of stresses [Pa].
  [[nodiscard]] double typical_modulus() const { return elastic_modulus; }
};

} // namespace ehdjet
