// Arithmetic of boxes in the complex plane: each result encloses all values, except for rounding
// (1e-15 relative), which the bounds made of them do not need. What has no bound has infinite or
// undefined ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "carom/base/elementary.hpp"
#include "forces/hyperbolic.hpp"

namespace carom::forces::complex_box {

struct Range {
  double low = 0.0, high = 0.0;
};
inline constexpr double unbounded = std::numeric_limits<double>::infinity();
inline constexpr Range everything{-unbounded, unbounded};

inline Range operator+(Range a, Range b) { return {a.low + b.low, a.high + b.high}; }
inline Range operator-(Range a) { return {-a.high, -a.low}; }
inline Range operator-(Range a, Range b) { return {a.low - b.high, a.high - b.low}; }
/// Zero times anything is zero, also of what has no bound.
inline double times(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : a * b; }
inline Range operator*(Range a, Range b) {
  const double p = times(a.low, b.low), q = times(a.low, b.high), r = times(a.high, b.low),
               s = times(a.high, b.high);
  return {std::min({p, q, r, s}), std::max({p, q, r, s})};
}
inline Range operator*(double c, Range a) { return Range{c, c} * a; }
inline Range hull(Range a, Range b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }
inline Range square(Range a) {
  const double low = std::max({a.low, -a.high, 0.0}), high = std::max(a.high, -a.low);
  return {low * low, high * high};
}
inline double largest(Range a) { return std::max(a.high, -a.low); }
inline bool has_zero(Range a) { return !(a.low > 0.0) && !(a.high < 0.0); }

/// Over the angles of a range. Half turns are counted in doubles: there are few in a range, and
/// none is counted where their number or an angle has no digits behind its point.
inline Range cosine(Range a) {
  constexpr double pi = 3.141592653589793, most = 0x1p32;
  if (!(a.high - a.low < 2.0 * pi && a.low > -most && a.high < most)) return {-1.0, 1.0};
  Range c{elementary::cos(a.low), elementary::cos(a.high)};
  if (c.low > c.high) std::swap(c.low, c.high);
  for (double k = std::ceil(a.low / pi); k * pi <= a.high; k += 1.0) {
    if (k / 2.0 == std::floor(k / 2.0))
      c.high = 1.0;
    else
      c.low = -1.0;
  }
  return c;
}
inline Range sine(Range a) {
  constexpr double half_pi = 1.5707963267948966;
  return cosine(a - Range{half_pi, half_pi});
}
inline Range exponential(Range a) { return {elementary::exp(a.low), elementary::exp(a.high)}; }
inline Range hyperbolic_cosine(Range a) {
  const double low = std::max({a.low, -a.high, 0.0});
  return {sine_and_cosine_hyperbolic(low).cosine, sine_and_cosine_hyperbolic(largest(a)).cosine};
}
inline Range hyperbolic_sine(Range a) {
  return {sine_and_cosine_hyperbolic(a.low).sine, sine_and_cosine_hyperbolic(a.high).sine};
}

struct Box {
  Range re, im;
  Box() = default;
  Box(Range real, Range imaginary) : re(real), im(imaginary) {}
  Box(double c) : re{c, c} {}
  static Box all() { return {everything, everything}; }
};

inline Box operator+(const Box& a, const Box& b) { return {a.re + b.re, a.im + b.im}; }
inline Box operator-(const Box& a) { return {-a.re, -a.im}; }
inline Box operator-(const Box& a, const Box& b) { return {a.re - b.re, a.im - b.im}; }
inline Box operator*(const Box& a, const Box& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline Box hull(const Box& a, const Box& b) { return {hull(a.re, b.re), hull(a.im, b.im)}; }
inline bool has_zero(const Box& a) { return has_zero(a.re) && has_zero(a.im); }
/// The range of the modulus squared.
inline Range modulus_squared(const Box& a) { return square(a.re) + square(a.im); }
/// The largest modulus.
inline double size(const Box& a) { return std::sqrt(modulus_squared(a).high); }
inline Box disc(double radius) { return {{-radius, radius}, {-radius, radius}}; }

inline Box inverse(const Box& a) {
  const Range m = modulus_squared(a);
  if (!(m.low > 0.0)) return Box::all();
  const Range over{1.0 / m.high, 1.0 / m.low};
  return {a.re * over, -(a.im * over)};
}
inline Box square(const Box& a) { return {square(a.re) - square(a.im), 2.0 * (a.re * a.im)}; }

/// The box about all numbers of these moduli and arguments.
inline Box of_polar(Range modulus, Range argument) {
  return {modulus * cosine(argument), modulus * sine(argument)};
}
/// Arguments in (-pi, pi]; all of them where the box touches 0 or the negative axis.
inline Range argument(const Box& a) {
  constexpr double pi = 3.141592653589793;
  if (!(a.re.low > 0.0) && has_zero(a.im)) return {-pi, pi};
  const double t[] = {elementary::atan2(a.im.low, a.re.low), elementary::atan2(a.im.low, a.re.high),
                      elementary::atan2(a.im.high, a.re.low),
                      elementary::atan2(a.im.high, a.re.high)};
  return {*std::min_element(t, t + 4), *std::max_element(t, t + 4)};
}
/// Does it touch the negative axis or 0, where roots and logarithms end?
inline bool is_cut(const Box& a) { return !(a.re.low > 0.0) && has_zero(a.im); }

inline Box root(const Box& a) {
  const Range m = modulus_squared(a), t = argument(a);
  return of_polar({std::sqrt(std::sqrt(m.low)), std::sqrt(std::sqrt(m.high))},
                  {0.5 * t.low, 0.5 * t.high});
}
inline Box logarithm(const Box& a) {
  const Range m = modulus_squared(a);
  if (!(m.low > 0.0)) return Box::all();
  return {{0.5 * elementary::log(m.low), 0.5 * elementary::log(m.high)}, argument(a)};
}
inline Box exponential(const Box& a) { return of_polar(exponential(a.re), a.im); }
inline Box sine(const Box& a) {
  return {sine(a.re) * hyperbolic_cosine(a.im), cosine(a.re) * hyperbolic_sine(a.im)};
}
inline Box cosine(const Box& a) {
  return {cosine(a.re) * hyperbolic_cosine(a.im), -(sine(a.re) * hyperbolic_sine(a.im))};
}
inline Box hyperbolic_sine(const Box& a) {
  return {hyperbolic_sine(a.re) * cosine(a.im), hyperbolic_cosine(a.re) * sine(a.im)};
}
inline Box hyperbolic_cosine(const Box& a) {
  return {hyperbolic_cosine(a.re) * cosine(a.im), hyperbolic_sine(a.re) * sine(a.im)};
}
/// tanh z = (sinh 2x + i sin 2y)/(cosh 2x + cos 2y).
inline Box hyperbolic_tangent(const Box& a) {
  const Range x = 2.0 * a.re, y = 2.0 * a.im;
  const Range below = hyperbolic_cosine(x) + cosine(y);
  if (!(below.low > 0.0)) return Box::all();
  // |sinh 2x| <= cosh 2x = below - cos 2y: the quotient of ranges would lose that for large x.
  const double most = 1.0 + 1.0 / below.low;
  const Range over{1.0 / below.high, 1.0 / below.low};
  Range re = hyperbolic_sine(x) * over;
  re = {std::max(re.low, -most), std::min(re.high, most)};
  return {re, sine(y) * over};
}
inline Box power(const Box& a, int n) {
  if (n == 0) return Box(1.0);
  if (n < 0) return inverse(power(a, -n));
  if (n <= 8) {
    Box result(1.0), x = a;
    for (bool first = true; n > 0; n >>= 1, x = square(x)) {
      if (!(n & 1)) continue;
      result = first ? x : result * x;
      first = false;
    }
    return result;
  }
  const Range m = modulus_squared(a);
  const auto to = [n](double m2) {
    return m2 > 0.0 ? elementary::exp(0.5 * n * elementary::log(m2)) : 0.0;
  };
  const Range t = argument(a);
  return of_polar({to(m.low), to(m.high)}, {n * t.low, n * t.high});
}

}  // namespace carom::forces::complex_box
