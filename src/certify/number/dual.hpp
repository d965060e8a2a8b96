// Numbers with their derivatives by four directions: a formula over them is its own tangent map.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "certify/number/interval.hpp"

namespace carom::certify {

template <class Number>
struct Dual {
  static constexpr std::size_t directions = 4;
  Number value{};
  std::array<Number, directions> slope{};

  friend Dual operator+(const Dual& a, const Dual& b) {
    return each(a.value + b.value, [&](std::size_t i) { return a.slope[i] + b.slope[i]; });
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return each(a.value - b.value, [&](std::size_t i) { return a.slope[i] - b.slope[i]; });
  }
  friend Dual operator-(const Dual& a) {
    return each(-a.value, [&](std::size_t i) { return -a.slope[i]; });
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return each(a.value * b.value,
                [&](std::size_t i) { return a.slope[i] * b.value + a.value * b.slope[i]; });
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const Number q = a.value / b.value;
    return each(q, [&](std::size_t i) { return (a.slope[i] - q * b.slope[i]) / b.value; });
  }
  // With a constant.
  friend Dual operator+(const Dual& a, const Number& b) { return {a.value + b, a.slope}; }
  friend Dual operator-(const Dual& a, const Number& b) { return {a.value - b, a.slope}; }
  friend Dual operator-(const Number& a, const Dual& b) {
    return each(a - b.value, [&](std::size_t i) { return -b.slope[i]; });
  }
  friend Dual operator*(const Dual& a, const Number& b) {
    return each(a.value * b, [&](std::size_t i) { return a.slope[i] * b; });
  }
  friend Dual operator*(const Number& a, const Dual& b) { return b * a; }
  friend Dual operator/(const Dual& a, const Number& b) {
    return each(a.value / b, [&](std::size_t i) { return a.slope[i] / b; });
  }

  static Dual each(const Number& value, auto slope_of) {
    Dual r;
    r.value = value;
    for (std::size_t i = 0; i < directions; ++i) r.slope[i] = slope_of(i);
    return r;
  }
};

template <class Number>
Dual<Number> sqrt(const Dual<Number>& a) {
  using std::sqrt;
  const Number root = sqrt(a.value), twice = root + root;
  return Dual<Number>::each(root, [&](std::size_t i) { return a.slope[i] / twice; });
}
template <class Number>
Dual<Number> square(const Dual<Number>& a) {
  return Dual<Number>::each(square(a.value),
                            [&](std::size_t i) { return (a.value + a.value) * a.slope[i]; });
}

}  // namespace carom::certify
