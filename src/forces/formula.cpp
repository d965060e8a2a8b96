// Runs the list, with dual numbers: a value and its derivatives go together from slot to slot.
#include "forces/formula.hpp"

#include <array>
#include <cmath>

#include "carom/base/elementary.hpp"
#include "forces/hyperbolic.hpp"

namespace carom {

using namespace forces;

namespace {

using formula::Instruction;
using formula::Operation;

template <std::size_t n>
struct Dual {
  double v;
  std::array<double, n> d;
};

/// f(a): value and slope.
template <std::size_t n>
inline Dual<n> chain(double value, double slope, const Dual<n>& a) {
  Dual<n> out;
  out.v = value;
  for (std::size_t k = 0; k < n; ++k) out.d[k] = slope * a.d[k];
  return out;
}

/// f(a, b): value and both slopes.
template <std::size_t n>
inline Dual<n> chain(double value, double slope_a, const Dual<n>& a, double slope_b,
                     const Dual<n>& b) {
  Dual<n> out;
  out.v = value;
  for (std::size_t k = 0; k < n; ++k) out.d[k] = slope_a * a.d[k] + slope_b * b.d[k];
  return out;
}

/// x^n for n >= 0, by squaring.
double whole_power(double x, int n) {
  double result = 1.0;
  for (;; x *= x) {
    if (n % 2 == 1) result *= x;
    n /= 2;
    if (n == 0) return result;
  }
}

template <std::size_t n>
Dual<n> whole_power(const Dual<n>& a, int exponent) {
  if (exponent > 0) {
    const double below = whole_power(a.v, exponent - 1);
    return chain(below * a.v, exponent * below, a);
  }
  const double value = 1.0 / whole_power(a.v, -exponent);
  return chain(value, exponent * (value / a.v), a);
}

// a^(m + 1/2), m != 0.
template <std::size_t n>
Dual<n> half_power(const Dual<n>& a, int m) {
  const double root = std::sqrt(a.v), exponent = m + 0.5;
  if (m > 0) {
    const double below = whole_power(a.v, m - 1) * root;
    return chain(below * a.v, exponent * below, a);
  }
  const double value = 1.0 / (whole_power(a.v, -1 - m) * root);
  return chain(value, exponent * (value / a.v), a);
}

// Above exponent 1 the slope at zero is zero, not 0/0.
template <std::size_t n>
Dual<n> real_power(const Dual<n>& a, double c) {
  const double logarithm = elementary::log(a.v);
  const double value = elementary::exp(c * logarithm);
  const double slope = a.v == 0.0 && c > 1.0 ? 0.0 : c * (value / a.v);
  return chain(value, slope, a);
}

template <std::size_t n>
Dual<n> power(const Dual<n>& a, const Dual<n>& b) {
  const double logarithm = elementary::log(a.v);
  const double value = elementary::exp(b.v * logarithm);
  return chain(value, b.v * (value / a.v), a, value * logarithm, b);
}

// Scaled, so that the squares neither overflow nor vanish.
template <std::size_t n>
Dual<n> angle(const Dual<n>& y, const Dual<n>& x) {
  const double scale = std::fmax(std::fabs(x.v), std::fabs(y.v));
  const double along = x.v / scale, across = y.v / scale;
  const double square = (along * along + across * across) * scale;
  return chain(elementary::atan2(y.v, x.v), along / square, y, -across / square, x);
}

template <std::size_t n>
inline Dual<n> apply(const Instruction& i, const Dual<n>* slots) {
  const Dual<n>& a = slots[i.a];
  const Dual<n>& b = slots[i.b];
  switch (i.operation) {
    case Operation::number:
      return {i.c, {}};
    case Operation::negative:
      return chain(-a.v, -1.0, a);
    case Operation::sum:
      return chain(a.v + b.v, 1.0, a, 1.0, b);
    case Operation::shifted:
      return chain(a.v + i.c, 1.0, a);
    case Operation::difference:
      return chain(a.v - b.v, 1.0, a, -1.0, b);
    case Operation::number_minus:
      return chain(i.c - a.v, -1.0, a);
    case Operation::product:
      return chain(a.v * b.v, b.v, a, a.v, b);
    case Operation::multiple:
      return chain(i.c * a.v, i.c, a);
    case Operation::quotient: {
      const double value = a.v / b.v, inverse = 1.0 / b.v;
      return chain(value, inverse, a, -value * inverse, b);
    }
    case Operation::share:
      return chain(a.v / i.c, 1.0 / i.c, a);
    case Operation::number_over: {
      const double value = i.c / a.v;
      return chain(value, -value / a.v, a);
    }
    case Operation::whole_power:
      return whole_power(a, i.n);
    case Operation::half_power:
      return half_power(a, i.n);
    case Operation::real_power:
      return real_power(a, i.c);
    case Operation::power:
      return power(a, b);
    case Operation::root: {
      const double root = std::sqrt(a.v);
      return chain(root, 0.5 / root, a);
    }
    case Operation::exp: {
      const double value = elementary::exp(a.v);
      return chain(value, value, a);
    }
    case Operation::log:
      return chain(elementary::log(a.v), 1.0 / a.v, a);
    case Operation::sin: {
      const auto [sine, cosine] = elementary::sincos(a.v);
      return chain(sine, cosine, a);
    }
    case Operation::cos: {
      const auto [sine, cosine] = elementary::sincos(a.v);
      return chain(cosine, -sine, a);
    }
    case Operation::tan: {
      const auto [sine, cosine] = elementary::sincos(a.v);
      return chain(sine / cosine, 1.0 / (cosine * cosine), a);
    }
    case Operation::sinh: {
      const auto [sine, cosine] = sine_and_cosine_hyperbolic(a.v);
      return chain(sine, cosine, a);
    }
    case Operation::cosh: {
      const auto [sine, cosine] = sine_and_cosine_hyperbolic(a.v);
      return chain(cosine, sine, a);
    }
    case Operation::tanh: {
      const auto [value, slope] = tangent_hyperbolic(a.v);
      return chain(value, slope, a);
    }
    case Operation::abs:
      return chain(std::fabs(a.v), a.v > 0.0 ? 1.0 : a.v < 0.0 ? -1.0 : 0.0, a);
    case Operation::atan2:
      return angle(a, b);
    // A NaN on either side comes through.
    case Operation::least:
      return b.v < a.v || b.v != b.v ? b : a;
    case Operation::greatest:
      return b.v > a.v || b.v != b.v ? b : a;
  }
  return {};
}

template <std::size_t n, std::size_t size>
double run(const TypedExpression::Formula& f, const double* at, double* gradient) {
  Dual<n> slots[size];  // only what is used is ever written
  for (std::size_t v = 0; v < f.variables; ++v) {
    slots[v].v = at[v];
    for (std::size_t k = 0; k < n; ++k) slots[v].d[k] = k == v ? 1.0 : 0.0;
  }
  Dual<n>* next = slots + f.variables;
  for (const Instruction& i : f.instructions) *next++ = apply(i, slots);
  for (std::size_t k = 0; k < n; ++k) gradient[k] = slots[f.result].d[k];
  return slots[f.result].v;
}

// Short formulas do without the large array: some systems touch every page of it.
template <std::size_t n>
double run(const TypedExpression::Formula& f, const double* at, double* gradient) {
  constexpr std::size_t few = 64;
  if (f.variables + f.instructions.size() <= few) return run<n, few>(f, at, gradient);
  return run<n, formula::most_slots>(f, at, gradient);
}

}  // namespace

double TypedExpression::Formula::value(const double* at) const {
  return run<0>(*this, at, nullptr);
}

double TypedExpression::Formula::value_and_gradient(const double* at, double* gradient) const {
  switch (variables) {
    case 1:
      return run<1>(*this, at, gradient);
    case 2:
      return run<2>(*this, at, gradient);
    default:
      return run<3>(*this, at, gradient);
  }
}

}  // namespace carom
