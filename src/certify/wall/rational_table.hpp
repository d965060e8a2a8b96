// Tables as they were written, in rational numbers.
#pragma once

#include "certify/number/rational.hpp"
#include "certify/wall/ball_table.hpp"

namespace carom::certify {

inline bool is_zero(const VectorOf<Rational>& v) { return is_zero(v.x) && is_zero(v.y); }

/// The cosine and sine of an angle: unknown except for quarters of a turn.
VectorOf<Rational> rational_direction(const ExactNumber& angle);

/// The table of a system; numbers of walls that are not rational are unknown. Throws NotRational
/// where a shape asks for the sign of one.
TableOf<Rational> rational_table(const TableSpec&);

}  // namespace carom::certify
