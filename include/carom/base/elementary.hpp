// The only door to elementary functions where a state, a time or a random number is made. Each
// value is the double next to the true one, so mathematics alone decides its bits: the same on
// every machine, from any library, one by one or many at once. (docs/physics/elementary.md)
#pragma once

#include <cstddef>
#include <span>

namespace carom::elementary {

struct SinCos {
  double sin, cos;
};

/// Special arguments as in ISO C, annex F.
double sin(double x);
double cos(double x);
SinCos sincos(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
/// exp of every entry, in place, by the widest registers there are.
void exp(std::span<double> x);
/// atan2(y, x) of every entry and one x, in place: the same.
void atan2(std::span<double> y, double x);
/// exp of n numbers, a multiple of `multiple` (2, 4 or 8), by the widest registers that divide it.
using ExpOfMany = void (*)(double* x, std::size_t n);
ExpOfMany exp_by(int multiple);

}  // namespace carom::elementary
