// What the integrators ask of an arithmetic besides + - * / and comparisons.
#pragma once

#include <charconv>
#include <string_view>

#include "carom/base/elementary.hpp"

namespace carom {

/// Sine and cosine of one angle.
template <class Real>
struct SineCosine {
  Real sine{}, cosine{};
};

/// Specialised for each arithmetic: `parse` reads a decimal with all its digits, `turn` is the sine
/// and cosine of an angle.
template <class Real>
struct Arithmetic;

/// The arithmetic of every run: the same bits on every machine.
template <>
struct Arithmetic<double> {
  static double parse(std::string_view decimal) {
    double x = 0.0;
    std::from_chars(decimal.data(), decimal.data() + decimal.size(), x);
    return x;
  }
  static SineCosine<double> turn(double angle) {
    const elementary::SinCos value = elementary::sincos(angle);
    return {value.sin, value.cos};
  }
};

}  // namespace carom
