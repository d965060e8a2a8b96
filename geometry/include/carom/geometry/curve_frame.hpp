// A curve made ready for many evaluations: its frame with everything exact done once. The functions
// of curve.hpp are these with the frame built on the spot.
#pragma once

#include <memory>

#include "carom/geometry/bezier.hpp"
#include "carom/geometry/curve.hpp"
#include "carom/geometry/parameter.hpp"

namespace carom::geometry {

/// A curve with everything exact done, in doubles.
struct CurveFrame : Frame<double> {
  enum class Kind : unsigned char { segment, arc, closed, bezier } kind = Kind::segment;
  bool circular = false;
  double turn = 0.0;   ///< +1 counter-clockwise, -1 clockwise, 0 segment
  Vector middle;       ///< centre, rounded
  double major = 0.0;  ///< semi-axes (radius of a circle, length of a segment, least |T(u)|)
  double minor = 0.0;
  /// Cosine and sine of the eccentric angle of the start, counted in the direction of travel from
  /// an end of the minor axis.
  Vector phase{1.0, 0.0};
  std::shared_ptr<const BezierForm> bezier = {};  ///< of a Bézier curve, else null
};

/// Costs about 4 µs (exact arithmetic): make it once a curve. Throws std::invalid_argument for a
/// curve without extent (zero length, radius, axis or ratio).
CurveFrame frame_of(const Curve&);

inline Vector point_at(const CurveFrame& f, double u) {
  return f.kind == CurveFrame::Kind::segment ? segment_point(f, u)
         : f.bezier                          ? f.bezier->point(u)
                                             : conic_point(f, u);
}
inline double parameter_of(const CurveFrame& f, Vector point) {
  return f.kind == CurveFrame::Kind::segment ? segment_parameter(f, point, first_parameter)
         : f.bezier                          ? f.bezier->parameter_near(point)
                                             : conic_parameter(f, point, first_parameter);
}
/// Tangent of any length in the direction of travel.
inline Vector direction_at(const CurveFrame& f, double u) {
  return f.kind == CurveFrame::Kind::segment ? f.a
         : f.bezier                          ? f.bezier->tangent(u)
                                             : conic_direction(f, u);
}
Vector tangent_at(const CurveFrame&, double u);
Vector normal_at(const CurveFrame&, double u);
double curvature_at(const CurveFrame&, double u);
double length(const CurveFrame&);
double arc_length_at(const CurveFrame&, double u);
double parameter_at_length(const CurveFrame&, double s);
/// Signed area between the curve and the chord from its start to its end.
double area_beyond_chord(const CurveFrame&);

}  // namespace carom::geometry
