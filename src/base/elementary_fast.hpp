// The quick way of elementary functions: each result as the sum of two doubles with a bound of its
// error, from which the right double is read where the bound allows. docs/physics/elementary.md
// derives the bounds.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "inline.hpp"

namespace carom::base::fast {

// What the formulas need beside + - * /, of one number (double) or of a register of them (a vector
// of the compiler's).
template <class Number>
struct BitsOf {
  typedef std::uint64_t type __attribute__((vector_size(sizeof(Number))));
};
template <>
struct BitsOf<double> {
  using type = std::uint64_t;
};
template <class Number>
using Bits = typename BitsOf<Number>::type;

template <class Number>
CAROM_INLINE Number all(double x) {
  return Number{} + x;
}
template <class Number>
CAROM_INLINE Bits<Number> bits_of(const Number& x) {
  return std::bit_cast<Bits<Number>>(x);
}
template <class Number>
CAROM_INLINE Number number_of(const Bits<Number>& bits) {
  return std::bit_cast<Number>(bits);
}
template <class Mask, class Number>
CAROM_INLINE Number chosen(const Mask& condition, const Number& yes, const Number& no) {
  return condition ? yes : no;
}
inline constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63;
template <class Number>
CAROM_INLINE Number size_of(const Number& x) {
  return number_of<Number>(bits_of(x) & ~sign_bit);
}
template <class Number>
CAROM_INLINE Number with_sign(const Number& size, const Number& sign) {
  return number_of<Number>(bits_of(size) | (bits_of(sign) & sign_bit));
}
template <class Number>
CAROM_INLINE Number fused(const Number& a, const Number& b, const Number& c) {
  if constexpr (std::is_same_v<Number, double>) {
    return __builtin_fma(a, b, c);
  } else {
    Number r;
    for (std::size_t i = 0; i < sizeof(Number) / 8; ++i) r[i] = __builtin_fma(a[i], b[i], c[i]);
    return r;
  }
}
template <class Number, std::size_t size>
CAROM_INLINE Number entry(const std::array<double, size>& table, const Bits<Number>& index) {
  if constexpr (std::is_same_v<Number, double>) {
    return table[index];
#if !defined(__clang__)
  } else if constexpr (size == 16 && sizeof(Number) == 64) {
    Number first, second;
    std::memcpy(&first, table.data(), sizeof first);
    std::memcpy(&second, table.data() + 8, sizeof second);
    return __builtin_shuffle(first, second, index);
#endif
  } else {
    Number r;
    for (std::size_t i = 0; i < sizeof(Number) / 8; ++i) r[i] = table[index[i]];
    return r;
  }
}

/// high + low.
template <class Number>
struct Two {
  Number high, low;
};
template <class Number>
CAROM_INLINE Two<Number> quick_sum(const Number& a, const Number& b) {  // |a| >= |b|, or a = 0
  const Number s = a + b;
  return {s, b - (s - a)};
}
template <class Number>
CAROM_INLINE Two<Number> sum(const Number& a, const Number& b) {
  const Number s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}

/// Exact products by the processor's instruction, or by halves of the factors (Dekker 1971): the
/// same numbers.
struct Fusing {
  template <class Number>
  CAROM_INLINE static Two<Number> product(const Number& a, const Number& b) {
    const Number p = a * b;
    return {p, fused(a, b, -p)};
  }
  /// a b + c where it matters little how it is rounded.
  template <class Number>
  CAROM_INLINE static Number about(const Number& a, const Number& b, const Number& c) {
    return fused(a, b, c);
  }
  /// x - k c where that is a double.
  template <class Number>
  CAROM_INLINE static Number difference(const Number& x, const Number& k, double c) {
    return fused(k, all<Number>(-c), x);
  }
};
struct Splitting {
  template <class Number>
  CAROM_INLINE static Two<Number> product(const Number& a, const Number& b) {
    const Number p = a * b, ca = 134217729.0 * a, cb = 134217729.0 * b;  // 2^27 + 1
    const Number a1 = ca - (ca - a), b1 = cb - (cb - b), a2 = a - a1, b2 = b - b1;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
  }
  template <class Number>
  CAROM_INLINE static Number about(const Number& a, const Number& b, const Number& c) {
    return a * b + c;
  }
  template <class Number>
  CAROM_INLINE static Number difference(const Number& x, const Number& k, double c) {
    const Two<Number> p = product(k, all<Number>(c));
    return (x - p.high) - p.low;
  }
};
/// c[0] + c[1] x + c[2] x^2 + ..., in pairs.
template <class Products, std::size_t count, class Number>
CAROM_INLINE Number polynomial(const double (&c)[count], const Number& x, const Number& x2) {
  constexpr std::size_t last = (count - 1) / 2 * 2;
  Number sum = last + 1 < count
                   ? Products::about(all<Number>(c[count - 1]), x, all<Number>(c[last]))
                   : all<Number>(c[last]);
#pragma GCC unroll 8
  for (std::size_t i = last; i > 0; i -= 2)
    sum =
        Products::about(sum, x2, Products::about(all<Number>(c[i - 1]), x, all<Number>(c[i - 2])));
  return sum;
}

/// A value between two doubles whose distance is `spread`: where that is zero, it is the double
/// next to the truth.
template <class Number>
struct Result {
  Number value, spread;
};
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// high + low rounded, where low is right to `error`.
template <class Number>
CAROM_INLINE Result<Number> rounded(const Number& high, const Number& low, const Number& error) {
  const Number up = high + (low + error), down = high + (low - error);
  return {up, up - down};
}

/// x + shift holds x rounded to a whole number in its last digits.
inline constexpr double shift = 0x1.8p52;

// ---- exp ----

/// 2^(j/16) in two doubles.
struct ExpTable {
  alignas(64) std::array<double, 16> high, low;
};
const ExpTable& exp_table();

inline constexpr double steps_of_exp = 0x1.71547652b82fep+4;  // 16 / ln 2
inline constexpr double step_of_exp = 0x1.62e42fefa39efp-5, step_of_exp_low = 0x1.abc9e3b39803fp-60;
inline constexpr double exp_error = 0x1p-68;
/// Between these exp x is neither subnormal nor infinite.
inline constexpr double least_exp = -708.25, largest_exp = 709.75;
/// Below, exp x is less than half the least double.
inline constexpr double vanishing_exp = -746.0;

/// exp x = 2^power (high + low) for |x| < 746, up to exp_error.
template <class Number>
struct Exponential {
  Number high, low;
  Bits<Number> power;  // of two's complement
};
template <class Products, class Number>
CAROM_INLINE Exponential<Number> exponential(const ExpTable& table, const Number& x) {
  const Number shifted = Products::about(x, all<Number>(steps_of_exp), all<Number>(shift));
  const Bits<Number> digits = bits_of(shifted);
  const Number k = shifted - shift;
  const Two<Number> r =
      quick_sum<Number>(Products::difference(x, k, step_of_exp), k * -step_of_exp_low);
  // e^r - 1 = r + r^2/2 + ..., of which the first two are exact.
  const Number h = r.high, h2 = h * h;
  const Two<Number> square = Products::template product<Number>(0.5 * h, h),
                    most = quick_sum(h, square.high);
  constexpr double c[] = {1.0 / 6,    1.0 / 24,    1.0 / 120,   1.0 / 720,
                          1.0 / 5040, 1.0 / 40320, 1.0 / 362880};
  const Number higher =
      Products::template about<Number>(h * h2, polynomial<Products>(c, h, h2), square.low);
  const Number least = most.low + (Products::about(r.low, h, r.low) + higher);
  const Number t = entry<Number>(table.high, digits & 15),
               t_low = entry<Number>(table.low, digits & 15);
  const Two<Number> product = Products::product(t, most.high), whole = quick_sum(t, product.high);
  const Number tail = Products::about(t_low, most.high, t_low) + product.low;
  const Number low = whole.low + Products::about(t, least, tail);
  return {whole.high, low, (digits >> 4) - (bits_of(shift) >> 4)};
}

/// Known between least_exp and largest_exp, and below vanishing_exp.
template <class Products, class Number>
CAROM_INLINE Result<Number> exp(const ExpTable& table, const Number& x) {
  const Exponential<Number> e = exponential<Products>(table, x);
  const Result<Number> r = rounded(e.high, e.low, all<Number>(exp_error));
  const Number value = number_of<Number>(bits_of(r.value) + (e.power << 52));
  const Number none = all<Number>(0.0);
  const auto nothing = x < vanishing_exp;
  return {chosen(nothing, none, value),
          chosen(size_of(x - 0.5 * (largest_exp + least_exp)) < 0.5 * (largest_exp - least_exp),
                 r.spread, chosen(nothing, none, all<Number>(unknown)))};
}

/// exp x for -746 < x < least_exp, rounded where the last digit of subnormal numbers is.
template <class Products>
CAROM_INLINE Result<double> small_exp(const ExpTable& table, double x) {
  const auto e = exponential<Products, double>(table, x);
  const int places = 1074 + static_cast<int>(static_cast<std::int64_t>(e.power));
  const double last = std::bit_cast<double>(static_cast<std::uint64_t>(1023 - places) << 52);
  const double above = 0x1p52 * last;  // its last digit is that one
  const Two<double> sum = quick_sum(above, e.high);
  const Result<double> r = rounded(sum.high, sum.low + e.low, exp_error);
  return {(r.value - above) / last * 0x1p-1074, places < 52 ? r.spread : unknown};
}

// ---- log ----

/// For x = 2^e (1 + i/256 + ...): c near 1/(1 + i/256 + ...), a multiple of 2^-9, and -log c. From
/// `halves` on the half of it is taken, -log 2c, and e + 1: so log x near 1 has no large parts.
struct LogTable {
  std::array<double, 256> c, high, low;
};
const LogTable& log_table();
inline constexpr std::uint64_t halves = 106;  // 256 (sqrt 2 - 1)

/// ln 2: the first number has so few digits that its products with exponents are doubles.
inline constexpr double ln2_high = 0x1.62e42fefa3800p-1, ln2_low = 0x1.ef35793c7673p-45;

/// For x > 0, normal and finite.
template <class Products>
CAROM_INLINE Result<double> log(const LogTable& table, double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t i = bits >> 44 & 255;
  const double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
  const double e =
      static_cast<double>(static_cast<std::int64_t>(bits >> 52) - (i < halves ? 1023 : 1022));
  const Two<double> scaled = Products::product(m, table.c[i]);
  const double r = (scaled.high - 1.0) + scaled.low;  // |r| < 2^-8, exactly
  const Two<double> square = Products::product(0.5 * r, r);
  const Two<double> a = sum(e * ln2_high, table.high[i]);
  const Two<double> b = sum(a.high, r);
  const Two<double> d = sum(b.high, -square.high);
  const double r2 = r * r;
  constexpr double k[] = {1.0 / 3, -1.0 / 4, 1.0 / 5, -1.0 / 6,
                          1.0 / 7, -1.0 / 8, 1.0 / 9, -1.0 / 10};
  const double higher = r * r2 * polynomial<Products>(k, r, r2);
  const double least =
      (e * ln2_low + table.low[i] - square.low) + (a.low + (b.low + d.low)) + higher;
  const Two<double> whole = quick_sum(d.high, least);
  return rounded(whole.high, whole.low, a.high == 0.0 ? std::fabs(r) * 0x1p-66 : 0x1p-71);
}

// ---- sin and cos ----

/// sin(k pi/256) in two doubles; cos(k pi/256) is that of 128 - k.
struct SineTable {
  std::array<double, 129> high, low;
};
const SineTable& sine_table();

inline constexpr double steps_of_turn = 0x1.45f306dc9c883p+6;  // 256 / pi
inline constexpr double step_of_turn[] = {0x1.921fb54442d18p-7, 0x1.1a62633145c07p-61,
                                          -0x1.f1976b7ed8fbcp-117};
/// Up to here the remainder is right to 2^-112.
inline constexpr double largest_angle = 0x1p36;
/// Below, sin x is x and cos x is 1, rounded.
inline constexpr double least_angle = 0x1p-27;

/// The parts of x = (128 quadrant + k) pi/256 + r.
struct Angle {
  std::uint64_t quadrant;
  double sine, sine_low, cosine, cosine_low;  // of k pi/256
  Two<double> r, half_square;                 // r, r^2/2
  double sine_higher, cosine_higher;          // sin r - r, cos r - 1 + r^2/2
};
template <class Products>
CAROM_INLINE Angle reduced(const SineTable& table, double x) {
  const double shifted = x * steps_of_turn + shift;
  const std::uint64_t digits = bits_of(shifted), k = digits & 127;
  Angle a;
  a.quadrant = digits >> 7 & 3;
  a.sine = table.high[k], a.sine_low = table.low[k];
  a.cosine = table.high[128 - k], a.cosine_low = table.low[128 - k];
  const double n = shifted - shift;
  const Two<double> rest = Products::product(n, step_of_turn[1]);
  a.r = sum(Products::difference(x, n, step_of_turn[0]), -rest.high);
  a.r.low -= rest.low + n * step_of_turn[2];
  const double r = a.r.high, r2 = r * r;
  a.half_square = Products::product(0.5 * r, r);
  a.half_square.low += r * a.r.low;
  a.sine_higher = r * r2 * (-1.0 / 6 + r2 * (1.0 / 120 - r2 * (1.0 / 5040)));
  a.cosine_higher = r2 * r2 * (1.0 / 24 + r2 * (-1.0 / 720 + r2 * (1.0 / 40320)));
  return a;
}
/// s cos r + c sin r for s and c in two doubles each.
template <class Products>
CAROM_INLINE Result<double> turned(const Angle& a, double s, double s_low, double c, double c_low) {
  const Two<double> first = Products::product(c, a.r.high),
                    second = Products::product(s, a.half_square.high);
  const Two<double> b = quick_sum(s, first.high), d = quick_sum(b.high, -second.high);
  const double higher = c * a.sine_higher + s * a.cosine_higher;
  const double corrections = (s_low - s_low * a.half_square.high) + c_low * a.r.high + c * a.r.low -
                             s * a.half_square.low + (first.low - second.low);
  const Two<double> whole = quick_sum(d.high, (b.low + d.low) + corrections + higher);
  // By pi/2 the first number may be a rounding's distance from a zero.
  const double error = s == 0.0 ? std::fabs(a.r.high) * 0x1p-66 : 0x1p-72;
  Result<double> result = rounded(whole.high, whole.low, error);
  if (s == 0.0 && std::fabs(a.r.high) < 0x1p-42) result.spread = unknown;
  return result;
}
template <class Products>
CAROM_INLINE Result<double> sine(const Angle& a) {
  const Result<double> r = a.quadrant & 1
                               ? turned<Products>(a, a.cosine, a.cosine_low, -a.sine, -a.sine_low)
                               : turned<Products>(a, a.sine, a.sine_low, a.cosine, a.cosine_low);
  return {a.quadrant & 2 ? -r.value : r.value, r.spread};
}
template <class Products>
CAROM_INLINE Result<double> cosine(Angle a) {
  a.quadrant += 1;
  return sine<Products>(a);
}

// ---- atan2 ----

/// atan(k/64) in two doubles, up to k = 64; the rest is read where a side is no number.
struct AngleTable {
  std::array<double, 128> high, low;
};
const AngleTable& angle_table();

inline constexpr double half_turn[] = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53},
                        quarter_turn[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
/// Between these all that atan2 computes is exact that should be.
inline constexpr double least_side = 0x1p-400, largest_side = 0x1p400;

template <class Number>
CAROM_INLINE Two<Number> from(const double (&turn)[2], const Two<Number>& a) {
  const Two<Number> s = quick_sum<Number>(all<Number>(turn[0]), -a.high);
  return quick_sum<Number>(s.high, s.low + (turn[1] - a.low));
}

template <class Products, class Number>
CAROM_INLINE Result<Number> atan2(const AngleTable& table, const Number& y, const Number& x) {
  const Number ay = size_of(y), ax = size_of(x);
  const auto steep = ay > ax, behind = x < 0.0;
  const Number n = chosen(steep, ax, ay), d = chosen(steep, ay, ax);
  const Number rough = n / d * 64.0 + shift;
  const Number c = (rough - shift) * (1.0 / 64);  // n/d to 2^-7
  // u = (n - c d)/(d + c n), with what its parts lost.
  const Two<Number> cd = Products::product(c, d), cn = Products::product(c, n),
                    above = sum<Number>(n - cd.high, -cd.low), below = quick_sum(d, cn.high);
  const Number below_low = below.low + cn.low, u = above.high / below.high;
  const Two<Number> back = Products::product(u, below.high);
  const Number u_low =
      (((above.high - back.high) - back.low) + (above.low - u * below_low)) / below.high;
  const Number u2 = u * u;
  const Number higher =
      u * u2 * (-1.0 / 3 + u2 * (1.0 / 5 + u2 * (-1.0 / 7 + u2 * (1.0 / 9 - u2 * (1.0 / 11)))));
  const Bits<Number> k = bits_of(rough) & 127;
  const Two<Number> near = quick_sum(entry<Number>(table.high, k), u);
  const Two<Number> angle =
      quick_sum<Number>(near.high, near.low + (entry<Number>(table.low, k) + u_low + higher));
  // Then into its octant.
  const Two<Number> flat = from(quarter_turn, angle);
  const Two<Number> one{chosen(steep, flat.high, angle.high), chosen(steep, flat.low, angle.low)};
  const Two<Number> far = from(half_turn, one);
  const Two<Number> whole{chosen(behind, far.high, one.high), chosen(behind, far.low, one.low)};
  const auto large = (c != 0.0) | steep | behind;
  const Result<Number> r =
      rounded<Number>(whole.high, whole.low, chosen(large, all<Number>(0x1p-70), u * 0x1p-66));
  const Number known = chosen(d < largest_side, r.spread, all<Number>(unknown));
  return {with_sign(r.value, y), chosen(n > least_side, known, all<Number>(unknown))};
}

}  // namespace carom::base::fast
