// The sum of a bump's copies on a lattice, as a table: near each node of a grid over the cell the nearest copies
// are added one by one, and all others together are one polynomial (docs/physics/forces.md bounds its error).
//
// One formula for one point and for many at once: each function maps columns of numbers, always with the same
// operations in the same order, whatever the width of the machine's vectors.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#define CAROM_INLINE [[gnu::always_inline]] inline

namespace carom {

/// Eight numbers, which the compiler maps to the registers there are.
using Eight [[gnu::vector_size(64)]] = double;
using EightMasks [[gnu::vector_size(64)]] = std::int64_t;

/// Plain data, of the period 1/K in both lattice directions that the grid has: nodes at (i a + j b)/K.
struct LatticeSum {
  static constexpr int most_degree = 15;

  double to_first_x = 0, to_first_y = 0, to_second_x = 0, to_second_y = 0;  ///< from x to grid units
  double first_x = 0, first_y = 0, second_x = 0, second_y = 0;              ///< a/K and b/K
  std::int64_t mask = 0;       ///< K - 1; K is a power of two
  int shift = 0;               ///< log2 K
  int near = 0;                ///< copies added one by one at each node
  int padded_near = 0;         ///< the same up to a multiple of eight
  int degree = -1;             ///< of the polynomial; -1: there is none
  std::size_t stride = 0;      ///< numbers of a node: see `nodes`
  /// Of each node: x, then y, of the node seen from each near copy; then the polynomial's rows. Row j holds
  /// the coefficients of X^i Y^j, i = 0 ... 7; after all of these the rows with i = 8 ... 15.
  const double* nodes = nullptr;
  bool fermi = false;
  double radius = 0, inverse_softness = 0;  ///< fermi
  double inverse_square_width = 0;          ///< gaussian

  const double* rows(std::size_t node) const {
    return nodes + node * stride + 2 * static_cast<std::size_t>(padded_near);
  }
};

/// Where points lie on the grid.
struct GridPoint {
  std::size_t node;
  double dx, dy;  ///< from the node, which may be a copy in another cell
  double X, Y;    ///< the same in units of the grid, within about 1/2
};

namespace lattice_sum {

/// Adding it rounds a number to a whole one, which the lowest bits then are.
inline constexpr double whole = 0x1.8p52;

CAROM_INLINE GridPoint locate(const LatticeSum& t, double x, double y) {
  const double first = t.to_first_x * x + t.to_first_y * y, second = t.to_second_x * x + t.to_second_y * y;
  const double i = first + whole, j = second + whole;
  const double m = i - whole, n = j - whole;
  std::int64_t bits_i, bits_j;
  std::memcpy(&bits_i, &i, sizeof i);
  std::memcpy(&bits_j, &j, sizeof j);
  GridPoint p;
  p.node = static_cast<std::size_t>(((bits_i & t.mask) << t.shift) | (bits_j & t.mask));
  p.dx = x - (m * t.first_x + n * t.second_x);
  p.dy = y - (m * t.first_y + n * t.second_y);
  // From the node, so that their error is small against themselves.
  p.X = t.to_first_x * p.dx + t.to_first_y * p.dy;
  p.Y = t.to_second_x * p.dx + t.to_second_y * p.dy;
  return p;
}

/// Eight numbers to one: halves are added to halves.
CAROM_INLINE double total(const Eight& s) {
  return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

CAROM_INLINE void load(Eight& to, const double* from) { std::memcpy(&to, from, sizeof to); }

/// The exponent that exp is to be taken of, and the distance that it belongs to.
CAROM_INLINE void fermi_exponent(const LatticeSum& t, double dx, double dy, double& r, double& e) {
  // The smallest normal number keeps 1/r finite at a centre, where the force has no direction.
  r = std::sqrt(dx * dx + dy * dy + 0x1p-1022);
  // Where a bump is 1e-130 its exponential stays finite, lest 0 times infinity be no number.
  const double exponent = (r - t.radius) * t.inverse_softness;
  e = exponent < 300.0 ? exponent : 300.0;
}

CAROM_INLINE double gaussian_exponent(const LatticeSum& t, double dx, double dy) {
  return (-0.5 * t.inverse_square_width) * (dx * dx + dy * dy);
}

/// The bump's value q = 1/(1 + e), and f = q^2 e/r: its force is f d/softness. One division serves both.
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
CAROM_INLINE Slopes polynomial(const double* rows, int degree, double X, double Y) {
  Eight a, b{}, row;
  load(a, rows + 8 * degree);
  for (int j = degree - 1; j >= 0; --j) {
    b = b * Y + a;
    load(row, rows + 8 * j);
    a = a * Y + row;
  }
  const double x2 = X * X, x4 = x2 * x2, x3 = x2 * X, x5 = x4 * X, x6 = x4 * x2, x7 = x4 * x3;
  const Eight powers = {1.0, X, x2, x3, x4, x5, x6, x7};
  const Eight slopes = {0.0, 1.0, 2.0 * X, 3.0 * x2, 4.0 * x3, 5.0 * x4, 6.0 * x5, 7.0 * x6};
  Eight by_x = slopes * a;
  if (degree >= 8) {
    const double* high = rows + 8 * (degree + 1);
    Eight c, d{};
    load(c, high + 8 * (degree - 8));
    for (int j = degree - 9; j >= 0; --j) {
      d = d * Y + c;
      load(row, high + 8 * j);
      c = c * Y + row;
    }
    const double x8 = x4 * x4;
    const Eight upper = x8 * c;
    by_x = slopes * (a + upper) + powers * ((8.0 * x7) * c);
    a = a + upper;
    b = b + x8 * d;
  }
  const Eight values = powers * a, by_y = powers * b;
  return {total(values), total(by_x), total(by_y)};
}

/// -gradient, from the slopes in units of the grid.
CAROM_INLINE void add_slopes(const LatticeSum& t, double by_X, double by_Y, double& fx, double& fy) {
  fx = fx - (by_X * t.to_first_x + by_Y * t.to_second_x);
  fy = fy - (by_X * t.to_first_y + by_Y * t.to_second_y);
}

}  // namespace lattice_sum
}  // namespace carom
