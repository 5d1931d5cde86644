#include "ehdjet/core/parallel.hpp"
#include "ehdjet/core/thread_count.hpp"
#include "ehdjet/integrators/rosenbrock_w.hpp"
#include "ehdjet/integrators/runge_kutta.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

/// Long vectors are combined by all threads. Every bit is that of one thread, and of the same
/// components in a vector that is too short for threads.
namespace ehdjet {
namespace {

/// y_i' = sin(t + i) - r_i y_i, for components from `first` on.
class Decays final : public OdeSystem, private StiffPart {
public:
  explicit Decays(std::size_t first)
      : first_(first) {}
  void evaluate(double t, std::span<const double> y, std::span<double> out) override {
    for (std::size_t i = 0; i < y.size(); ++i)
      out[i] = std::sin(t + static_cast<double>(first_ + i)) - rate(i) * y[i];
  }
  StiffPart* stiff_part() override { return this; }

private:
  [[nodiscard]] double rate(std::size_t i) const {
    return 1 + static_cast<double>((first_ + i) % 17);
  }
  void linearize(double, std::span<const double>) override {}
  void factorize(double eta) override { eta_ = eta; }
  void solve(std::span<double> x) const override {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] /= 1 + eta_ * rate(i);
  }
  void add_time_derivative(double, std::span<double>) const override {}
  [[nodiscard]] Modes fastest_modes() const override { return {}; }

  std::size_t first_;
  double eta_ = 0;
};

std::vector<double> start(std::size_t first, std::size_t n) {
  std::vector<double> y(n);
  for (std::size_t i = 0; i < n; ++i) y[i] = std::cos(3.0 * static_cast<double>(first + i));
  return y;
}

struct Result {
  std::vector<double> errors, inside, end;
  bool operator==(const Result&) const = default;
};

/// Two steps of components first ... first + n - 1, and a state in the second one.
Result two_steps(Integrator& method, std::size_t first, std::size_t n) {
  Decays system(first);
  Result result;
  std::vector<double> y = start(first, n);
  constexpr double h = 0.05;
  result.errors.push_back(method.attempt(system, 0, h, y).error);
  method.commit(y);
  result.errors.push_back(method.attempt(system, h, h, y).error);
  method.prepare_dense_output(system);
  result.inside.resize(n);
  method.dense_output(0.3, 0, result.inside);
  method.commit(y);
  result.end = y;
  return result;
}

struct Case {
  std::string name;
  std::unique_ptr<Integrator> (*make)(std::string_view name, const ErrorScale& scale);
};
std::ostream& operator<<(std::ostream& os, const Case& c) {
  return os << c.name;
}

std::vector<Case> all_methods() {
  std::vector<Case> cases;
  for (const ButcherTableau& t : butcher_tableaus())
    cases.push_back(
        {std::string(t.name),
         [](std::string_view name, const ErrorScale& scale) -> std::unique_ptr<Integrator> {
           return std::make_unique<RungeKutta>(butcher_tableau(name), scale);
         }});
  cases.push_back(
      {"rosenbrock",
       [](std::string_view, const ErrorScale& scale) -> std::unique_ptr<Integrator> {
         return std::make_unique<RosenbrockW>(rosenbrock_tableaus().front(), scale);
       }});
  return cases;
}

class Threads : public testing::TestWithParam<Case> {
protected:
  static constexpr std::size_t columns = 2, n = columns * (parallel_from + 1001);

  /// Of a system of `size` components, of which the first one is number `first`.
  [[nodiscard]] static Result run(bool rms, std::size_t first, std::size_t size) {
    const ErrorScale scale{.rtol = 1e-3,
                           .column_scale = std::vector<double>(columns, 0.5),
                           .root_mean_square = rms};
    const auto method = GetParam().make(GetParam().name, scale);
    return two_steps(*method, first, size);
  }
};
INSTANTIATE_TEST_SUITE_P(All, Threads, testing::ValuesIn(all_methods()),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(Threads, a_step_has_the_same_bits_for_any_number_of_them) {
  for (const bool rms : {false, true}) {
    std::vector<Result> results;
    for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
      const ThreadCount count(threads);
      results.push_back(run(rms, 0, n));
      EXPECT_TRUE(results.back() == results.front()) << threads << ' ' << rms;
    }
  }
}

TEST_P(Threads, a_long_vector_has_the_bits_of_its_pieces) {
  const ThreadCount count(3);
  const Result whole = run(false, 0, n);
  std::vector<double> largest(2, 0.0);
  constexpr std::size_t piece = 1000;
  for (std::size_t first = 0; first < n; first += piece) {
    const std::size_t size = std::min(piece, n - first);
    const Result part = run(false, first, size);
    const auto from = static_cast<std::ptrdiff_t>(first);
    EXPECT_TRUE(std::ranges::equal(part.end, std::span(whole.end).subspan(first, size)))
        << from;
    EXPECT_TRUE(
        std::ranges::equal(part.inside, std::span(whole.inside).subspan(first, size)))
        << from;
    for (std::size_t i = 0; i < 2; ++i) largest[i] = std::max(largest[i], part.errors[i]);
  }
  EXPECT_EQ(whole.errors, largest);
}

TEST_P(Threads, a_nan_in_any_part_is_seen) {
  const ThreadCount count(3);
  for (const std::size_t bad : {std::size_t{0}, n / 3, n - 1}) {
    Decays system(0);
    const auto method = GetParam().make(GetParam().name, {.rtol = 1, .column_scale = {1}});
    std::vector<double> y = start(0, n);
    y[bad] = std::nan("");
    EXPECT_FALSE(method->attempt(system, 0, 0.1, y).error <= 1) << bad;
    if (method->error_order() > 0) {
      EXPECT_EQ(method->worst_component(), bad);
    }
  }
}

} // namespace
} // namespace ehdjet
