#include "carom/orbits/cycle_expansion.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "carom/base/elementary.hpp"

namespace carom {

namespace {

struct Cycle {
  std::size_t hits;
  double period, multiplier, copies;
};

// A number and its derivatives by gamma and beta.
struct Term {
  double value = 0.0, by_gamma = 0.0, by_beta = 0.0;
  void add(double factor, const Term& o) {
    value += factor * o.value;
    by_gamma += factor * o.by_gamma;
    by_beta += factor * o.by_beta;
  }
  friend Term operator*(const Term& a, const Term& b) {
    return {a.value * b.value, a.by_gamma * b.value + a.value * b.by_gamma,
            a.by_beta * b.value + a.value * b.by_beta};
  }
};

// The series in z, cut after z^hits.
struct Series {
  const std::vector<Cycle>* cycles;
  std::size_t hits;
  bool spectral;

  // What an orbit weighs whose leading multiplier is `power`, without its time.
  double weight(double power) const {
    return 1.0 / std::abs(spectral ? (1.0 - power) * (1.0 - 1.0 / power) : power);
  }

  // At beta = 0.
  Term operator()(double gamma) const {
    // F = exp(-sum of c_n z^n / n) = sum of q_n z^n, whose derivative by z gives
    // n q_n = - sum over k of c_k q_(n - k).
    std::vector<Term> c(hits + 1), q(hits + 1);
    for (const Cycle& cycle : *cycles) {
      const double stretching = elementary::log(std::abs(cycle.multiplier));
      double power = 1.0;
      for (std::size_t r = 1; r * cycle.hits <= hits; ++r) {
        power *= cycle.multiplier;
        const auto repeats = static_cast<double>(r);
        const double time = repeats * cycle.period;
        c[r * cycle.hits].add(static_cast<double>(cycle.hits) * cycle.copies *
                                  elementary::exp(gamma * time) * weight(power),
                              {1.0, time, repeats * stretching});
      }
    }
    Term sum = q[0] = {1.0, 0.0, 0.0};
    for (std::size_t n = 1; n <= hits; ++n) {
      for (std::size_t k = 1; k <= n; ++k) q[n].add(-1.0 / static_cast<double>(n), c[k] * q[n - k]);
      sum.add(1.0, q[n]);
    }
    return sum;
  }
};

double value_of(double gamma, void* series) {
  return (*static_cast<const Series*>(series))(gamma).value;
}

// The least zero above 0, by steps to its first change of sign and Brent's method.
double first_zero(Series series, double step, int steps) {
  double low = 0.0, high = step;
  if (!(series(low).value > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; series(high).value > 0.0; ++i, low = high, high += step)
    if (i == steps) return std::numeric_limits<double>::quiet_NaN();
  gsl_function function{&value_of, &series};
  const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  gsl_root_fsolver_set(solver.get(), &function, low, high);
  // Brent's method halves the bracket at least every third step: 53 bits.
  for (int i = 0; i < 160; ++i) {
    gsl_root_fsolver_iterate(solver.get());
    const double a = gsl_root_fsolver_x_lower(solver.get());
    const double b = gsl_root_fsolver_x_upper(solver.get());
    if (gsl_root_test_interval(a, b, 0.0, 0x1p-51) == GSL_SUCCESS) break;
  }
  return gsl_root_fsolver_root(solver.get());
}

}  // namespace

CycleExpansion expand_cycles(const std::vector<PeriodicOrbit>& orbits, std::size_t most_hits) {
  std::vector<Cycle> cycles;
  double fastest = 0.0;  // rate at which a single orbit loses its neighbours
  for (const PeriodicOrbit& orbit : orbits) {
    const double multiplier = orbit.multipliers[0].real();
    cycles.push_back(
        {orbit.hits.size(), orbit.period, multiplier, static_cast<double>(orbit.copies)});
    fastest = std::max(fastest, elementary::log(std::abs(multiplier)) / orbit.period);
  }
  // The system loses no faster than its most unstable orbit: 200 steps to there.
  constexpr int steps = 200;
  const double step = fastest / steps;
  CycleExpansion result;
  for (std::size_t hits = 2; hits <= most_hits; ++hits) {
    const Series spectral{&cycles, hits, true};
    const double rate = first_zero(spectral, step, steps);
    const Term there = spectral(rate);
    result.orders.push_back({hits, rate, first_zero({&cycles, hits, false}, step, steps),
                             there.by_beta / there.by_gamma});
  }
  const CycleOrder& last = result.orders.back();
  result.escape_rate = last.spectral;
  result.lambda = last.lambda;
  result.error = result.lambda_error = std::numeric_limits<double>::quiet_NaN();
  if (result.orders.size() > 1) {
    const CycleOrder& before = result.orders[result.orders.size() - 2];
    result.error = std::abs(last.spectral - before.spectral);
    result.lambda_error = std::abs(last.lambda - before.lambda);
  }
  return result;
}

}  // namespace carom
