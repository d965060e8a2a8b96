// Dual numbers: a value and its derivatives go together through a formula. Nested ones have the
// second derivatives, too.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "carom/base/elementary.hpp"
#include "carom/forces/hessian.hpp"
#include "carom/geometry/vector.hpp"
#include "forces/hyperbolic.hpp"

namespace carom::forces {

/// n derivatives. Scalar: double, or again a dual number.
template <std::size_t n, class Scalar = double>
struct Dual {
  Scalar v;
  std::array<Scalar, n> d;

  Dual() = default;  // not initialised, as doubles are not
  constexpr Dual(double value) : v(value), d{} {
    for (Scalar& slope : d) slope = Scalar(0.0);
  }
  /// The k-th variable.
  static constexpr Dual variable(const Scalar& value, std::size_t k) {
    Dual x(0.0);
    x.v = value;
    x.d[k] = Scalar(1.0);
    return x;
  }
};
/// f(a): value and slope.
template <std::size_t n, class S>
inline Dual<n, S> chain(const S& value, const S& slope, const Dual<n, S>& a) {
  Dual<n, S> out;
  out.v = value;
  for (std::size_t k = 0; k < n; ++k) out.d[k] = slope * a.d[k];
  return out;
}

/// f(a, b): value and both slopes.
template <std::size_t n, class S>
inline Dual<n, S> chain(const S& value, const S& slope_a, const Dual<n, S>& a, const S& slope_b,
                        const Dual<n, S>& b) {
  Dual<n, S> out;
  out.v = value;
  for (std::size_t k = 0; k < n; ++k) out.d[k] = slope_a * a.d[k] + slope_b * b.d[k];
  return out;
}

inline double value_of(double x) { return x; }
template <std::size_t n, class S>
inline double value_of(const Dual<n, S>& x) {
  return value_of(x.v);
}

template <std::size_t n, class S>
inline Dual<n, S> operator+(const Dual<n, S>& a, const Dual<n, S>& b) {
  return chain(a.v + b.v, S(1.0), a, S(1.0), b);
}
template <std::size_t n, class S>
inline Dual<n, S> operator-(const Dual<n, S>& a, const Dual<n, S>& b) {
  return chain(a.v - b.v, S(1.0), a, S(-1.0), b);
}
template <std::size_t n, class S>
inline Dual<n, S> operator*(const Dual<n, S>& a, const Dual<n, S>& b) {
  return chain(a.v * b.v, b.v, a, a.v, b);
}
template <std::size_t n, class S>
inline Dual<n, S> operator/(const Dual<n, S>& a, const Dual<n, S>& b) {
  const S value = a.v / b.v, inverse = S(1.0) / b.v;
  return chain(value, inverse, a, -value * inverse, b);
}
template <std::size_t n, class S>
inline Dual<n, S> operator-(const Dual<n, S>& a) {
  return chain(-a.v, S(-1.0), a);
}
template <std::size_t n, class S>
inline Dual<n, S> operator+(double c, const Dual<n, S>& a) {
  return chain(c + a.v, S(1.0), a);
}
template <std::size_t n, class S>
inline Dual<n, S> operator+(const Dual<n, S>& a, double c) {
  return c + a;
}
template <std::size_t n, class S>
inline Dual<n, S> operator-(double c, const Dual<n, S>& a) {
  return chain(c - a.v, S(-1.0), a);
}
template <std::size_t n, class S>
inline Dual<n, S> operator-(const Dual<n, S>& a, double c) {
  return chain(a.v - c, S(1.0), a);
}
template <std::size_t n, class S>
inline Dual<n, S> operator*(double c, const Dual<n, S>& a) {
  return chain(c * a.v, S(c), a);
}
template <std::size_t n, class S>
inline Dual<n, S> operator*(const Dual<n, S>& a, double c) {
  return c * a;
}
template <std::size_t n, class S>
inline Dual<n, S> operator/(const Dual<n, S>& a, double c) {
  return chain(a.v / c, S(1.0 / c), a);
}
template <std::size_t n, class S>
inline Dual<n, S> operator/(double c, const Dual<n, S>& a) {
  const S value = c / a.v;
  return chain(value, -value / a.v, a);
}

// Elementary functions of any number: those of doubles have the same bits everywhere.
inline double root(double x) { return std::sqrt(x); }
inline double exponential(double x) { return elementary::exp(x); }
inline double logarithm(double x) { return elementary::log(x); }
inline double angle(double y, double x) { return elementary::atan2(y, x); }
template <class S>
struct SineAndCosine {
  S sine, cosine;
};
inline SineAndCosine<double> sine_and_cosine(double x) {
  const auto [sine, cosine] = elementary::sincos(x);
  return {sine, cosine};
}
inline SineAndCosine<double> hyperbolic_sine_and_cosine(double x) {
  const auto [sine, cosine] = sine_and_cosine_hyperbolic(x);
  return {sine, cosine};
}
template <class S>
struct ValueAndSlope {
  S value, slope;
};
inline ValueAndSlope<double> tanh_and_slope(double x) {
  const auto [value, slope] = tangent_hyperbolic(x);
  return {value, slope};
}

template <std::size_t n, class S>
inline Dual<n, S> root(const Dual<n, S>& a) {
  const S value = root(a.v);
  return chain(value, 0.5 / value, a);
}
template <std::size_t n, class S>
inline Dual<n, S> exponential(const Dual<n, S>& a) {
  const S value = exponential(a.v);
  return chain(value, value, a);
}
template <std::size_t n, class S>
inline Dual<n, S> logarithm(const Dual<n, S>& a) {
  return chain(logarithm(a.v), 1.0 / a.v, a);
}
template <std::size_t n, class S>
inline SineAndCosine<Dual<n, S>> sine_and_cosine(const Dual<n, S>& a) {
  const auto [sine, cosine] = sine_and_cosine(a.v);
  return {chain(sine, cosine, a), chain(cosine, -sine, a)};
}
template <std::size_t n, class S>
inline SineAndCosine<Dual<n, S>> hyperbolic_sine_and_cosine(const Dual<n, S>& a) {
  const auto [sine, cosine] = hyperbolic_sine_and_cosine(a.v);
  return {chain(sine, cosine, a), chain(cosine, sine, a)};
}
template <std::size_t n, class S>
inline ValueAndSlope<Dual<n, S>> tanh_and_slope(const Dual<n, S>& a) {
  const auto [value, slope] = tanh_and_slope(a.v);
  return {chain(value, slope, a), chain(slope, -2.0 * (value * slope), a)};
}
/// Scaled, so that the squares neither overflow nor vanish.
template <std::size_t n, class S>
inline Dual<n, S> angle(const Dual<n, S>& y, const Dual<n, S>& x) {
  const double scale = std::fmax(std::fabs(value_of(x)), std::fabs(value_of(y)));
  const S along = x.v / scale, across = y.v / scale;
  const S square = (along * along + across * across) * scale;
  return chain(angle(y.v, x.v), along / square, y, -across / square, x);
}

inline double absolute(double x) { return std::fabs(x); }
/// The slope at zero is zero.
template <std::size_t n, class S>
inline Dual<n, S> absolute(const Dual<n, S>& a) {
  const double sign = value_of(a) > 0.0 ? 1.0 : value_of(a) < 0.0 ? -1.0 : 0.0;
  return chain(absolute(a.v), S(sign), a);
}

/// x^n for n >= 0, by squaring.
template <class S>
inline S power_by_squaring(S x, int n) {
  S result = 1.0;
  for (;; x = x * x) {
    if (n % 2 == 1) result = result * x;
    n /= 2;
    if (n == 0) return result;
  }
}

/// Adds the second derivatives of an energy whose force is scale f(d^2) d; `f` with its slope by
/// d^2.
inline void add_central(const Dual<1>& f, geometry::Vector d, double scale, Hessian& hessian) {
  const double along = -scale * f.v, across = -2.0 * scale * f.d[0];
  hessian.xx += along + across * d.x * d.x;
  hessian.xy += across * d.x * d.y;
  hessian.yy += along + across * d.y * d.y;
}

}  // namespace carom::forces
