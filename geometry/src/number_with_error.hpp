// A double with a bound on its error, as the coefficients of polynomials carry it.
#pragma once

#include <cmath>

#include "carom/base/sign.hpp"
#include "carom/geometry/prepared_curve.hpp"

namespace carom::geometry {

struct NumberWithError {
  double value = 0.0, error = 0.0;
  Sign sign() const { return sign_within(value, error); }

  friend NumberWithError operator+(const NumberWithError& a, const NumberWithError& b) {
    return {a.value + b.value, a.error + b.error};  // roundings are in the errors of the terms
  }
  friend NumberWithError mean_of(const NumberWithError& a, const NumberWithError& b) {
    const double mean = 0.5 * (a.value + b.value);
    return {mean, 0.5 * (a.error + b.error) + 1.1 * unit_roundoff * std::fabs(mean)};
  }
};

/// The quotient m/n is rounded once, the product once, each partial sum of such terms once.
inline NumberWithError share_of(const NumberWithError& c, int m, int n) {
  const double ratio = static_cast<double>(m) / n, term = ratio * c.value;
  return {term, ratio * 1.01 * c.error + 7.1 * unit_roundoff * std::fabs(term)};
}

}  // namespace carom::geometry
