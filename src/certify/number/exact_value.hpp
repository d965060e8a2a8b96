// Numbers as they were written, at any precision.
#pragma once

#include "carom/base/exact_number.hpp"
#include "certify/number/ball.hpp"

namespace carom::certify {

/// A ball around what the number means, to the present precision.
Ball value_of(const ExactNumber&);

inline constexpr slong bits_of_a_first_look = 128, most_bits_of_a_sign = 1 << 14;
/// The sign of a number as written. Undecided where it is not rational and no ball of 2^14 bits
/// tells it from zero.
Sign sign_of(const ExactNumber&);

struct CosSin {
  Ball cos, sin;
};
/// Cosine and sine of an angle in radians plus `part` of `whole` turns. Rational parts of a turn
/// are kept as such, so that those of quarters are exact.
CosSin direction_of(const ExactNumber& angle, long part = 0, long whole = 1);

}  // namespace carom::certify
