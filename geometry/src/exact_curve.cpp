#include "exact_curve.hpp"

#include <cmath>

namespace carom::geometry {

Dyadic Metric::operator()(const DyadicVector& e, const DyadicVector& f) const {
  if (euclidean) return dot(e, f);
  return k2 * dot(e, p) * dot(f, p) + cross(p, e) * cross(p, f);  // e . left(p) = cross(p, e)
}

DyadicVector Metric::quarter(const DyadicVector& e) const {
  if (euclidean) return left(e);
  const Dyadic along = cross(p, e), across = k2 * dot(e, p);
  const DyadicVector q = left(p);
  return {across * q.x - along * p.x, across * q.y - along * p.y};
}

Metric metric_of(Vector axis, double ratio) {
  Metric m;
  m.euclidean = false;
  m.p = exact(axis);
  m.k = Dyadic(ratio);
  m.k2 = m.k * m.k;
  m.scale = m.k * dot(m.p, m.p);
  return m;
}

namespace {

struct Builder {
  ExactCurve& c;

  void operator()(const Segment& s) const {
    c.from = exact(s.from);
    c.to = exact(s.to);
    c.direction = c.to - c.from;
  }
  void arc(Vector from, Vector to, double offset, bool counterclockwise) const {
    c.segment = false;
    c.orientation = counterclockwise ? 1 : -1;
    c.from = exact(from);
    c.to = exact(to);
    const Dyadic half(0.5);
    c.centre = half * (c.from + c.to) + Dyadic(offset) * c.metric.quarter(c.to - c.from);
    finish();
  }
  void operator()(const CircularArc& a) const { arc(a.from, a.to, a.offset, a.counterclockwise); }
  void operator()(const EllipticArc& a) const {
    c.metric = metric_of(a.axis, a.ratio);
    arc(a.from, a.to, a.offset, a.counterclockwise);
  }
  void operator()(const Circle& o) const { full(o.centre, {o.radius, 0.0}, o.counterclockwise); }
  void operator()(const Ellipse& o) const {
    c.metric = metric_of(o.axis, o.ratio);
    full(o.centre, o.axis, o.counterclockwise);
  }
  void operator()(const Bezier& b) const {
    c.segment = false;
    c.from = exact(b.from);
    c.to = exact(b.to);
    // Differences of the control points, again and again, times binomials.
    std::vector<DyadicVector> d;
    for (int i = 0; i <= b.degree; ++i) d.push_back(exact(b.control(i)));
    int binomial = 1;
    for (int k = 0; k <= b.degree; ++k) {
      c.power.push_back(Dyadic(binomial) * d[0]);
      binomial = binomial * (b.degree - k) / (k + 1);
      for (std::size_t i = 0; i + 1 < d.size(); ++i) d[i] = d[i + 1] - d[i];
      d.pop_back();
    }
  }
  void full(Vector centre, Vector start, bool counterclockwise) const {
    c.segment = false;
    c.closed = true;
    c.orientation = counterclockwise ? 1 : -1;
    c.centre = exact(centre);
    c.from = c.to = c.centre + exact(start);
    finish();
  }
  void finish() const {
    c.start = c.from - c.centre;
    c.end = c.to - c.centre;
    c.r2 = c.metric(c.start, c.start);
  }
};

}  // namespace

ExactCurve::ExactCurve(const Curve& curve) { std::visit(Builder{*this}, curve); }

ExactPoint ExactCurve::point(double u) const {
  const Dyadic one(1);
  if (segment) {
    const Dyadic t(u);
    return {from.x + t * direction.x, from.y + t * direction.y, one};
  }
  if (bezier()) {
    const Dyadic t(u);
    DyadicVector x = power.back();
    for (std::size_t k = power.size() - 1; k-- > 0;) x = power[k] + t * x;
    return {x.x, x.y, one};
  }
  const double quarters = std::floor(u);
  const Dyadic w(u - quarters);
  DyadicVector a = metric.scale * start;
  DyadicVector b = metric.quarter(start);
  if (orientation < 0) b = -b;
  for (int n = static_cast<int>(quarters); n > 0; --n) {
    const DyadicVector previous = a;
    a = b;
    b = -previous;
  }
  const Dyadic w2 = w * w;
  const Dyadic weight = (one + w2) * metric.scale;
  const DyadicVector e = (one - w2) * a + (Dyadic(2) * w) * b;
  return {weight * centre.x + e.x, weight * centre.y + e.y, weight};
}

bool ExactCurve::rests_at_end() const {
  DyadicVector sum;
  for (std::size_t k = 1; k < power.size(); ++k) sum = sum + Dyadic(static_cast<int>(k)) * power[k];
  return sum.x.sign() == 0 && sum.y.sign() == 0;
}

DyadicVector ExactCurve::direction_at(double u) const {
  if (!bezier()) return tangent(u < 0.0 ? end_point() : point(u));
  const Dyadic t(u < 0.0 ? 1.0 : u);
  DyadicVector x, second;  // the derivatives
  for (std::size_t k = power.size(); k-- > 1;) {
    second = x + t * second;
    x = Dyadic(static_cast<int>(k)) * power[k] + t * x;
  }
  if (x.x.sign() != 0 || x.y.sign() != 0) return x;
  // The curve rests at this end: it runs along the second derivative, and against it, at its end.
  return u < 0.0 ? -second : second;
}

DyadicVector ExactCurve::tangent(const ExactPoint& at) const {
  if (segment) return direction;
  const DyadicVector e{at.x - at.w * centre.x, at.y - at.w * centre.y};
  const DyadicVector turned = metric.quarter(e);
  return orientation > 0 ? turned : -turned;
}

}  // namespace carom::geometry
