// The angle of a direction in the upper half plane: what a Larmor flight's time is made of.
#pragma once

#include <cmath>

#include "base/pair.hpp"

namespace carom::base {

namespace detail {

// The angles by which a direction is turned back, in two doubles: by 0 to 4 steps, and, of a
// direction (-x, y), those from pi. The rest is never read.
alignas(64) inline constexpr double angle_high[16] = {0.0,
                                                      0x1.dac670561bb4fp-2,
                                                      0x1.921fb54442d18p-1,
                                                      0x1.1b6e192ebbe44p+0,
                                                      0x1.921fb54442d18p+0,
                                                      0x1.921fb54442d18p+1,
                                                      0x1.56c6e7397f5aep+1,
                                                      0x1.2d97c7f3321d2p+1,
                                                      0x1.0468a8ace4df6p+1,
                                                      0x1.921fb54442d18p+0};
alignas(64) inline constexpr double angle_low[16] = {0.0,
                                                     0x1.a2b7f222f65e2p-56,
                                                     0x1.1a62633145c07p-55,
                                                     0x1.b1b466a88828ep-54,
                                                     0x1.1a62633145c07p-54,
                                                     0x1.1a62633145c07p-53,
                                                     0x1.660b64ece6f4bp-53,
                                                     0x1.a79394c9e8a0ap-54,
                                                     0x1.0620bf7406affp-55,
                                                     0x1.1a62633145c07p-54};
/// The steps are taken where y/x exceeds these.
inline constexpr double angle_steps[4] = {7.0 / 16, 11.0 / 16, 16.0 / 11, 16.0 / 7};
inline constexpr int angle_from_pi = 5;

// Coefficients of P, even and odd powers of q^2.
inline constexpr double angle_even[6] = {-0x1.5555555555552p-2, -0x1.24924924462fap-3,
                                         -0x1.745d11d4b1719p-4, -0x1.110912a17bc76p-4,
                                         -0x1.a9ffe66c54df0p-5, -0x1.0584e6c76329bp-5};
inline constexpr double angle_odd[6] = {0x1.9999999998fecp-3, 0x1.c71c71a18e303p-4,
                                        0x1.3b13304eac468p-4, 0x1.e1336c56408c3p-5,
                                        0x1.6b2e038cbe2adp-5, 0x1.c0e68ac8523b8p-7};

/// Every other power of a polynomial at z: `square` is z^2.
template <class Number, class Coefficient>
[[gnu::always_inline]] inline Number powers(const Coefficient (&c)[6], const Number& square,
                                            const Number& fourth) {
  return (c[0] + square * c[1]) +
         fourth * ((c[2] + square * c[3]) + fourth * (c[4] + square * c[5]));
}
/// The angle whose tangent is q beyond that of (high, low), from the two halves of P(z), z = q^2.
template <class Number>
[[gnu::always_inline]] inline Number angle_beyond(const Number& high, const Number& low,
                                                  const Number& q, const Number& z,
                                                  const Number& even, const Number& odd) {
  return high + ((low + q) + (q * z) * (even + z * odd));
}

}  // namespace detail

/// The angle in [0, pi] of the direction (x, y), y > 0, both finite and of moderate size:
/// within 1.6 units in the last place. One chain of + - * / without a branch, an order of
/// operations that any number of lanes can follow: the same bits everywhere, at a fifth of the time
/// of atan2.
///
/// The direction (|x|, y) is turned back by the nearest of five angles, whose tangents are 0, 1/2,
/// 1, 2 and infinity; what remains has a tangent q with |q| <= 7/16, and atan q = q + q^3 P(q^2). P
/// is the minimax polynomial for the relative error: 9e-19 with its coefficients as written.
/// Errors, u = 2^-53: turning costs nothing but the sum in the denominator (the factors are 0, 1
/// and 2, and the numerator's difference is exact, its terms lying within a factor 2 of each
/// other); so q errs by half a unit in its last place without a turn, and by 2u after one by less
/// than a right angle, where |q| < 0.19. q^3 P adds 0.3u q at most, the last sum half a unit. An
/// angle below 7/16: half a unit of the sum, 0.1 of q^3 P, and half a unit of q, which counts twice
/// where q lies just above a power of two: 1.6. All others: at most 1.1.
[[gnu::always_inline]] inline double angle(double x, double y) {
  using namespace detail;
  const double width = std::fabs(x);
  const Pair w = both(width), h = both(y);
  const PairMask half = w * angle_steps[0] < h, one = w * angle_steps[1] < h,
                 two = w * angle_steps[2] < h, right = w * angle_steps[3] < h;
  // Numerator and denominator of q after each of the turns.
  const Pair along{y, width}, across{-width, y};
  const Pair turned = one ? (two ? (right ? across : along + (across + across)) : along + across)
                          : (half ? (along + along) + across : along);
  const bool back = std::signbit(x);
  const double quotient = turned[0] / turned[1], q = back ? -quotient : quotient;
  const auto steps = half + one + two + right;
  const auto centre = (back ? angle_from_pi : 0) - steps[0];
  const double z = q * q;
  static constexpr Pair coefficients[6] = {
      {angle_even[0], angle_odd[0]}, {angle_even[1], angle_odd[1]}, {angle_even[2], angle_odd[2]},
      {angle_even[3], angle_odd[3]}, {angle_even[4], angle_odd[4]}, {angle_even[5], angle_odd[5]}};
  const Pair square = both(z * z), p = powers(coefficients, square, square * square);
  return angle_beyond(angle_high[centre], angle_low[centre], q, z, p[0], p[1]);
}

}  // namespace carom::base
