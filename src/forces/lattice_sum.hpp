// The sum of a bump's copies on a lattice, as a table: near each node of a grid over the cell the
// nearest copies are added one by one, and all others together are one polynomial
// (docs/physics/forces.md bounds its error).
//
// One formula for one point and for many at once: each function maps columns of numbers, always
// with the same operations in the same order, whatever the width of the machine's vectors.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/inline.hpp"

namespace carom::forces {

/// Numbers in a register of the machine, W = 2, 4 or 8 of them.
template <int W>
struct Register {
  using Type [[gnu::vector_size(W * sizeof(double))]] = double;
  using Masks [[gnu::vector_size(W * sizeof(double))]] = std::int64_t;
};

/// Plain data, of the period 1/K in both lattice directions that the grid has: nodes at (i a + j
/// b)/K.
struct LatticeSum {
  static constexpr int most_degree = 15;

  double to_first_x = 0, to_first_y = 0, to_second_x = 0,
         to_second_y = 0;                                       ///< from x to grid units
  double first_x = 0, first_y = 0, second_x = 0, second_y = 0;  ///< a/K and b/K
  std::int64_t mask = 0;                                        ///< K - 1; K is a power of two
  int shift = 0;                                                ///< log2 K
  int near = 0;            ///< copies added one by one at each node
  int padded_near = 0;     ///< the same up to a multiple of eight
  int degree = -1;         ///< of the polynomial; -1: there is none
  std::size_t stride = 0;  ///< numbers of a node: see `nodes`
  /// For each node: x, then y, of the node seen from each near copy; then the polynomial's rows.
  /// Row j holds the coefficients of X^i Y^j, i = 0 ... 7; after all of these the rows with i = 8
  /// ... 15.
  const double* nodes = nullptr;
  bool fermi = false;
  double radius = 0, inverse_softness = 0;  ///< fermi
  double inverse_square_width = 0;          ///< gaussian
};

/// A LatticeSum with its scale: a potential.
struct LatticeField {
  LatticeSum sum;
  double height = 0, steepness = 0;  ///< steepness: what slopes of a bump are multiplied with
};

/// The place of a point on the grid, or of many.
template <class Number>
struct GridPoint {
  Number i, j;    ///< of the node, in the lowest bits
  Number dx, dy;  ///< from the node, which may be a copy in another cell
  Number X, Y;    ///< the same in units of the grid, within about 1/2
};

namespace lattice_sum {

/// Adding it rounds a number to a whole one, which the lowest bits then are.
inline constexpr double whole = 0x1.8p52;

template <class Number>
CAROM_INLINE GridPoint<Number> locate(const LatticeSum& t, const Number& x, const Number& y) {
  GridPoint<Number> p;
  p.i = (t.to_first_x * x + t.to_first_y * y) + whole;
  p.j = (t.to_second_x * x + t.to_second_y * y) + whole;
  const Number m = p.i - whole, n = p.j - whole;
  p.dx = x - (m * t.first_x + n * t.second_x);
  p.dy = y - (m * t.first_y + n * t.second_y);
  // From the node, so that their error is small against themselves.
  p.X = t.to_first_x * p.dx + t.to_first_y * p.dy;
  p.Y = t.to_second_x * p.dx + t.to_second_y * p.dy;
  return p;
}

CAROM_INLINE const double* node_at(const LatticeSum& t, double i, double j) {
  std::int64_t bits_i, bits_j;
  std::memcpy(&bits_i, &i, sizeof i);
  std::memcpy(&bits_j, &j, sizeof j);
  return t.nodes +
         static_cast<std::size_t>(((bits_i & t.mask) << t.shift) | (bits_j & t.mask)) * t.stride;
}

CAROM_INLINE void load(auto& to, const double* from) { std::memcpy(&to, from, sizeof to); }

/// Two times eight numbers in registers, each eight added up: halves to halves, so that the width
/// of registers does not matter.
template <int W>
CAROM_INLINE void totals(const typename Register<W>::Type* a, const typename Register<W>::Type* b,
                         double& total_a, double& total_b) {
  if constexpr (W == 2) {
    const auto s = (a[0] + a[2]) + (a[1] + a[3]), t = (b[0] + b[2]) + (b[1] + b[3]);
    total_a = s[0] + s[1];
    total_b = t[0] + t[1];
  } else {
    typename Register<4>::Type s, t;
    if constexpr (W == 4) {
      s = a[0] + a[1];
      t = b[0] + b[1];
    } else {
      s = __builtin_shufflevector(a[0], a[0], 0, 1, 2, 3) +
          __builtin_shufflevector(a[0], a[0], 4, 5, 6, 7);
      t = __builtin_shufflevector(b[0], b[0], 0, 1, 2, 3) +
          __builtin_shufflevector(b[0], b[0], 4, 5, 6, 7);
    }
    const auto sum =
        __builtin_shufflevector(s, t, 0, 1, 4, 5) + __builtin_shufflevector(s, t, 2, 3, 6, 7);
    total_a = sum[0] + sum[1];
    total_b = sum[2] + sum[3];
  }
}

/// Sixteen masks of which the first eight are set: eight from number 8 - n on choose the first n of
/// eight.
alignas(64) inline constexpr std::int64_t first_masks[16] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                             0,  0,  0,  0,  0,  0,  0,  0};
/// Which factors X, X^2, X^4 the powers X^0 ... X^7 have, and the powers of their slopes.
alignas(64) inline constexpr std::int64_t power_masks[3][8] = {
    {0, -1, 0, -1, 0, -1, 0, -1}, {0, 0, -1, -1, 0, 0, -1, -1}, {0, 0, 0, 0, -1, -1, -1, -1}};
alignas(64) inline constexpr std::int64_t slope_masks[3][8] = {
    {0, 0, -1, 0, -1, 0, -1, 0}, {0, 0, 0, -1, -1, 0, 0, -1}, {0, 0, 0, 0, 0, -1, -1, -1}};
alignas(64) inline constexpr double exponents[8] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};

