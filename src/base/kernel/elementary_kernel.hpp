// Elementary functions of many numbers at once, by registers of 8, 4 and 2 numbers.
#pragma once

#include <cstddef>

namespace carom::base {

/// In place; n is a multiple of `width`, and the machine has such registers (of 8 and of 4 with
/// fused products).
template <int width>
void exp_of_many(double* x, std::size_t n);
/// atan2(y, x) of every y.
template <int width>
void atan2_of_many(double* y, double x, std::size_t n);

}  // namespace carom::base
