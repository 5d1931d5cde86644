#include "ehdjet/scene/air_profile_file.hpp"

#include "ehdjet/core/csv_table.hpp"
#include "ehdjet/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace ehdjet {

AirProfile read_air_profile(const std::filesystem::path& file) {
  if (const std::ifstream in(file); !in || std::filesystem::is_directory(file))
    throw InputError(fmt::format("cannot read the wind {} (air.profile): {}", file.string(),
                                 in ? "it is a folder" : std::strerror(errno)));
  CsvTable table(file, {"x_m", "ux_m_s", "uy_m_s", "uz_m_s"}, {});
  AirProfile profile;
  while (table.next_row()) {
    const double x = table.value(0);
    if (!profile.x.empty() && !(x > profile.x.back()))
      table.refuse(table.start(0),
                   fmt::format("x_m = {}: must be greater than {}, that of the row before",
                               x, profile.x.back()));
    profile.x.push_back(x);
    profile.ux.push_back(table.value(1));
    profile.uy.push_back(table.value(2));
    profile.uz.push_back(table.value(3));
  }
  if (profile.x.empty())
    throw InputError(file.string()
                     + ": no row below the header; the air has a velocity at "
                       "one place at least");
  return profile;
}

} // namespace ehdjet
