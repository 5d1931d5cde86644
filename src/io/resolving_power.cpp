#include "ehdjet/core/error.hpp"
#include "ehdjet/io/records.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace ehdjet {

namespace {

constexpr std::size_t places = 101; // lambda = 0, 0.01, ... 1

class ResolvingPower final : public Observer {
public:
  ResolvingPower(std::shared_ptr<RunFile> file, double interval, double link_length)
      : file_(std::move(file))
      , schedule_(interval)
      , link_length_(link_length)
      , time_(add({"time", "s", "of each sample"}, 1024))
      , power_(add(
            {"r", "1", "R = link_length/l at all values of lambda, sample after sample"},
            places * 64)) {
    EHDJET_EXPECTS(interval > 0 && link_length > 0);
    Column& lambda =
        add({"lambda", "1", "arc length from the nozzle over the jet's"}, places);
    file_->write([&] {
      for (std::size_t i = 0; i < places; ++i) lambda.append(at(i));
    });
    file_->flush();
  }

  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }

  void observe(const JetSnapshot& snapshot) override {
    sample(snapshot);
    file_->write([&] {
      power_.append(std::span<const double>(row_));
      time_.append(snapshot.time); // last: it makes the values above a sample
    });
    schedule_.advance();
  }

private:
  Column& add(const ColumnInfo& info, std::size_t chunk_rows) {
    return file_->add_column("resolving_power", info, chunk_rows);
  }
  static double at(std::size_t place) { return static_cast<double>(place) / (places - 1); }

  // R of the link in which each lambda lies. The link across an embryo is one link.
  void sample(const JetSnapshot& snapshot) {
    const auto r = snapshot.columns.position();
    const std::size_t first = snapshot.jet.first(), beads = snapshot.jet.beads();
    length_.resize(beads);
    double total = 0;
    for (std::size_t k = first; k < beads; ++k) {
      length_[k] = link_length(r, first, k);
      total += length_[k];
    }
    std::size_t k = first;
    double end = length_[first];
    for (std::size_t i = 0; i < places; ++i) {
      while (k + 1 < beads && end < at(i) * total) end += length_[++k];
      row_[i] = link_length_ / length_[k];
    }
  }

  std::shared_ptr<RunFile> file_;
  Schedule schedule_;
  double link_length_; // [m]
  std::vector<double> length_;
  std::array<double, places> row_{};
  Column &time_, &power_;
};

} // namespace

std::unique_ptr<Observer> record_resolving_power(std::shared_ptr<RunFile> file,
                                                 double interval, double link_length) {
  return std::make_unique<ResolvingPower>(std::move(file), interval, link_length);
}

} // namespace ehdjet
