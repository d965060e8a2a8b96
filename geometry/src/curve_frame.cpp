// Frames: the exact numbers of a curve, each rounded once.
#include "carom/geometry/curve_frame.hpp"

#include <stdexcept>

#include "exact_curve.hpp"
#include "exact_end.hpp"
#include "rational.hpp"

namespace carom::geometry {

namespace {

using Kind = CurveFrame::Kind;

double quotient(const Dyadic& a, const Dyadic& b) { return nearest(a.rational() / b.rational()); }
Vector quotient(const DyadicVector& a, const Dyadic& b) {
  return {quotient(a.x, b), quotient(a.y, b)};
}
double rounded(const Dyadic& a) { return nearest(a.rational()); }
Vector rounded(const DyadicVector& a) { return {rounded(a.x), rounded(a.y)}; }

/// The linear form e -> M(e, f) as a vector.
DyadicVector form(const Metric& m, const DyadicVector& f) {
  if (m.euclidean) return f;
  const Dyadic along = m.k2 * dot(f, m.p), across = cross(m.p, f);
  const DyadicVector q = left(m.p);
  return {along * m.p.x + across * q.x, along * m.p.y + across * q.y};
}

void set_end(CurveFrame& f, const ExactCurve& c, const DyadicVector& quarter) {
  const ExactEnd exact_end = end_of(c, quarter);
  const mpq_class end = exact_end.quarter + exact_end.w;
  if (sgn(end) == 0) throw std::invalid_argument("an arc starts and ends at the same point");
  f.last = largest_below(end);
  // The next double, which is not below the end: u < f.end exactly when the point at u lies before
  // it.
  f.end = std::nextafter(f.last, 8.0);
}

void set_axes(CurveFrame& f, const ExactCurve& c) {
  if (c.metric.euclidean) {
    f.circular = true;
    f.major = f.minor = std::sqrt(rounded(c.r2));
    return;
  }
  // On the ellipse M(e, e) = |p|^2 (semi-axis across p)^2.
  const double across = std::sqrt(quotient(c.r2, dot(c.metric.p, c.metric.p)));
  const double ratio = rounded(c.metric.k);
  const double along = across / ratio;
  const double norm = std::sqrt(rounded(c.r2));
  const double cosine = rounded(c.metric.k * dot(c.start, c.metric.p)) / norm;
  const double sine = f.turn * (rounded(cross(c.metric.p, c.start)) / norm);
  if (along >= across) {  // a quarter turn back: the angle counts from the end of the minor axis
    f.major = along;
    f.minor = across;
    f.phase = {sine, -cosine};
  } else {
    f.major = across;
    f.minor = along;
    f.phase = {cosine, sine};
  }
}

CurveFrame conic_frame(const Curve& curve) {
  const ExactCurve c(curve);
  if (c.r2.sign() <= 0 || c.metric.scale.sign() <= 0)
    throw std::invalid_argument("a curve without extent: radius, axis or ratio is not positive");
  CurveFrame f;
  f.turn = c.orientation;
  f.kind = c.closed ? Kind::closed : Kind::arc;
  const DyadicVector turned = c.metric.quarter(c.start);
  const DyadicVector quarter = f.turn > 0 ? turned : -turned;
  f.middle = rounded(c.centre);
  f.origin = c.closed ? f.middle : rounded(c.from);
  f.start = c.closed ? 0.0 : 1.0;
  f.a = rounded(c.start);
  f.b = quotient(quarter, c.metric.scale);
  f.along = quotient(form(c.metric, c.start), c.r2);
  f.across = quotient(form(c.metric, quarter), c.metric.scale * c.r2);
  set_axes(f, c);
  if (c.closed) {
    f.end = 4.0;
    f.last = std::nextafter(4.0, 0.0);
  } else {
    set_end(f, c, quarter);
  }
  return f;
}

struct Frames {
  CurveFrame operator()(const Segment& s) const {
    CurveFrame f;
    f.origin = s.from;
    f.a = s.to - s.from;
    const double squared = dot(f.a, f.a);
    if (!(squared > 0.0)) throw std::invalid_argument("a segment of length zero");
    f.major = f.minor = std::sqrt(squared);
    f.along = {f.a.x / squared, f.a.y / squared};
    f.end = 1.0;
    f.last = std::nextafter(1.0, 0.0);
    f.middle = {0.5 * s.from.x + 0.5 * s.to.x, 0.5 * s.from.y + 0.5 * s.to.y};
    return f;
  }
  // Tables hold very many discs: no exact arithmetic where a circle needs none.
  CurveFrame operator()(const Circle& c) const {
    if (!(c.radius > 0.0)) throw std::invalid_argument("a circle whose radius is not positive");
    CurveFrame f;
    f.kind = Kind::closed;
    f.circular = true;
    f.turn = c.counterclockwise ? 1.0 : -1.0;
    f.origin = f.middle = c.centre;
    f.a = {c.radius, 0.0};
    f.b = {0.0, f.turn * c.radius};
    f.along = {1.0 / c.radius, 0.0};
    f.across = {0.0, f.turn / c.radius};
    f.major = f.minor = c.radius;
    f.end = 4.0;
    f.last = std::nextafter(4.0, 0.0);
    return f;
  }
  CurveFrame operator()(const Bezier& c) const {
    CurveFrame f;
    f.kind = Kind::bezier;
    f.bezier = std::make_shared<const BezierForm>(c);
    f.origin = c.from;
    f.a = c.to - c.from;
    f.major = f.minor = f.bezier->least_tangent;
    f.end = 1.0;
    f.last = std::nextafter(1.0, 0.0);
    f.middle = f.bezier->point(0.5);
    return f;
  }
  CurveFrame operator()(const CircularArc& c) const { return conic_frame(c); }
  CurveFrame operator()(const EllipticArc& c) const { return conic_frame(c); }
  CurveFrame operator()(const Ellipse& c) const { return conic_frame(c); }
};

}  // namespace

ExactEnd end_of(const ExactCurve& c, const DyadicVector& quarter) {
  // With e = to - centre, w = Y/(1 + X) in the frame of its quarter.
  Dyadic x = c.metric.scale * c.metric(c.end, c.start);
  Dyadic y = c.metric(c.end, quarter);
  const Dyadic r2 = c.metric.scale * c.r2;
  int n = 0;
  while (!(x.sign() > 0 && y.sign() >= 0)) {
    const Dyadic previous = x;
    x = y;
    y = -previous;
    if (++n > 3) throw std::logic_error("the end of an arc lies on no quarter");
  }
  return {n, y.rational() / mpq_class(r2.rational() + x.rational())};
}

CurveFrame frame_of(const Curve& curve) { return std::visit(Frames{}, curve); }

}  // namespace carom::geometry
