#include "ehdjet/events/root.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/gsl_errors.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <cmath>
#include <exception>
#include <memory>
#include <new>

namespace ehdjet {
namespace {

struct FreeSolver {
  void operator()(gsl_root_fsolver* s) const { gsl_root_fsolver_free(s); }
};

double finite(double value) {
  if (!std::isfinite(value))
    throw RunError("the function whose root is an event is not a number inside the step");
  return value;
}

/// An event function as GSL calls it: through C, which exceptions must not cross.
struct Guarded {
  const std::function<double(double)>& g;
  std::exception_ptr failure;

  static double call(double theta, void* self) {
    auto& guarded = *static_cast<Guarded*>(self);
    try {
      return finite(guarded.g(theta));
    } catch (...) {
      guarded.failure = std::current_exception();
      return 1; // anything finite: the search ends after this step
    }
  }
  void check(int status) const {
    if (failure) std::rethrow_exception(failure);
    GslErrors::check(status, "the root of an event function could not be found");
  }
};

} // namespace

std::optional<double> first_crossing(const std::function<double(double)>& g) {
  if (finite(g(1)) < 0) return std::nullopt;
  // The event happened at the very start of the step: round-off of an event before it.
  if (finite(g(0)) >= 0) return 0.0;

  const GslErrors as_status_codes;
  thread_local const std::unique_ptr<gsl_root_fsolver, FreeSolver> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent));
  if (!solver) throw std::bad_alloc();
  Guarded guarded{.g = g, .failure = {}};
  gsl_function f{.function = Guarded::call, .params = &guarded};
  guarded.check(gsl_root_fsolver_set(solver.get(), &f, 0, 1));
  constexpr int most_iterations = 200; // bisection alone needs about 50
  for (int i = 0; i < most_iterations; ++i) {
    guarded.check(gsl_root_fsolver_iterate(solver.get()));
    const double low = gsl_root_fsolver_x_lower(solver.get());
    const double high = gsl_root_fsolver_x_upper(solver.get());
    if (gsl_root_test_interval(low, high, 0, 4e-16) == GSL_SUCCESS) break;
    if (g(gsl_root_fsolver_root(solver.get())) == 0) break;
  }
  const double root = gsl_root_fsolver_root(solver.get());
  return g(root) >= 0 ? root : gsl_root_fsolver_x_upper(solver.get());
}

std::optional<double> expected_crossing(double g0, double g1, double slope1) {
  const double a = g0 - g1 + slope1, b = slope1; // g(1 + s) = g1 + b s + a s^2
  const double discriminant = b * b - 4 * a * g1;
  if (!(g1 < 0) || !(discriminant >= 0)) return std::nullopt;
  const double q = b + std::sqrt(discriminant);
  const double s = q > 0 ? -2 * g1 / q : -1;
  if (!(s > 0)) return std::nullopt;
  return 1 + s;
}

} // namespace ehdjet
