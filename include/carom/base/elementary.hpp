// The only door to elementary functions where a state, a time or a random number is made:
// the same bits on every x86-64 and ARM machine, scalar or SIMD (SLEEF's cinz functions).
#pragma once

#include <cstddef>
#include <span>

namespace carom::elementary {

/// Each function is within 1.0 ulp of the truth; sincos may differ from sin and cos
/// in the last bit, so one formula uses one of them throughout.
struct SinCos {
  double sin, cos;
};

double sin(double x);
double cos(double x);
SinCos sincos(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
/// exp of every entry, in place: the same bits as one by one, by the widest instructions there are.
void exp(std::span<double> x);
/// atan2(y, x) of every entry and one x, in place: the same.
void atan2(std::span<double> y, double x);
/// exp of n numbers, a multiple of `width`, by registers of 8, 4 or 2 numbers, which the
/// machine must have.
using ExpOfMany = void (*)(double* x, std::size_t n);
ExpOfMany exp_by(int width);

}  // namespace carom::elementary
