#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "run_writer.hpp"

namespace ehdjet {

namespace {

constexpr std::size_t places = 101; // lambda = 0, 0.01, ... 1

class ResolvingPower final : public Observer {
public:
  ResolvingPower(RunWriter& writer, double interval, double link_length, hid_t group)
      : writer_(writer)
      , schedule_(interval)
      , link_length_(link_length)
      , time_(writer.add_column(group, {"time", "s", "of each sample"}, double{}, 1024))
      , power_(writer.add_column(group,
                                 {"r", "1",
                                  "R = link_length/l at all values of lambda, sample after "
                                  "sample"},
                                 double{}, places * 64)) {
    auto& lambda = writer.add_column(
        group, {"lambda", "1", "arc length from the nozzle over the jet's"}, double{},
        places);
    for (std::size_t i = 0; i < places; ++i) lambda.append(at(i));
  }

  [[nodiscard]] double next_time() const override { return schedule_.next(); }
  void skip_to(double time) override { schedule_.skip_to(time); }

  void observe(const JetSnapshot& snapshot) override {
    sample(snapshot);
    writer_.write([&] {
      power_.append(std::span<const double>(row_));
      time_.append(snapshot.time); // last: it makes the values above a sample
    });
    schedule_.advance();
  }

private:
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

  RunWriter& writer_;
  Schedule schedule_;
  double link_length_; // [m]
  std::vector<double> length_;
  std::array<double, places> row_{};
  hdf5::Column &time_, &power_;
};

} // namespace

std::unique_ptr<Observer> make_resolving_power(RunWriter& writer, double interval,
                                               double link_length) {
  std::unique_ptr<Observer> observer;
  writer.write([&] {
    observer = std::make_unique<ResolvingPower>(writer, interval, link_length,
                                                writer.create_group("resolving_power"));
  });
  writer.flush();
  return observer;
}

} // namespace ehdjet
