#include "forces/formula_series.hpp"

#include <vector>

#include "forces/formula.hpp"

namespace carom::forces {
namespace {

using complex_box::Range;
using formula::Instruction;
using formula::Operation;
using Series = SeriesOfRanges;

constexpr std::size_t terms = std::tuple_size_v<Series>;

Series unbounded_series() {
  Series all;
  all.fill(complex_box::everything);
  return all;
}
Series of_number(double c) { return {Range{c, c}}; }
double number(std::size_t k) { return static_cast<double>(k); }

Series plus(const Series& a, const Series& b) {
  Series sum;
  for (std::size_t k = 0; k < terms; ++k) sum[k] = a[k] + b[k];
  return sum;
}
Series times(double c, Series a) {
  for (Range& r : a) r = c * r;
  return a;
}
Series times(const Series& a, const Series& b) {
  Series product;
  for (std::size_t k = 0; k < terms; ++k)
    for (std::size_t i = 0; i <= k; ++i) product[k] = product[k] + a[i] * b[k - i];
  // The first of a square is not negative.
  if (&a == &b) product[0] = square(a[0]);
  return product;
}
/// The coefficients of a' u, of which the first is 0.
Series slope(Series a) {
  for (std::size_t k = 0; k < terms; ++k) a[k] = number(k) * a[k];
  return a;
}
/// From the coefficients of f' u those of f, whose value is given.
Series integral(Range value, Series f) {
  f[0] = value;
  for (std::size_t k = 1; k < terms; ++k) f[k] = (1.0 / number(k)) * f[k];
  return f;
}

Series inverse(const Series& a) {
  if (has_zero(a[0])) return unbounded_series();
  Series g;
  g[0] = {1.0 / a[0].high, 1.0 / a[0].low};
  for (std::size_t k = 1; k < terms; ++k) {
    Range sum;
    for (std::size_t i = 1; i <= k; ++i) sum = sum + a[i] * g[k - i];
    g[k] = -(g[0] * sum);
  }
  return g;
}
/// From e' = a' e.
Series exponential(const Series& a) {
  Series e;
  e[0] = complex_box::exponential(a[0]);
  for (std::size_t k = 1; k < terms; ++k) {
    Range sum;
    for (std::size_t i = 1; i <= k; ++i) sum = sum + number(i) * (a[i] * e[k - i]);
    e[k] = (1.0 / number(k)) * sum;
  }
  return e;
}
Series logarithm(const Series& a) {
  if (!(a[0].low > 0.0)) return unbounded_series();
  return integral({elementary::log(a[0].low), elementary::log(a[0].high)},
                  times(slope(a), inverse(a)));
}
/// a^c, a > 0: from a r' = c a' r.
Series real_power(const Series& a, double c) {
  if (!(a[0].low > 0.0)) return unbounded_series();
  Series r;
  r[0] = complex_box::exponential(c * Range{elementary::log(a[0].low), elementary::log(a[0].high)});
  const Range over{1.0 / a[0].high, 1.0 / a[0].low};
  for (std::size_t k = 1; k < terms; ++k) {
    Range sum;
    for (std::size_t i = 1; i <= k; ++i)
      sum = sum + (c * number(i) - number(k - i)) * (a[i] * r[k - i]);
    r[k] = (1.0 / number(k)) * (over * sum);
  }
  return r;
}
Series whole_power(Series a, int n) {
  if (n < 0) return inverse(whole_power(a, -n));
  Series power = of_number(1.0);
  for (; n > 0; n >>= 1, a = times(a, a))
    if (n & 1) power = times(power, a);
  return power;
}
struct Pair {
  Series sine, cosine;
};
/// sin and cos (sign -1), or sinh and cosh (1): from s' = a' c and c' = sign a' s.
Pair pair_of(const Series& a, double sign, Range sine, Range cosine) {
  Pair p{{sine}, {cosine}};
  for (std::size_t k = 1; k < terms; ++k) {
    Range s, c;
    for (std::size_t i = 1; i <= k; ++i) {
      s = s + number(i) * (a[i] * p.cosine[k - i]);
      c = c + number(i) * (a[i] * p.sine[k - i]);
    }
    p.sine[k] = (1.0 / number(k)) * s;
    p.cosine[k] = (sign / number(k)) * c;
  }
  return p;
}
Pair circular(const Series& a) {
  return pair_of(a, -1.0, complex_box::sine(a[0]), complex_box::cosine(a[0]));
}
Pair hyperbolic(const Series& a) {
  return pair_of(a, 1.0, complex_box::hyperbolic_sine(a[0]), complex_box::hyperbolic_cosine(a[0]));
}
/// From (x^2 + y^2) t' = x y' - y x'.
Series angle(const Series& y, const Series& x) {
  return integral(complex_box::argument({x[0], y[0]}),
                  times(plus(times(x, slope(y)), times(-1.0, times(y, slope(x)))),
                        inverse(plus(times(x, x), times(y, y)))));
}

Series apply(const Instruction& i, const Series& a, const Series& b) {
  switch (i.operation) {
    case Operation::number:
      return of_number(i.c);
    case Operation::negative:
      return times(-1.0, a);
    case Operation::sum:
      return plus(a, b);
    case Operation::shifted:
      return plus(a, of_number(i.c));
    case Operation::difference:
      return plus(a, times(-1.0, b));
    case Operation::number_minus:
      return plus(of_number(i.c), times(-1.0, a));
    case Operation::product:
      return times(a, b);
    case Operation::multiple:
      return times(i.c, a);
    case Operation::quotient:
      return times(a, inverse(b));
    case Operation::share:
      return times(1.0 / i.c, a);
    case Operation::number_over:
      return times(i.c, inverse(a));
    case Operation::whole_power:
      return whole_power(a, i.n);
    case Operation::half_power:
      return real_power(a, i.n + 0.5);
    case Operation::real_power:
      return real_power(a, i.c);
    case Operation::power:
      return exponential(times(b, logarithm(a)));
    case Operation::root:
      return real_power(a, 0.5);
    case Operation::exp:
      return exponential(a);
    case Operation::log:
      return logarithm(a);
    case Operation::sin:
      return circular(a).sine;
    case Operation::cos:
      return circular(a).cosine;
    case Operation::tan: {
      const Pair p = circular(a);
      return times(p.sine, inverse(p.cosine));
    }
    case Operation::sinh:
      return hyperbolic(a).sine;
    case Operation::cosh:
      return hyperbolic(a).cosine;
    case Operation::tanh: {
      const Pair p = hyperbolic(a);
      return times(p.sine, inverse(p.cosine));
    }
    case Operation::abs:
      return has_zero(a[0]) ? unbounded_series() : times(a[0].low > 0.0 ? 1.0 : -1.0, a);
    case Operation::atan2:
      return angle(a, b);
    case Operation::least:
    case Operation::greatest:
      if (a[0].high < b[0].low) return i.operation == Operation::least ? a : b;
      if (b[0].high < a[0].low) return i.operation == Operation::least ? b : a;
      return unbounded_series();
  }
  return unbounded_series();
}

}  // namespace

SeriesOfRanges series_along(const TypedExpression& expression,
                            std::span<const SeriesOfRanges> variables) {
  const TypedExpression::Formula& f = expression.formula();
  std::vector<Series> slots(variables.begin(), variables.end());
  slots.reserve(f.variables + f.instructions.size());
  for (const Instruction& i : f.instructions) slots.push_back(apply(i, slots[i.a], slots[i.b]));
  return slots[f.result];
}

}  // namespace carom::forces
