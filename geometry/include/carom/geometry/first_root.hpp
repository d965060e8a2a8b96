// Where a Larmor circle most likely leaves through an ellipse: the largest root of a cubic or
// quartic, in closed form and two steps of Halley's method. One chain of + - * / and square roots
// without a branch, so that any number of lanes can follow: the same bits everywhere. What it gives
// is a number, not a decision: whether it is the root that was meant is for others to ask
// (quartic.hpp; lanes).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "carom/geometry/formulas.hpp"
#include "carom/geometry/parameter.hpp"

namespace carom::geometry {

/// A cube root to 4 %, x >= 1: a third of the exponent, and of what follows it.
struct RoughCubeRoot {
  static constexpr double third = 1.0 / 3.0;
  static constexpr std::int64_t offset = 0x2a9f7893782da1ce;
  double operator()(double x) const {
    const auto bits = std::bit_cast<std::int64_t>(x);
    return std::bit_cast<double>(static_cast<std::int64_t>(third * static_cast<double>(bits)) +
                                 offset);
  }
};

namespace detail {

/// Halley's step for a polynomial of that value, first derivative and half second derivative.
template <class Number>
constexpr Number halley(const Number& x, const Number& value, const Number& first,
                        const Number& second) {
  return x - value * first / (first * first - value * second);
}

}  // namespace detail

/// The largest real root of q3 x^3 + q2 x^2 + q1 x + q0, q3 > 0.
///
/// About its middle m it is y^3 + 3 p y - 2 r; with y = s z, s = sqrt|p| and c = r/s^3, z is the
/// largest root of z^3 -+ 3z = 2c. Three real ones: z = 2 T(w) with T the Chebyshev function of
/// index 2/3 and w^2 = (1 + c)/2, here a polynomial with the right value and slope where two roots
/// meet. Else z = t -+ 1/t, t^3 = |c| + sqrt(c^2 +- 1).
template <class Number, class CubeRoot>
[[gnu::always_inline]] inline Number largest_root(const Number& q3, const Number& q2,
                                                  const Number& q1, const Number& q0,
                                                  const CubeRoot& cube_root) {
  using std::abs;
  using std::sqrt;
  const Number zero(0.0), one(1.0), half(0.5);
  const Number inverse = one / q3, a = q2 * inverse, b = q1 * inverse;
  const Number m = Number(-1.0 / 3.0) * a;
  const Number p = Number(1.0 / 3.0) * b - m * m;
  const Number r = -half * (m * (m * (m + a) + b) + q0 * inverse);
  const Number size = abs(p), s = sqrt(size), c = r / (s * size), far = abs(c);
  const auto several = p < zero;
  const auto three = several && !(far > one);
  // Three real roots.
  const Number under = half * (one + c);
  const Number w = sqrt(detail::choose(under > zero, under, zero));
  const Number near =
      one +
      w * (Number(1.1547005383792515) +
           w * (Number(-0.2183369892) + w * (Number(0.08507240841) - w * Number(0.02147507483))));
  // One.
  const Number square = c * c + detail::choose(several, -one, one);
  const Number e = far + sqrt(detail::choose(square > zero, square, zero));
  const Number rough = cube_root(e), cube = rough * rough * rough;
  const Number t = rough * (cube + e + e) / (cube + cube + e);
  const Number beyond = t + detail::choose(several, one, -one) / t;
  const Number z = detail::choose(three, near, detail::choose(c < zero, -beyond, beyond));
  Number x = m + s * z;
  for (int i = 0; i < 2; ++i) {
    const Number third = q3 * x, second = third + q2, first = second * x + q1;
    x = detail::halley(x, first * x + q0, first + x * (third + second), second + third + third);
  }
  return x;
}

/// A root of a quartic at which it rises: the largest one if the leading coefficient is positive,
/// else, of two real roots, the smaller one. The quartic is taken as a product of two quadratics,
/// which the largest root of a cubic gives.
template <class Number, class CubeRoot>
[[gnu::always_inline]] inline Number first_rising_root(const Quartic<Number>& f,
                                                       const CubeRoot& cube_root) {
  using std::sqrt;
  const auto& q = f.q;
  const Number zero(0.0), half(0.5), two(2.0), one(1.0);
  const Number inverse = one / q[4], b = q[3] * inverse, c = q[2] * inverse, d = q[1] * inverse;
  // About its middle y^4 + p y^2 + k y + r.
  const Number m = Number(-0.25) * b;
  const Number p = c - Number(6.0) * (m * m);
  const Number k = d + m * (two * c - Number(8.0) * (m * m));
  const Number r = q[0] * inverse + m * (d + m * (c - Number(3.0) * (m * m)));
  // (y^2 + u y + ..)(y^2 - u y + ..) with z = u^2.
  const Number z = largest_root(one, two * p, p * p - Number(4.0) * r, -(k * k), cube_root);
  const Number u = sqrt(detail::choose(z > zero, z, zero)), skew = two * k / u, even = -z - two * p;
  const Number left = even + skew, right = even - skew;  // discriminants
  const Number left_root = sqrt(detail::choose(left > zero, left, zero)),
               right_root = sqrt(detail::choose(right > zero, right, zero));
  const auto falls = q[4] < zero;
  const Number of_left = half * (-u + detail::choose(falls, -left_root, left_root));
  const Number of_right = half * (u + detail::choose(falls, -right_root, right_root));
  const auto only_left = right < zero;
  const auto take_left = only_left || (left > zero && of_left > of_right);
  Number x = m + detail::choose(take_left, of_left, of_right);
  for (int i = 0; i < 2; ++i) {
    const Number c3 = q[4] * x + q[3], c2 = c3 * x + q[2], c1 = c2 * x + q[1],
                 value = c1 * x + q[0];
    const Number d3 = q[4] * x + c3, d2 = d3 * x + c2, d1 = d2 * x + c1;
    const Number e3 = q[4] * x + d3, e2 = e3 * x + d2;
    x = detail::halley(x, value, d1, e2);
  }
  return x;
}

}  // namespace carom::geometry
