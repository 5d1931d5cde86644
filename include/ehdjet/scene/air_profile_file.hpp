#pragma once

#include "ehdjet/forces/air_flow.hpp"

#include <filesystem>

namespace ehdjet {

/// Velocity of the air over x: CSV with the columns x_m, ux_m_s, uy_m_s, uz_m_s, x ascending.
/// errors : InputError "file:line:column: ..." for what is missing, not a number or out of order
AirProfile read_air_profile(const std::filesystem::path& file);

} // namespace ehdjet
