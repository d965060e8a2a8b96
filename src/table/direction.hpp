// Directions from angles.
#pragma once

#include "carom/base/exact_number.hpp"
#include "carom/geometry/vector.hpp"

namespace carom::table {

/// The unit vector at an angle in radians against +x, plus `part` of `whole` turns, times `length`:
/// each component rounded once from the angle's nearest double in turns. Multiples of a quarter
/// turn are exact ("pi/2" is straight up), and the bits are the same everywhere.
geometry::Vector direction(const ExactNumber& angle, int part = 0, int whole = 1,
                           double length = 1.0);

}  // namespace carom::table
