// Exact numbers a + b sqrt(d) in the formulas of flights in a field.
#pragma once

#include "certify/larmor_flight.hpp"
#include "certify/quadratic_table.hpp"

namespace carom::certify {

inline double middle_of(const Quadratic& x) { return static_cast<double>(sign(x)); }
/// Of an angle: transcendental. TieFollower keeps how far the velocity has turned instead.
inline Quadratic time_at(const Kappa<Quadratic>&, const MotionOf<Quadratic>&) { return {}; }
/// A root of degree four.
inline Kappa<Quadratic> ellipse_exit(const WallOf<Quadratic>&, const VectorOf<Quadratic>&,
                                     const VectorOf<Quadratic>&, const MotionOf<Quadratic>&, bool) {
  throw NotQuadratic("a Larmor circle against an ellipse");
}

}  // namespace carom::certify
