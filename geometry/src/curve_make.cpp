// Arcs from points on them: the offset of the centre is computed exactly and rounded once.
#include <stdexcept>

#include "carom/geometry/curve.hpp"
#include "exact_curve.hpp"
#include "rational.hpp"

namespace carom::geometry {

namespace {

double rounded_offset(const Dyadic& numerator, const Dyadic& denominator) {
  const double offset = nearest(numerator.rational() / denominator.rational());
  if (!std::isfinite(offset))
    throw std::invalid_argument("the three points of an arc lie on a line");
  return offset;
}

/// With c = to - from and f = via - from, |centre - via| = |centre - from| in the metric M reads
/// M(c, f) + 2 offset M(K c, f) = M(f, f).
double offset_through(const Metric& m, const DyadicVector& c, const DyadicVector& f) {
  return rounded_offset(m(f, f) - m(c, f), Dyadic(2) * m(m.quarter(c), f));
}

/// Sign of the turn from -> via -> to.
int turn(const DyadicVector& c, const DyadicVector& f) {
  const int sign = cross(f, c).sign();
  if (sign == 0) throw std::invalid_argument("the three points of an arc lie on a line");
  return sign;
}

}  // namespace

CircularArc arc_through(Vector from, Vector via, Vector to) {
  const DyadicVector c = exact(to) - exact(from), f = exact(via) - exact(from);
  const bool counterclockwise = turn(c, f) > 0;
  return {from, to, offset_through(Metric{}, c, f), counterclockwise};
}

EllipticArc elliptic_arc_through(Vector from, Vector via, Vector to, Vector axis, double ratio) {
  if (!(ratio > 0.0))
    throw std::invalid_argument("the ratio of an ellipse's axes must be positive");
  if (axis == Vector{}) throw std::invalid_argument("an ellipse needs the direction of an axis");
  const Metric m = metric_of(axis, ratio);
  const DyadicVector c = exact(to) - exact(from), f = exact(via) - exact(from);
  const bool counterclockwise = turn(c, f) > 0;
  return {from, to, axis, ratio, offset_through(m, c, f), counterclockwise};
}

CircularArc arc_about(Vector from, Vector to, Vector centre, bool counterclockwise) {
  const DyadicVector c = exact(to) - exact(from);
  const Dyadic squared = dot(c, c);
  if (squared.sign() == 0) throw std::invalid_argument("an arc starts and ends at the same point");
  const DyadicVector middle = Dyadic(0.5) * (exact(from) + exact(to));
  return {from, to, rounded_offset(dot(exact(centre) - middle, left(c)), squared),
          counterclockwise};
}

Curve reversed(const Curve& curve) {
  struct {
    Curve operator()(const Segment& s) const { return Segment{s.to, s.from}; }
    Curve operator()(const CircularArc& a) const {
      return CircularArc{a.to, a.from, -a.offset, !a.counterclockwise};
    }
    Curve operator()(const Circle& c) const {
      return Circle{c.centre, c.radius, !c.counterclockwise};
    }
    Curve operator()(const EllipticArc& a) const {
      return EllipticArc{a.to, a.from, a.axis, a.ratio, -a.offset, !a.counterclockwise};
    }
    Curve operator()(const Ellipse& e) const {
      return Ellipse{e.centre, e.axis, e.ratio, !e.counterclockwise};
    }
    Curve operator()(const Bezier& b) const {
      Bezier r{b.to, b.from, {}, b.degree};
      for (int i = 1; i < b.degree; ++i)
        r.inner[static_cast<std::size_t>(i - 1)] = b.control(b.degree - i);
      return r;
    }
  } const opposite;
  return std::visit(opposite, curve);
}

}  // namespace carom::geometry
