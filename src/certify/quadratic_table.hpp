// Tables as they were written, in exact numbers a + b sqrt(d).
#pragma once

#include <string>

#include "certify/exact_value.hpp"
#include "certify/quadratic.hpp"
#include "certify/table_builder.hpp"

namespace carom::certify {

inline bool is_zero(const Quadratic& x) { return sign(x) == Sign::zero; }
inline bool is_zero(const VectorOf<Quadratic>& v) { return is_zero(v.x) && is_zero(v.y); }

/// The cosine and sine of k times 15 degrees. Throws NotQuadratic where these are roots of roots.
VectorOf<Quadratic> twenty_fourth(long k);

template <>
struct Source<Quadratic> {
  static Quadratic value(const ExactNumber& number) { return Quadratic(number); }
  // Twelfths of a turn have roots of 3 at most, eighths of 2.
  static VectorOf<Quadratic> direction(const ExactNumber& angle, long part = 0, long whole = 1);
};

}  // namespace carom::certify
