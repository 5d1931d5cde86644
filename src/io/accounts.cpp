#include <span>
#include <string>
#include <vector>

#include "run_writer.hpp"

namespace ehdjet {

namespace {

/// Rows of an `Accounts`, whatever it accounts for: the group `budget`.
class AccountBook final : public Observer {
public:
  AccountBook(RunWriter& writer, double interval, Accounts& accounts, hid_t group)
      : writer_(writer)
      , schedule_(interval)
      , accounts_(accounts)
      , row_(accounts.columns().size()) {
    std::string names;
    for (const Accounts::Column& c : accounts.columns()) {
      columns_.push_back(
          &real(group, {c.name.c_str(), c.unit.c_str(), c.description.c_str()}));
      names.append(names.empty() ? "" : ",").append(c.name);
    }
    time_ = &real(group, {"time", "s", "of each row"});
    hdf5::write_attribute(group, "columns", names);
  }

  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }

  void observe(const JetSnapshot& snapshot) override {
    accounts_.measure(snapshot, row_);
    writer_.write([&] {
      for (std::size_t i = 0; i < row_.size(); ++i) columns_[i]->append(row_[i]);
      time_->append(snapshot.time);
    });
    schedule_.advance();
  }

private:
  hdf5::Column& real(hid_t group, const hdf5::ColumnInfo& info) {
    return writer_.add_column(group, info, double{}, 1024);
  }

  RunWriter& writer_;
  Schedule schedule_;
  Accounts& accounts_;
  std::vector<double> row_;
  std::vector<hdf5::Column*> columns_;
  hdf5::Column* time_;
};

} // namespace

std::unique_ptr<Observer> make_account_book(RunWriter& writer, double interval,
                                            Accounts& accounts) {
  std::unique_ptr<Observer> observer;
  writer.write([&] {
    observer = std::make_unique<AccountBook>(writer, interval, accounts,
                                             writer.create_group("budget"));
  });
  writer.flush();
  return observer;
}

} // namespace ehdjet
