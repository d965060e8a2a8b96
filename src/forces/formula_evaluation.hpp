// Runs a formula's list, with dual numbers of any arithmetic: a value and its derivatives go
// together from slot to slot.
#pragma once

#include <algorithm>
#include <cmath>

#include "carom/base/elementary.hpp"
#include "forces/dual.hpp"
#include "forces/formula.hpp"

namespace carom::forces::formula {

// Powers of any number, so that a slope may be a dual number itself.

inline double half_power_value(double a, int m) {
  const double root = std::sqrt(a);
  return m >= 0 ? power_by_squaring(a, m) * root : 1.0 / (power_by_squaring(a, -1 - m) * root);
}
inline double real_power_value(double a, double c) {
  return elementary::exp(c * elementary::log(a));
}

template <std::size_t n, class S>
Dual<n, S> whole_power(const Dual<n, S>& a, int exponent) {
  if (exponent > 0) {
    const S below = power_by_squaring(a.v, exponent - 1);
    return chain<n, S>(below * a.v, exponent * below, a);
  }
  const S value = 1.0 / power_by_squaring(a.v, -exponent);
  return chain<n, S>(value, exponent * (value / a.v), a);
}

// a^(m + 1/2). At zero the root of what does not change does not change: r^3 = (x^2 + y^2)^(3/2).
template <std::size_t n, class S>
Dual<n, S> half_power_value(const Dual<n, S>& a, int m) {
  const S value = half_power_value(a.v, m);
  const bool rests =
      value_of(a) == 0.0 && m >= 0 &&
      std::all_of(a.d.begin(), a.d.end(), [](const S& slope) { return value_of(slope) == 0.0; });
  return chain<n, S>(value, rests ? S(0.0) : (m + 0.5) * half_power_value(a.v, m - 1), a);
}
// The same, m != 0.
template <std::size_t n, class S>
Dual<n, S> half_power(const Dual<n, S>& a, int m) {
  const double exponent = m + 0.5;
  if (m > 0) {
    const S below = half_power_value(a.v, m - 1);
    return chain<n, S>(below * a.v, exponent * below, a);
  }
  const S value = half_power_value(a.v, m);
  return chain<n, S>(value, exponent * (value / a.v), a);
}

// Above exponent 1 the slope at zero is zero, not 0/0; so are all below the exponent.
template <std::size_t n, class S>
Dual<n, S> real_power_value(const Dual<n, S>& a, double c) {
  const S value = real_power_value(a.v, c);
  const S slope = value_of(a) == 0.0 && c > 1.0 ? S(0.0) : c * (value / a.v);
  return chain<n, S>(value, slope, a);
}

template <std::size_t n, class S>
Dual<n, S> power(const Dual<n, S>& a, const Dual<n, S>& b) {
  const S log_a = logarithm(a.v);
  const S value = exponential(b.v * log_a);
  return chain<n, S>(value, b.v * (value / a.v), a, value * log_a, b);
}

template <std::size_t n, class S>
inline Dual<n, S> apply(const Instruction& i, const Dual<n, S>* slots) {
  const Dual<n, S>& a = slots[i.a];
  const Dual<n, S>& b = slots[i.b];
  switch (i.operation) {
    case Operation::number:
      return i.c;
    case Operation::negative:
      return -a;
    case Operation::sum:
      return a + b;
    case Operation::shifted:
      return a + i.c;
    case Operation::difference:
      return a - b;
    case Operation::number_minus:
      return i.c - a;
    case Operation::product:
      return a * b;
    case Operation::multiple:
      return i.c * a;
    case Operation::quotient:
      return a / b;
    case Operation::share:
      return a / i.c;
    case Operation::number_over:
      return i.c / a;
    case Operation::whole_power:
      return whole_power(a, i.n);
    case Operation::half_power:
      return half_power(a, i.n);
    case Operation::real_power:
      return real_power_value(a, i.c);
    case Operation::power:
      return power(a, b);
    case Operation::root:
      return root(a);
    case Operation::exp:
      return exponential(a);
    case Operation::log:
      return logarithm(a);
    case Operation::sin:
      return sine_and_cosine(a).sine;
    case Operation::cos:
      return sine_and_cosine(a).cosine;
    case Operation::tan: {
      const auto [sine, cosine] = sine_and_cosine(a.v);
      return chain<n, S>(sine / cosine, 1.0 / (cosine * cosine), a);
    }
    case Operation::sinh:
      return hyperbolic_sine_and_cosine(a).sine;
    case Operation::cosh:
      return hyperbolic_sine_and_cosine(a).cosine;
    case Operation::tanh:
      return tanh_and_slope(a).value;
    case Operation::abs:
      return absolute(a);
    case Operation::atan2:
      return angle(a, b);
    // A NaN on either side comes through.
    case Operation::least:
      return value_of(b) < value_of(a) || value_of(b) != value_of(b) ? b : a;
    case Operation::greatest:
      return value_of(b) > value_of(a) || value_of(b) != value_of(b) ? b : a;
  }
  return {};
}

// The variables are the first slots; the result is the last one used.
template <class Number, std::size_t size>
Number run(const TypedExpression::Formula& f, const Number* at) {
  Number slots[size];  // only what is used is ever written
  for (std::size_t v = 0; v < f.variables; ++v) slots[v] = at[v];
  Number* next = slots + f.variables;
  for (const Instruction& i : f.instructions) *next++ = apply(i, slots);
  return slots[f.result];
}

// Short formulas do without the large array: some systems touch every page of it.
template <class Number>
Number run(const TypedExpression::Formula& f, const Number* at) {
  constexpr std::size_t few = 64;
  if (f.variables + f.instructions.size() <= few) return run<Number, few>(f, at);
  return run<Number, most_slots>(f, at);
}

}  // namespace carom::forces::formula
