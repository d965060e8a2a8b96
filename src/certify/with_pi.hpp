// Exact numbers a + b pi, with quadratic a and b. As pi is transcendental, such a number is zero only if both
// are.
#pragma once

#include "certify/evaluate.hpp"
#include "certify/quadratic_table.hpp"

namespace carom::certify {

struct WithPi {
  Quadratic plain, pi;

  WithPi() = default;
  WithPi(Quadratic a, Quadratic b = {}) : plain(std::move(a)), pi(std::move(b)) {}
  /// Throws NotQuadratic.
  explicit WithPi(const ExactNumber& number) {
    if (number.expression()) *this = evaluate<WithPi>(*number.expression(), leaf_of, power_of);
  }
  bool has_pi() const { return !is_zero(pi); }

  friend WithPi operator+(const WithPi& a, const WithPi& b) { return {a.plain + b.plain, a.pi + b.pi}; }
  friend WithPi operator-(const WithPi& a, const WithPi& b) { return {a.plain - b.plain, a.pi - b.pi}; }
  friend WithPi operator*(const WithPi& a, const WithPi& b) {
    if (a.has_pi() && b.has_pi()) throw NotQuadratic("a power of pi");
    return {a.plain * b.plain, a.plain * b.pi + a.pi * b.plain};
  }
  friend WithPi operator/(const WithPi& a, const WithPi& b) {
    if (!b.has_pi()) return {a.plain / b.plain, a.pi / b.plain};
    if (!is_zero(a.plain) || !is_zero(b.plain)) throw NotQuadratic("a division by pi");
    return a.pi / b.pi;
  }
  friend WithPi sqrt(const WithPi& a) {
    if (a.has_pi()) throw NotQuadratic("the root of pi");
    return sqrt(a.plain);
  }

 private:
  static WithPi leaf_of(const ClosedForm& x) {
    if (x.power != 0 && x.power != 1) throw NotQuadratic("a power of pi");
    const Quadratic coefficient{x.coefficient};
    const Quadratic number = x.radicand == 1 ? coefficient : coefficient * sqrt(Quadratic{x.radicand});
    return x.power == 0 ? WithPi(number) : WithPi(Quadratic(), number);
  }
  static WithPi power_of(const WithPi& base, long exponent) {
    const long times = exponent < 0 ? -exponent : exponent;
    if (times > 1000) throw NotQuadratic("a high power");
    WithPi result(Quadratic(1));
    for (long i = 0; i < times; ++i) result = result * base;
    return exponent < 0 ? WithPi(Quadratic(1)) / result : result;
  }
};

inline bool is_zero(const WithPi& x) { return is_zero(x.plain) && is_zero(x.pi); }

}  // namespace carom::certify
