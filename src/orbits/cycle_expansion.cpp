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

// The series in z, cut after z^hits.
struct Series {
  const std::vector<Cycle>* cycles;
  std::size_t hits;
  bool spectral;

  // What an orbit weighs whose leading multiplier is `power`, without its time.
  double weight(double power) const {
    return 1.0 / std::abs(spectral ? (1.0 - power) * (1.0 - 1.0 / power) : power);
  }

  double operator()(double gamma) const {
    // F = exp(-sum of c_n z^n / n) = sum of q_n z^n, whose derivative by z gives
    // n q_n = - sum over k of c_k q_(n - k).
    std::vector<double> c(hits + 1, 0.0), q(hits + 1, 0.0);
    for (const Cycle& cycle : *cycles) {
      double power = 1.0;
      for (std::size_t r = 1; r * cycle.hits <= hits; ++r) {
        power *= cycle.multiplier;
        const double time = static_cast<double>(r) * cycle.period;
        c[r * cycle.hits] += static_cast<double>(cycle.hits) * cycle.copies *
                             elementary::exp(gamma * time) * weight(power);
      }
    }
    double sum = q[0] = 1.0;
    for (std::size_t n = 1; n <= hits; ++n) {
      for (std::size_t k = 1; k <= n; ++k) q[n] -= c[k] * q[n - k];
      q[n] /= static_cast<double>(n);
      sum += q[n];
    }
    return sum;
  }
};

double value_of(double gamma, void* series) { return (*static_cast<const Series*>(series))(gamma); }

// The least zero above 0, by steps to its first change of sign and Brent's method.
double first_zero(Series series, double step, int steps) {
  double low = 0.0, high = step;
  if (!(series(low) > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; series(high) > 0.0; ++i, low = high, high += step)
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
  CycleExpansion result;
  for (std::size_t hits = 2; hits <= most_hits; ++hits)
    result.orders.push_back({hits, first_zero({&cycles, hits, true}, fastest / steps, steps),
                             first_zero({&cycles, hits, false}, fastest / steps, steps)});
  const std::size_t last = result.orders.size() - 1;
  result.escape_rate = result.orders[last].spectral;
  result.error = last == 0 ? std::numeric_limits<double>::quiet_NaN()
                           : std::abs(result.escape_rate - result.orders[last - 1].spectral);
  return result;
}

}  // namespace carom
