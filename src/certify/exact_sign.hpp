// The sign of a number as it was written: by balls, and where these end by algebra.
#pragma once

#include <optional>

#include "certify/quadratic_table.hpp"

namespace carom::certify {

inline constexpr slong bits_of_a_first_look = 128, most_bits_of_a_sign = 1 << 14;

/// By balls first; then by algebra, which may know the sign, or no more than that the number is not zero, or
/// throw NotQuadratic; then by balls of many bits. Undecided where none of them tells.
template <class InBalls, class Algebra>
Sign sign_by(const InBalls& in_balls, const Algebra& algebra) {
  for (const slong bits : {bits_of_a_first_look, slong{1024}, most_bits_of_a_sign}) {
    const Precision precision(bits);
    if (const Sign s = sign(in_balls()); s != Sign::undecided) return s;
    if (bits != bits_of_a_first_look) continue;
    try {
      const QuadraticField own;
      if (const std::optional<Sign> s = algebra()) return *s;
    } catch (const NotQuadratic&) {  // more bits may tell
    }
  }
  return Sign::undecided;
}

Sign sign_of(const ExactNumber&);

}  // namespace carom::certify
