// What the integrators ask of an arithmetic besides + - * / and comparisons.
#pragma once

#include <string_view>

#include "carom/base/decimal.hpp"
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
  static double parse(std::string_view decimal) { return nearest_double(decimal).value_or(0.0); }
  static SineCosine<double> turn(double angle) {
    const elementary::SinCos value = elementary::sincos(angle);
    return {value.sin, value.cos};
  }
};

}  // namespace carom
