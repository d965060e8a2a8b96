// A curve made ready for flights in double precision: rounded images of its exact data, with
// bounds.
//
// u = 2^-53 below; every bound is absolute and per coordinate (docs/physics/exactness.md).
#pragma once

#include <cmath>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/geometry/formulas.hpp"

namespace carom::geometry {

/// One operation of doubles errs by at most this share of its result (half the spacing at 1).
inline constexpr double unit_roundoff = 0x1p-53;

enum class CurveKind : unsigned char { segment, circle, ellipse, bezier };
/// How a hit is put on a curve.
enum class LandingKind : unsigned char { segment, circle, ellipse, thin, bezier };

/// A curve with all that the filter's formulas and bounds take from it, computed once. What a hit
/// needs comes first, so that among very many curves it lies in three lines of memory on a circle.
struct alignas(64) PreparedCurve {
  CurveKind kind = CurveKind::segment;
  bool closed = false;
  LandingKind landing = LandingKind::segment;
  double orientation = 1.0;  ///< +1: domain inside (counter-clockwise), -1: outside
  // Circle and ellipse.
  Vector centre;
  double r2 = 0.0;            ///< circle: squared radius
  double weight = 0.0;        ///< circle: 1 / (2 r2) …
  double strength = 0.0;      ///< … and four times as much
  double normal_bound = 0.0;  ///< of a normal's error, in its l1 norm, for any normal of this curve
  double point_error = 0.0;   ///< of point(u), and of settle(x) against point(parameter(x))
  CurveFrame parametrisation;  ///< u to the point and back

  // Segment: direction and its unit vector. The images of the tangent have a relative error of 4u.
  Vector from, tangent, direction, to;
  double length = 0.0, inverse_length = 0.0;

  double off_power = 1.0;  ///< circle: 1 or 0.75, such that off_power r2 is not near a power of two
  double parameter_stretch = 0.0;  ///< bounds |du| / |dx|_1
  double centre_error = 0.0;       ///< of `centre`
  // Ellipse: rows of the map to the unit circle of its axes, in which flights are intersected.
  Vector first_axis, second_axis;
  Vector first_direction;                          ///< the first as a unit vector
  double first_weight = 0.0, second_weight = 0.0;  ///< the squares of their lengths
  double extent = 0.0;        ///< largest |coordinate| on the curve, rounded up
  double normal_error = 0.0;  ///< of a normal, relative to its l1 norm

  explicit PreparedCurve(const Curve& curve);

  /// A conic so thin, or so small beside the flights that come to it, that a point put back on it
  /// would be another one: hits are identified by the parameter, and the normal is taken from that.
  /// docs/physics/exactness.md, Thin walls.
  bool thin() const { return landing == LandingKind::thin; }
  void make_thin();

  /// Rounded image of the exact point at u, u in [0, end).
  Vector point(double u) const { return point_at(parametrisation, u); }
  /// A point on the curve with a normal n into the domain, of any length, and square = k |n|^2,
  /// where k is a short number that keeps squares about r^2 off the powers of two.
  struct Frame {
    Vector point, normal;
    double square = 1.0;
    double k = 1.0;
  };
  /// The frame at a point that is on the curve up to rounding, which is brought back to it: hits on
  /// one wall do not add up their errors across it. The normal of a conic keeps its length, for
  /// dividing by its own square leaves no bias from hit to hit, as a rounded radius would.
  [[gnu::always_inline]] Frame settle(Vector x) const {
    return landing == LandingKind::segment   ? settle_on_segment(x)
           : landing == LandingKind::circle  ? settle_on_circle(x)
           : landing == LandingKind::ellipse ? settle_on_ellipse(x)
                                             : frame_at(parameter(x));
  }
  /// Where a particle arrives at x with velocity v: the frame there, the parameter, and the factor
  /// of its reflection. The same numbers as one by one, with one question for the kind of curve;
  /// and set number by number, so that none waits for another.
  struct Arrival {
    Vector point, normal;
    double factor = 0.0;
    double u = 0.0;
  };
  /// `u`: of a Bézier curve, where the flight meets it.
  [[gnu::always_inline]] void arrive(Vector x, Vector v, Arrival& a, double u = 0.0) const {
    if (landing == LandingKind::segment) {
      if (arrive_on_segment(x, v, a)) [[likely]]
        return;
      a.u = segment_parameter(parametrisation, a.point, first_parameter);
    } else {
      if (landing == LandingKind::circle)
        arrive_on_circle(x, v, a);
      else if (landing == LandingKind::ellipse)
        arrive_on_ellipse(x, v, a);
      else
        return void(a = landing == LandingKind::thin ? arrival_by_line(x, v) : arrival_at(u, v));
      a.u = conic_parameter(parametrisation, a.point, first_parameter);
    }
    if (!(a.u > first_parameter && a.u < last())) [[unlikely]]
      reflect_by(frame(a.u), v, a);  // put there, off the joints
  }
  /// The same on a segment. False: it is to be put there, off a joint.
  [[gnu::always_inline]] bool arrive_on_segment(Vector x, Vector v, Arrival& a) const {
    set(a, settle_on_segment(x));
    a.factor = 2.0 * fused_dot(v, a.normal);  // of a unit vector
    a.u = line_parameter(parametrisation, a.point);
    return a.u > first_parameter && a.u < last();
  }
  Frame frame(double u) const {
    if (landing > LandingKind::ellipse) return frame_at(u);
    const Frame f = settle(point(u));
    return {point(u), f.normal, f.square, f.k};
  }
  /// Parameter of a point that lies on the curve up to rounding, kept off the joints.
  double parameter(Vector x) const { return parameter_of(parametrisation, x); }
  double last() const { return parametrisation.last; }