/// The products of those factors.
template <int W>
CAROM_INLINE void products(const std::int64_t masks[3][8], int from, double x, double x2, double x4,
                           typename Register<W>::Type& product) {
  using Numbers = typename Register<W>::Type;
  typename Register<W>::Masks with[3];
  for (int k = 0; k < 3; ++k) std::memcpy(&with[k], masks[k] + from, sizeof with[k]);
  const Numbers one = Numbers{} + 1.0;
  product = ((with[0] ? Numbers{} + x : one) * (with[1] ? Numbers{} + x2 : one)) *
            (with[2] ? Numbers{} + x4 : one);
}

template <class Number>
CAROM_INLINE Number at_most(const Number& x, double most) {
  if constexpr (std::is_same_v<Number, double>) {
    return x < most ? x : most;
  } else {
    Number result = x;
    where(!(x < most), result) = most;
    return result;
  }
}

/// The exponent that exp is to be taken of, and the distance that it belongs to.
template <class Number>
CAROM_INLINE void fermi_exponent(const LatticeSum& t, const Number& dx, const Number& dy, Number& r,
                                 Number& e) {
  using std::sqrt;
  // The smallest normal number keeps 1/r finite at a centre, where the force has no direction.
  r = sqrt(dx * dx + dy * dy + 0x1p-1022);
  // The exponential of a bump of 1e-130 stays finite, lest 0 times infinity be no number.
  e = at_most((r - t.radius) * t.inverse_softness, 300.0);
}

template <class Number>
CAROM_INLINE Number gaussian_exponent(const LatticeSum& t, const Number& dx, const Number& dy) {
  return (-0.5 * t.inverse_square_width) * (dx * dx + dy * dy);
}

/// The bump's value q = 1/(1 + e), and f = q^2 e/r: its force is f d/softness. One division serves
/// both.
template <class Number>
CAROM_INLINE void fermi_bump(const Number& r, const Number& e, Number& q, Number& f) {
  const Number one = 1.0 + e;
  const Number inverse = 1.0 / (r * one);
  q = r * inverse;
  f = q * q * e * (one * inverse);
}

struct Slopes {
  double value, X, Y;  ///< of the polynomial; by X and by Y
};

/// Rows by Horner's rule in Y, for eight powers of X at a time; then the sums over these.
template <int W>
CAROM_INLINE Slopes polynomial(const double* rows, int degree, double X, double Y) {
  using Numbers = typename Register<W>::Type;
  constexpr int pieces = 8 / W;
  const double x2 = X * X, x4 = x2 * x2, x8 = x4 * x4, factor = 8.0 * ((X * x2) * x4);
  Numbers a[pieces], b[pieces], row, values[pieces], by_x[pieces], by_y[pieces];
  // One register's numbers, from row `top` down to 0: their value, and its slope by Y.
  const auto horner = [&](const double* from, int top, Numbers& value, Numbers& by) {
    load(value, from + 8 * top);
    by = Numbers{};
#pragma GCC unroll 4
    for (int j = top - 1; j >= 0; --j) {
      by = by * Y + value;
      load(row, from + 8 * j);
      value = value * Y + row;
    }
  };
#pragma GCC unroll 4
  for (int p = 0; p < pieces; ++p) horner(rows + W * p, degree, a[p], b[p]);
  const double* high = rows + 8 * (degree + 1);
#pragma GCC unroll 4
  for (int p = 0; p < pieces; ++p) {
    Numbers powers, slopes, factors;
    products<W>(power_masks, W * p, X, x2, x4, powers);
    products<W>(slope_masks, W * p, X, x2, x4, slopes);
    load(factors, exponents + W * p);
    slopes = factors * slopes;
    if (degree >= 8) {
      Numbers c, d;
      horner(high + W * p, degree - 8, c, d);
      a[p] = a[p] + x8 * c;
      b[p] = b[p] + x8 * d;
      by_x[p] = slopes * a[p] + powers * (factor * c);
    } else {
      by_x[p] = slopes * a[p];
    }
    values[p] = powers * a[p];
    by_y[p] = powers * b[p];
  }
  Slopes result;
  double unused;
  totals<W>(by_x, by_y, result.X, result.Y);
  totals<W>(values, values, result.value, unused);
  return result;
}

/// -gradient, from the slopes in units of the grid.
template <class Number>
CAROM_INLINE void add_slopes(const LatticeSum& t, const Number& by_X, const Number& by_Y,
                             Number& fx, Number& fy) {
  fx = fx - (by_X * t.to_first_x + by_Y * t.to_second_x);
  fy = fy - (by_X * t.to_first_y + by_Y * t.to_second_y);
}

}  // namespace lattice_sum
}  // namespace carom::forces
