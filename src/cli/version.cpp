#include "version.hpp"

#include "ehdjet/runs/run_scene.hpp"

#include <Eigen/Core>
#include <gsl/gsl_version.h>
#include <hdf5.h>

#include <CLI/Version.hpp>
#include <fmt/format.h>
#include <toml++/toml.h>

namespace ehdjet::cli {

std::map<std::string, std::string> environment() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  auto all = build_environment();
  all["libraries"] = fmt::format(
      "Eigen {}.{}.{}, fmt {}.{}.{}, GSL {}, HDF5 {}.{}.{}, CLI11 {}, toml++ "
      "{}.{}.{}, OpenMP {}",
      EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, FMT_VERSION / 10000,
      FMT_VERSION / 100 % 100, FMT_VERSION % 100, gsl_version, major, minor, release,
      CLI11_VERSION, TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH, _OPENMP);
  return all;
}

std::string version_text() {
  auto e = environment();
  return fmt::format(
      "ehdjet {}\ncommit     {}\ncompiler   {}, {}\nSIMD       {}\nthreads    "
      "{}\nlibraries  {}",
      e["version"], e["commit"], e["compiler"], e["build_type"], e["simd"], e["threads"],
      e["libraries"]);
}

} // namespace ehdjet::cli
