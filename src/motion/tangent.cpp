#include "carom/motion/tangent.hpp"

#include "carom/base/elementary.hpp"

namespace carom {

FlightTangent flight_tangent(double omega, double duration) {
  if (omega == 0.0) return {duration, 0.0, 1.0, 0.0};
  // By half the angle, so that nothing is lost to cancellation in a weak field.
  const double h = 0.5 * omega;
  const auto [s, c] = elementary::sincos(h * duration);
  const double chord = s / h;
  return {chord * c, chord * s, c * c - s * s, 2.0 * s * c};
}

}  // namespace carom
