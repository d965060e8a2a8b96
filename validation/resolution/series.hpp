// Power series in the time since the start of a step, built one coefficient after the other: the
// k-th of a result needs the coefficients 0 to k of its arguments. These recurrences are all that
// Taylor's method needs.
#pragma once

#include <array>

#include "number.hpp"

namespace resolution {

constexpr int most_terms = 48;  ///< longest series, order 47

template <class Real>
using Series = std::array<Real, most_terms>;

/// The k-th coefficient of a b.
template <class Real>
Real product(const Series<Real>& a, const Series<Real>& b, int k) {
  Real sum = 0;
  for (int i = 0; i <= k; ++i) sum += a[i] * b[k - i];
  return sum;
}

/// The k-th coefficient of a², each pair computed once.
template <class Real>
Real square(const Series<Real>& a, int k) {
  Real sum = 0;
  for (int i = 0; 2 * i < k; ++i) sum += a[i] * a[k - i];
  sum += sum;
  return k % 2 == 0 ? sum + a[k / 2] * a[k / 2] : sum;
}

/// The coefficients of a' times time: i a_i.
template <class Real>
Real slope_product(const Series<Real>& a, const Series<Real>& b, int k) {
  Real sum = 0;
  for (int i = 1; i <= k; ++i) sum += Real(i) * a[i] * b[k - i];
  return sum;
}

/// exp(u): from e' = u' e.
template <class Real>
void extend_exponential(Series<Real>& e, const Series<Real>& u, int k) {
  e[k] = k == 0 ? exponential(u[0]) : slope_product(u, e, k) / Real(k);
}

/// sin(u) and cos(u): from s' = u' c, c' = -u' s.
template <class Real>
void extend_sine(Series<Real>& s, Series<Real>& c, const Series<Real>& u, int k) {
  s[k] = k == 0 ? sine(u[0]) : slope_product(u, c, k) / Real(k);
  c[k] = k == 0 ? cosine(u[0]) : -slope_product(u, s, k) / Real(k);
}

/// 1/p: from g p = 1.
template <class Real>
void extend_reciprocal(Series<Real>& g, const Series<Real>& p, int k) {
  if (k == 0) {
    g[0] = Real(1) / p[0];
    return;
  }
  Real sum = 0;
  for (int i = 1; i <= k; ++i) sum += p[i] * g[k - i];
  g[k] = -g[0] * sum;
}

/// sqrt(p): from r r = p.
template <class Real>
void extend_root(Series<Real>& r, const Series<Real>& p, int k) {
  if (k == 0) {
    r[0] = root(p[0]);
    return;
  }
  Real sum = p[k];
  for (int i = 1; i < k; ++i) sum -= r[i] * r[k - i];
  r[k] = sum / (r[0] + r[0]);
}

}  // namespace resolution
