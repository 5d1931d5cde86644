#include "suite.hpp"

#include "ehdjet/core/version.hpp"
#include "ehdjet/coulomb/simd_level.hpp"

#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <fmt/chrono.h>
#include <fstream>
#include <system_error>
#include <thread>

namespace ehdjet::validation {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view checks_header = "program,check,value,bound,passed";

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::vector<std::pair<std::string, std::string>> environment(const Suite::Options& o) {
  const auto now = std::chrono::system_clock::now();
  return {{"ehdjet", version::number},
          {"commit", version::commit},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                               fmt::gmtime(std::chrono::system_clock::to_time_t(now)))},
          {"compiler", fmt::format("{}, {}", version::compiler, version::build_type)},
          {"processor", processor()},
          {"simd", std::string(name_of(best_simd_level()))},
          {"threads", fmt::format("{}", omp_get_max_threads())},
          {"effort", o.full ? "full" : "quick"}};
}

std::string provenance_of(const Suite::Options& o) {
  std::string text = fmt::format("# program: {}\n", o.program);
  for (const auto& [key, value] : environment(o))
    text += fmt::format("# {}: {}\n", key, value);
  return text;
}

void write_environment(const Suite::Options& o) {
  std::ofstream out(o.folder / "environment.csv");
  out << "key,value\n";
  for (auto [key, value] : environment(o)) {
    std::ranges::replace(value, ',', ';');
    out << key << ',' << value << '\n';
  }
}

/// The checks of other programs, to be kept.
std::string other_checks(const fs::path& file, const std::string& program) {
  std::string text;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with('#') && line != checks_header && !line.starts_with(program + ','))
      text += line + '\n';
  return text;
}

} // namespace

Csv::Csv(const fs::path& file, std::string_view provenance, std::string_view columns,
         bool overwrite, std::string_view rows)
    : name_(file.string())
    , columns_(1 + static_cast<std::size_t>(std::ranges::count(columns, ','))) {
  file_.reset(std::fopen(name_.c_str(), overwrite ? "w" : "wx"));
  if (!file_)
    throw InputError(fs::exists(file) ? name_ + " exists: --force overwrites it"
                                      : name_ + " cannot be created");
  fmt::print(file_.get(), "{}{}\n{}", provenance, columns, rows);
}

void Csv::write(const std::string& line, std::size_t fields) {
  if (fields != columns_)
    throw ContractViolation(
        fmt::format("{}: {} fields in a row of {}: {}", name_, fields, columns_, line));
  if (std::fputs(line.c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0)
    throw RunError(name_ + " cannot be written");
}

Suite::Suite(Options options)
    : options_(std::move(options))
    , provenance_(provenance_of(options_)) {
  fs::create_directories(options_.folder);
  if (fs::exists(stamp()) && !options_.force)
    throw InputError(fmt::format("{} holds the answers of {}: --force overwrites them",
                                 options_.folder.string(), options_.program));
  fs::remove(stamp());
  write_environment(options_);
  const fs::path checks = options_.folder / "checks.csv";
  const std::string others = other_checks(checks, options_.program);
  checks_ = std::make_unique<Csv>(checks, "", checks_header, true, others);
}

fs::path Suite::stamp() const {
  return options_.folder / fmt::format(".{}.done", options_.program);
}

Csv Suite::csv(std::string_view file, std::string_view columns) const {
  return {options_.folder / file, provenance_, columns, options_.force};
}

void Suite::check_at_most(const std::string& what, double value, double bound) {
  record(what, value, bound, value <= bound);
}

void Suite::check_at_least(const std::string& what, double value, double bound) {
  record(what + " (at least)", value, bound, value >= bound);
}

void Suite::record(const std::string& what, double value, double bound, bool passed) {
  checks_->row(options_.program, what, value, bound, int{passed});
  if (!passed) ++failed_;
  fmt::print("{} {}: {:.4g}, bound {:.4g}\n", passed ? "passed" : "FAILED", what, value,
             bound);
}

void Suite::plan(double cost) {
  planned_ = cost;
}

void Suite::done(double cost, const std::string& what) {
  const std::lock_guard lock(progress_);
  done_ += cost;
  fmt::print("progress {:.3f} {}\n", std::min(1.0, done_ / planned_), what);
  std::fflush(stdout);
}

int Suite::finish() {
  std::ofstream(stamp()) << provenance_;
  return failed_ == 0 ? 0 : 1;
}

void in_parallel(const std::vector<std::function<void()>>& jobs) {
  const auto workers =
      std::min(jobs.size(), static_cast<std::size_t>(omp_get_max_threads()));
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> failures(workers);
  const auto work = [&](std::size_t worker) {
    omp_set_num_threads(1); // of this worker
    try {
      for (std::size_t i; (i = next++) < jobs.size();) jobs[i]();
    } catch (...) {
      failures[worker] = std::current_exception();
      next = jobs.size();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t w = 0; w < workers; ++w) threads.emplace_back(work, w);
  }
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

int run_program(int argc, char** argv, const std::string& program,
                const std::string& question, const std::function<void(Suite&)>& body) {
  Suite::Options options{.program = program, .folder = {}};
  bool quick = false;
  CLI::App app{question};
  auto* effort = app.add_option_group("Effort", "one of; quick if none is given");
  effort->add_flag("--quick", quick, "Seconds");
  effort->add_flag("--full", options.full, "Minutes");
  effort->require_option(0, 1);
  app.add_option("-o,--output", options.folder,
                 "Folder of the CSV files; default: out/validation/quick or full");
  app.add_flag("--force", options.force, "Overwrite earlier answers");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  if (options.folder.empty())
    options.folder = fs::path("out/validation") / (options.full ? "full" : "quick");
  try {
    Suite suite(options);
    body(suite);
    return suite.finish();
  } catch (const Error& e) {
    fmt::print(stderr, "{}: {}\n", program, e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", program, e.what());
    return 1;
  }
}

} // namespace ehdjet::validation
