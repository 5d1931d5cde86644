#include "ehdjet/io/run_file.hpp"

#include "ehdjet/core/error.hpp"

#include "run_writer.hpp"

namespace ehdjet {

namespace {

class Checkpoints final : public Observer {
public:
  explicit Checkpoints(RunWriter& writer)
      : writer_(writer) {}
  void checkpoint(const Checkpoint& checkpoint) override { writer_.keep(checkpoint); }

private:
  RunWriter& writer_;
};

} // namespace

RunFile::RunFile(const std::filesystem::path& path, bool overwrite,
                 const Provenance& provenance, double flush_interval)
    : writer_(std::make_unique<RunWriter>(path, overwrite, provenance, flush_interval)) {}

RunFile::~RunFile() = default;

std::unique_ptr<Observer> RunFile::observables(double interval, bool with_coulomb_error) {
  EHDJET_EXPECTS(interval > 0);
  return make_observables(*writer_, interval, with_coulomb_error);
}

std::unique_ptr<Observer> RunFile::frames(double interval, bool with_stress) {
  EHDJET_EXPECTS(interval > 0);
  return make_frames(*writer_, interval, with_stress);
}

std::unique_ptr<Observer> RunFile::deposit() {
  return make_deposit(*writer_);
}

std::unique_ptr<Observer> RunFile::refinements(bool with_coulomb_energy) {
  return make_refinements(*writer_, with_coulomb_energy);
}

std::unique_ptr<Observer> RunFile::budget(double interval, Accounts& accounts) {
  EHDJET_EXPECTS(interval > 0);
  return make_account_book(*writer_, interval, accounts);
}

std::unique_ptr<Observer> RunFile::resolving_power(double interval, double link_length) {
  EHDJET_EXPECTS(interval > 0 && link_length > 0);
  return make_resolving_power(*writer_, interval, link_length);
}

std::unique_ptr<Observer> RunFile::checkpoints() {
  return std::make_unique<Checkpoints>(*writer_);
}

void RunFile::note_coulomb(const std::string& method) {
  writer_->note("coulomb", method);
}

void RunFile::keep(const Checkpoint& checkpoint) {
  writer_->keep(checkpoint);
}

void RunFile::flush() {
  writer_->flush();
}

void RunFile::finish(const std::string& status, const std::string& message,
                     const RunStatistics& statistics, const Ledger& ledger) {
  writer_->finish(status, message, statistics, ledger);
}

} // namespace ehdjet
