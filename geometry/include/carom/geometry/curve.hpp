// The curves that walls are made of: geometry only.
//
// Every number of a curve is a double and means exactly that double. Each curve is run through from
// `from` to `to`; the domain of a billiard lies on its left. Circles and ellipses are given so that
// they pass *exactly* through their joints, with every coefficient a dyadic rational:
//
//   circle through A, B:  centre = (A + B)/2 + offset * left(B - A)
//   ellipse through A, B with an axis along p and ratio k of the other axis to it:
//                         centre = (A + B)/2 + offset * K(B - A),
//                         K e = -(e.q) p + k^2 (e.p) q,  q = left(p),
//   which is the quarter turn of the metric M(e, f) = k^2 (e.p)(f.p) + (e.q)(f.q), scaled.
//
// Parameter u. Segment: A + u (B - A), 0 <= u < 1. The others: u = n + w, where n counts quarter
// turns (of the metric M) from the start and w in [0, 1) is the tangent of half the remaining
// angle: with a = start - centre and b its quarter turn in the direction of travel,
//   centre + ((1 - w^2) a + 2 w b)/(1 + w^2)           for n = 0,
// and (a, b) -> (b, -a) for each further quarter. Full circles and ellipses: 0 <= u < 4.
// Bézier curve of degree n: sum of C(n, i) u^i (1 - u)^(n - i) times control point i, 0 <= u < 1.
// docs/physics/exactness.md derives what follows from this.
#pragma once

#include <array>
#include <variant>

#include "carom/geometry/vector.hpp"

namespace carom::geometry {

/// A straight line from `from` to `to`.
struct Segment {
  Vector from, to;
};

/// A circular arc, exactly through both of its ends; its centre lies `offset` chords from the
/// chord.
struct CircularArc {
  Vector from, to;
  double offset = 0.0;  ///< 0: half circle; > 0: centre on the left of from -> to
  bool counterclockwise = true;
};

/// A full circle.
struct Circle {
  Vector centre;
  double radius = 1.0;
  bool counterclockwise = true;  ///< starts and ends at angle 0
};

/// An arc of an ellipse of any orientation, exactly through both of its ends.
struct EllipticArc {
  Vector from, to;
  Vector axis;         ///< direction of one axis; its length is free
  double ratio = 1.0;  ///< semi-axis across `axis` over the semi-axis along it
  double offset = 0.0;
  bool counterclockwise = true;
};

/// A full ellipse of any orientation.
struct Ellipse {
  Vector centre;
  Vector axis;         ///< semi-axis as a vector: the curve starts at centre + axis
  double ratio = 1.0;  ///< the other semi-axis over |axis|
  bool counterclockwise = true;
};

/// A polynomial curve, exactly through both of its ends.
struct Bezier {
  static constexpr int most = 5;  ///< degree
  Vector from, to;
  std::array<Vector, most - 1> inner{};  ///< the control points between the ends: degree - 1
  int degree = 3;                        ///< 2 to 5
  Vector control(int i) const {
    return i == 0 ? from : i == degree ? to : inner[static_cast<std::size_t>(i - 1)];
  }
};

using Curve = std::variant<Segment, CircularArc, Circle, EllipticArc, Ellipse, Bezier>;

/// True for a full circle or ellipse: a loop by itself, without a joint.
bool is_closed(const Curve&);
/// Where the curve begins and ends; of a closed one both are its point at parameter 0, rounded.
Vector start_point(const Curve&);
Vector end_point(const Curve&);

/// The parameter of the end (1 of segments and Bézier curves, 4 of closed curves, or the rounded
/// parameter of `to`).
double end_parameter(const Curve&);
/// Largest double whose exact point lies before the end.
double last_parameter(const Curve&);
/// Smallest parameter of a state that does not lie on the joint: as far from 0 as the last double
/// before 1 is from 1. It decides nothing: which wall is hit is known before. A parameter nearer to
/// the joint is put there, and its point moves by less than the rounding of a parameter near 1.
inline constexpr double first_parameter = 0x1p-53;

/// Rounded image of the exact point at u.
Vector point_at(const Curve&, double u);
/// Unit tangent in the direction of travel, and unit normal into the domain.
Vector tangent_at(const Curve&, double u);
Vector normal_at(const Curve&, double u);
/// Signed curvature: positive where the curve turns left (towards the domain: focusing).
double curvature_at(const Curve&, double u);
/// Parameter of the point of the curve nearest in angle to `point`, which lies on it up to
/// rounding; clamped to [first_parameter, last_parameter].
double parameter_of(const Curve&, Vector point);

/// Total length, length from the start to u, and its inverse (clamped to the curve).
double length(const Curve&);
double arc_length_at(const Curve&, double u);
double parameter_at_length(const Curve&, double s);

/// A rectangle along the axes.
struct Box {
  Vector low, high;
};
/// A box that contains the exact curve.
Box bounding_box(const Curve&);

/// Centre, rounded (Segment: its midpoint).
Vector centre(const Curve&);

/// Builds a circular arc through three points: exactly through `from` and `to`, within rounding
/// through `via`. Collinear points or a `via` outside between them throw std::invalid_argument.
CircularArc arc_through(Vector from, Vector via, Vector to);
/// The same for an ellipse of given axis direction and ratio.
EllipticArc elliptic_arc_through(Vector from, Vector via, Vector to, Vector axis, double ratio);
/// Arc of the circle with given centre (rounded so that it passes exactly through both ends).
CircularArc arc_about(Vector from, Vector to, Vector centre, bool counterclockwise);

/// The same point set in the opposite direction.
Curve reversed(const Curve&);
/// Area under the boundary integral (1/2) closed-integral (x dy - y dx) of this piece.
double area_integral(const Curve&);

}  // namespace carom::geometry
