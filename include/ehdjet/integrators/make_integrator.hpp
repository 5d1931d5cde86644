#pragma once

#include "ehdjet/integrators/error_scale.hpp"
#include "ehdjet/integrators/integrator.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace ehdjet {

/// How a method gets from step to step.
enum class MethodKind {
  chooses, ///< by itself between an explicit and an implicit method
  explicit_steps,
  implicit_steps
};

struct IntegratorDescription {
  std::string_view name;        ///< as in a scene
  std::string_view description; ///< one line, with its source
  MethodKind kind;
  bool estimates_errors; ///< if not, it needs fixed steps
};

/// All methods, in the order in which they are documented.
[[nodiscard]] std::span<const IntegratorDescription> integration_methods();
/// errors : InputError that lists the known names, for a name that is not among them
[[nodiscard]] const IntegratorDescription& integration_method(std::string_view name);
std::unique_ptr<Integrator> make_integrator(std::string_view name, const ErrorScale& scale);

} // namespace ehdjet
