// Four-fold arithmetic as a reference for bounds on rounding: its own errors are 2^-59 of theirs.
#pragma once

#include <cmath>
#include <stdexcept>

#include "carom/geometry/curve.hpp"
#include "carom/geometry/vector.hpp"

namespace carom::tests {

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Quad;
extern "C" {  // of libquadmath, whose header GCC alone finds
Quad sinq(Quad);
Quad cosq(Quad);
Quad atan2q(Quad, Quad);
}
inline Quad sine(Quad x) { return sinq(x); }
inline Quad cosine(Quad x) { return cosq(x); }
inline Quad angle(Quad y, Quad x) { return atan2q(y, x); }
#else
using Quad = long double;  // 128 bits where there is no other name for them
inline Quad sine(Quad x) { return std::sin(x); }
inline Quad cosine(Quad x) { return std::cos(x); }
inline Quad angle(Quad y, Quad x) { return std::atan2(y, x); }
#endif
using QuadVector = geometry::BasicVector<Quad>;

inline QuadVector quad(geometry::Vector v) { return {Quad(v.x), Quad(v.y)}; }
inline Quad magnitude(const Quad& x) { return x < 0 ? -x : x; }
inline double largest(const QuadVector& v) {
  const Quad x = magnitude(v.x), y = magnitude(v.y);
  return double(x > y ? x : y);
}
inline Quad root(const Quad& x) {
  if (!(x > 0)) return Quad(0);
  Quad r = Quad(std::sqrt(double(x)));
  for (int i = 0; i < 2; ++i) r = Quad(0.5) * (r + x / r);
  return r;
}

/// A curve from its definition: segment from -> to, or centre, start vector a and its quarter turn
/// b.
struct QuadCurve {
  bool segment = false;
  Quad sense = 1;  // +1: domain inside
  QuadVector from, to, centre, a, b;
  QuadVector p{Quad(1), Quad(0)};  // axis of the metric
  Quad k = 1;

  explicit QuadCurve(const geometry::Curve& curve) { std::visit(*this, curve); }
  void operator()(const geometry::Segment& s) {
    segment = true;
    from = quad(s.from);
    to = quad(s.to);
  }
  void operator()(const geometry::CircularArc& s) {
    arc(s.from, s.to, s.offset, s.counterclockwise);
  }
  void operator()(const geometry::EllipticArc& s) {
    p = quad(s.axis);
    k = Quad(s.ratio);
    arc(s.from, s.to, s.offset, s.counterclockwise);
  }
  void operator()(const geometry::Circle& s) {
    full(s.centre, {s.radius, 0.0}, s.counterclockwise);
  }
  void operator()(const geometry::Bezier&) { throw std::logic_error("a Bézier curve: no conic"); }
  void operator()(const geometry::Ellipse& s) {
    p = quad(s.axis);
    k = Quad(s.ratio);
    full(s.centre, s.axis, s.counterclockwise);
  }

  Quad metric(const QuadVector& e, const QuadVector& f) const {
    const QuadVector q = left(p);
    return k * k * dot(e, p) * dot(f, p) + dot(e, q) * dot(f, q);
  }
  QuadVector turned(const QuadVector& e) const {
    const QuadVector q = left(p);
    const Quad x = -dot(e, q), y = k * k * dot(e, p);
    return {x * p.x + y * q.x, x * p.y + y * q.y};
  }
  QuadVector point(double u) const {
    if (segment) return from + Quad(u) * (to - from);
    const double quarter = std::floor(u);
    QuadVector c = a, s = b;
    for (int i = 0; i < int(quarter); ++i) {
      const QuadVector before = c;
      c = s;
      s = -before;
    }
    const Quad w = Quad(u) - Quad(quarter), n = Quad(1) + w * w;
    return centre + ((Quad(1) - w * w) / n) * c + (Quad(2) * w / n) * s;
  }
  /// Inward normal of any length at a point of the curve.
  QuadVector normal(const QuadVector& at) const {
    if (segment) return left(to - from);
    const QuadVector t = sense * turned(at - centre);
    return left(t);
  }

 private:
  void arc(geometry::Vector start, geometry::Vector end, double offset, bool counterclockwise) {
    from = quad(start);
    to = quad(end);
    centre = Quad(0.5) * (from + to) + Quad(offset) * turned(to - from);
    finish(counterclockwise);
  }
  void full(geometry::Vector middle, geometry::Vector axis, bool counterclockwise) {
    centre = quad(middle);
    from = to = centre + quad(axis);
    finish(counterclockwise);
  }
  void finish(bool counterclockwise) {
    sense = counterclockwise ? 1 : -1;
    a = from - centre;
    b = (sense / (k * dot(p, p))) * turned(a);
  }
};

}  // namespace carom::tests
