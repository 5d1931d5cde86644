#pragma once

#include "ehdjet/core/error.hpp"

#include <cmath>
#include <concepts>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What the programs of the validation suite have in common: command line, CSV files, checks,
/// progress.
namespace ehdjet::validation {

/// A tidy table with its provenance above the header. Each row is on disk once it is written.
class Csv {
public:
  /// `rows`: rows that are there already.
  Csv(const std::filesystem::path& file, std::string_view provenance,
      std::string_view columns, bool overwrite, std::string_view rows = "");

  /// Numbers, text, and optionals; what is absent or not a number leaves its field empty.
  template <class... Fields>
  void row(const Fields&... fields) {
    std::string line;
    ((line += text(fields), line += ','), ...);
    line.back() = '\n';
    write(line, sizeof...(fields));
  }

private:
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  static std::string text(double value) {
    return std::isnan(value) ? "" : fmt::format("{:.10g}", value);
  }
  static std::string text(std::integral auto value) { return fmt::format("{}", value); }
  static std::string text(std::string_view value) {
    if (value.find(',') != value.npos) throw ContractViolation("a comma in a field");
    return std::string(value);
  }
  template <class T>
  static std::string text(const std::optional<T>& value) {
    return value ? text(*value) : "";
  }
  void write(const std::string& line, std::size_t fields);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
  std::size_t columns_;
};

/// One run of a program: its options, and where its results go.
class Suite {
public:
  struct Options {
    std::string program;
    std::filesystem::path folder;
    bool full = false, force = false;
  };
  explicit Suite(Options options);

  [[nodiscard]] bool quick() const { return !options_.full; }
  [[nodiscard]] bool full() const { return options_.full; }
  /// One of two, by effort.
  template <class T>
  [[nodiscard]] T pick(T quick_value, T full_value) const {
    return quick() ? quick_value : full_value;
  }

  /// Where tables go, for what is no CSV file.
  [[nodiscard]] const std::filesystem::path& folder() const { return options_.folder; }

  /// `columns`: names separated by commas, each ending in its unit.
  Csv csv(std::string_view file, std::string_view columns) const;

  /// Checks decide whether the program passes; they are written to checks.csv.
  void check_at_most(const std::string& what, double value, double bound);
  void check_at_least(const std::string& what, double value, double bound);

  /// The cost of everything, in any unit, and the parts of it that are done.
  void plan(double cost);
  void done(double cost, const std::string& what);

  /// Marks this program's tables as complete; returns its exit code.
  int finish();

private:
  void record(const std::string& what, double value, double bound, bool passed);
  [[nodiscard]] std::filesystem::path stamp() const;

  Options options_;
  std::string provenance_;
  std::unique_ptr<Csv> checks_;
  std::size_t failed_ = 0;
  std::mutex progress_;
  double planned_ = 0, done_ = 0;
};

/// Does independent jobs on all processors at once, each with one thread, in any order. The
/// first exception is passed on when all jobs have ended.
void in_parallel(const std::vector<std::function<void()>>& jobs);

/// `main` of a program: reads the command line, runs it, reports errors.
int run_program(int argc, char** argv, const std::string& program,
                const std::string& question, const std::function<void(Suite&)>& body);

} // namespace ehdjet::validation
