#pragma once

#include "ehdjet/io/run_file.hpp"
#include "ehdjet/observers/observer.hpp"

#include <chrono>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "column.hpp"
#include "hdf5.hpp"

namespace ehdjet {

/// The open file behind a RunFile and its observers: when to flush, what to say when it fails.
class RunWriter {
public:
  RunWriter(const std::filesystem::path& path, bool overwrite, const Provenance& provenance,
            double flush_interval);
  ~RunWriter();
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;

  [[nodiscard]] hdf5::Handle create_group(const char* name);
  template <class T>
  hdf5::Column& add_column(hid_t group, const hdf5::ColumnInfo& info, T row,
                           std::size_t chunk_rows) {
    return columns_.emplace_back(group, info, row, chunk_rows);
  }

  /// Runs `append`, which appends one whole row, frame or part, and flushes if it is time.
  template <class Append>
  void write(Append&& append) {
    guard(append);
    if (std::chrono::steady_clock::now() - flushed_ >= flush_interval_) flush();
  }
  /// A root attribute that is written with the last words.
  void note(std::string name, std::string value) {
    notes_.emplace_back(std::move(name), std::move(value));
  }
  void flush();
  void keep(const Checkpoint& checkpoint);
  void finish(const std::string& status, const std::string& message,
              const RunStatistics& statistics, const Ledger& ledger);

private:
  template <class Action>
  void guard(Action&& action) {
    if (broken()) throw_error();
    try {
      action();
    } catch (const hdf5::Failure& failure) {
      abandon(failure);
    }
    if (broken()) throw_error();
  }
  [[nodiscard]] bool broken() const;
  [[noreturn]] void abandon(const hdf5::Failure& failure);
  [[noreturn]] void throw_error() const;
  void create(const Provenance& provenance);
  void close();

  std::vector<std::pair<std::string, std::string>> notes_;
  std::filesystem::path path_;
  std::chrono::duration<double> flush_interval_;
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
  hdf5::Handle file_;
  std::deque<hdf5::Column> columns_; // observers refer to them
};

// The observers of a run file; each creates its part of the file.
std::unique_ptr<Observer> make_observables(RunWriter& writer, double interval,
                                           bool with_coulomb_error);
std::unique_ptr<Observer> make_frames(RunWriter& writer, double interval, bool with_stress);
std::unique_ptr<Observer> make_deposit(RunWriter& writer);
std::unique_ptr<Observer> make_refinements(RunWriter& writer, bool with_coulomb_energy);
std::unique_ptr<Observer> make_account_book(RunWriter& writer, double interval,
                                            Accounts& accounts);
std::unique_ptr<Observer> make_resolving_power(RunWriter& writer, double interval,
                                               double link_length);

} // namespace ehdjet
