#pragma once

#include "ehdjet/coulomb/cost_model.hpp"

#include <filesystem>
#include <string>

namespace ehdjet {

/// Costs of the Coulomb solvers as `ehdjet calibrate` has measured them (TOML).
/// errors : InputError naming file and key for what is missing, not a number or not positive
CostModel read_calibration(const std::filesystem::path& file);

/// The same as text, with where it was measured as a comment.
std::string calibration_text(const CostModel& model, const std::string& comment);

} // namespace ehdjet
