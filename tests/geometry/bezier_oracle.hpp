// Where a flight leaves through a Bézier curve, decided apart from the engine: all roots of its
// side in rational numbers, by CGAL's algebraic kernel.
#pragma once

#include <optional>

#include "carom/geometry/curve.hpp"

namespace carom::tests {

/// The parameter of the first exit, rounded. `on`: that of the start if it is a point of the curve,
/// else negative.
std::optional<double> first_exit_by_kernel(const geometry::Bezier&, geometry::Vector start,
                                           geometry::Vector velocity, double omega, double on);

}  // namespace carom::tests
