#pragma once

#include "ehdjet/run_files/run_reader.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace ehdjet {

/// A gnuplot script that draws what the run file has on one page: the frame nearest to `time`
/// (the last one by default) from the side and along the axis, and observables over time.
///
/// errors : InputError if `output` does not end in .png, .svg or .pdf, or if there is nothing to
///          draw
std::string plot_page(const RunReader& run, std::optional<double> time,
                      const std::filesystem::path& output);

} // namespace ehdjet