 private:
  [[gnu::always_inline]] void arrive_on_circle(Vector x, Vector v, Arrival& a) const {
    const Vector d = x - centre;
    const double step = step_of_length(weight * d, d);
    if (!(std::fabs(step) < longest_step)) [[unlikely]]
      return void(a = arrival_by_line(x, v));
    const Vector on = moved(x, step, d);
    a.point.x = on.x;
    a.point.y = on.y;
    a.normal.x = -orientation * d.x;
    a.normal.y = -orientation * d.y;
    a.factor = -orientation * reflection_factor_on_circle(v, d, strength, step);
  }
  /// The frame of a conic or Bézier curve at u, made of u alone.
  Frame frame_at(double u) const;
  [[gnu::always_inline]] void arrive_on_ellipse(Vector x, Vector v, Arrival& a) const {
    const Vector e = x - centre;
    const OnEllipse<double> on = on_ellipse(e, first_axis, second_axis);
    if (!(std::fabs(on.step) < longest_step)) [[unlikely]]
      return void(a = arrival_by_line(x, v));
    reflect_by(settled_on_ellipse(x, e, on), v, a);
  }
  /// On a curve that is thin, or much smaller than the distance that was flown: rounding leaves the
  /// point farther off than one step mends. By value: an arrival whose address is given away lives
  /// in memory, and hits wait for it.
  Arrival arrival_by_line(Vector x, Vector v) const;
  Arrival arrival_at(double u, Vector v) const;
  void prepare_bezier();
  [[gnu::always_inline]] static void reflect_by(const Frame& f, Vector v, Arrival& a) {
    set(a, f);
    a.factor = reflection_factor(v, f.normal, f.square, f.k);
  }
  [[gnu::always_inline]] static void set(Arrival& a, const Frame& f) {
    a.point.x = f.point.x;
    a.point.y = f.point.y;
    a.normal.x = f.normal.x;
    a.normal.y = f.normal.y;
  }
  [[gnu::always_inline]] Frame settle_on_segment(Vector x) const {
    const Vector outward = -left(tangent);
    return {moved(x, step_to_line(x - from, outward), outward), left(tangent), 1.0, 1.0};
  }
  [[gnu::always_inline]] Frame settle_on_circle(Vector x) const {
    return settle_on_circle(x, x - centre);
  }
  [[gnu::always_inline]] Frame settle_on_circle(Vector x, Vector e) const {
    return {moved(x, step_of_length(weight * e, e), e), -orientation * e, dot(off_power * e, e),
            off_power};
  }
  [[gnu::always_inline]] Frame settle_on_ellipse(Vector x) const {
    const Vector e = x - centre;
    return settled_on_ellipse(x, e, on_ellipse(e, first_axis, second_axis));
  }
  [[gnu::always_inline]] Frame settled_on_ellipse(Vector x, Vector e,
                                                  const OnEllipse<double>& on) const {
    return {moved(x, on.step, e), -orientation * on.gradient, dot(on.gradient, on.gradient), 1.0};
  }
};

}  // namespace carom::geometry
