#include "exact_piece.hpp"

#include <algorithm>
#include <cstdint>

#include "carom/geometry/bernstein.hpp"
#include "exact_end.hpp"

namespace carom::geometry {

Polynomial plus(const Polynomial& a, const Polynomial& b) {
  Polynomial sum(std::max(a.size(), b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] = a[i];
  for (std::size_t i = 0; i < b.size(); ++i) sum[i] = sum[i] + b[i];
  return sum;
}
Polynomial times(const Dyadic& a, Polynomial p) {
  for (Dyadic& c : p) c = a * c;
  return p;
}
Polynomial times(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] = product[i + j] + a[i] * b[j];
  return product;
}

namespace {

std::vector<Stretch> stretches_of(const ExactCurve& c, int count) {
  const Dyadic zero(0), one(1), two(2);
  if (c.bezier()) {
    Stretch s{{}, {}, {one}};
    for (const DyadicVector& k : c.power) {
      s.x.push_back(k.x);
      s.y.push_back(k.y);
    }
    return {s};
  }
  if (c.segment) return {{{c.from.x, c.direction.x}, {c.from.y, c.direction.y}, {one}}};
  std::vector<Stretch> quarters;
  DyadicVector a = c.metric.scale * c.start, b = c.metric.quarter(c.start);
  if (c.orientation < 0) b = -b;
  const Polynomial weight{c.metric.scale, zero, c.metric.scale};
  for (int n = 0; n < count; ++n) {
    quarters.push_back({plus(times(c.centre.x, weight), {a.x, two * b.x, -a.x}),
                        plus(times(c.centre.y, weight), {a.y, two * b.y, -a.y}), weight});
    const DyadicVector previous = a;
    a = b;
    b = -previous;
  }
  return quarters;
}

int sign_of_value(const Polynomial& p, const AlgebraicRoot& w) {
  return p.size() == 1 ? p[0].sign() : sign_at(p, w);
}

/// `sign(a, p)` tells the sign of a.(X - P) at the point X in question.
Where place_on(const ExactCurve& c, const auto& sign) {
  if (c.closed) return Where::inside;
  const ExactPoint from{c.from.x, c.from.y, Dyadic(1)}, to{c.to.x, c.to.y, Dyadic(1)};
  const DyadicVector chord = c.to - c.from;
  if (c.segment) {
    const int past_start = sign(chord, from);
    if (past_start <= 0) return past_start < 0 ? Where::outside : Where::start;
    const int past_end = sign(chord, to);
    return past_end > 0 ? Where::outside : past_end == 0 ? Where::end : Where::inside;
  }
  // The chord cuts a conic in two arcs; the one run through counter-clockwise is on its right.
  const int side = c.orientation * sign(left(chord), from);
  if (side != 0) return side < 0 ? Where::inside : Where::outside;
  return sign(chord, from) == 0 ? Where::start : Where::end;
}

}  // namespace

Polynomial form_along(const Stretch& s, const DyadicVector& a, const ExactPoint& p) {
  const Polynomial x = plus(times(p.w, s.x), times(-p.x, s.weight));
  const Polynomial y = plus(times(p.w, s.y), times(-p.y, s.weight));
  return plus(times(a.x, x), times(a.y, y));
}

bool vanishes(const Polynomial& p) {
  return std::all_of(p.begin(), p.end(), [](const Dyadic& c) { return c.sign() == 0; });
}

bool keeps_sign_in_unit(const Polynomial& p) {
  // Bernstein coefficients, times 2520, which all binomials of degree 10 and below divide: that
  // makes them whole multiples of p's.
  const auto share = [](const Dyadic& c, int m, int n) {
    return Dyadic(static_cast<int>(std::int64_t{2520} * m / n)) * c;
  };
  const SignChanges changes = sign_changes(bernstein_form<2 * Bezier::most>(p, p.size() - 1, share),
                                           [](const Dyadic& c) { return sign_of(c); });
  return changes.certain && changes.most == 0;
}

std::vector<RealRoot> roots_in_unit(const Polynomial& p) {
  std::vector<RealRoot> result;
  if (keeps_sign_in_unit(p)) return result;
  for (RealRoot& root : real_roots(p))
    if (compare(root.value, mpq_class(0)) >= 0 && compare(root.value, mpq_class(1)) <= 0)
      result.push_back(std::move(root));
  return result;
}

Vector rounded_point(const Stretch& s, double w) {
  const auto value = [w](const Polynomial& p) {
    double sum = 0.0;
    for (std::size_t i = p.size(); i-- > 0;) sum = sum * w + p[i].approximate();
    return sum;
  };
  const double weight = value(s.weight);
  return {value(s.x) / weight, value(s.y) / weight};
}

ExactPiece::ExactPiece(const Curve& curve, const DyadicVector& shift) : curve_(curve) {
  curve_.from = curve_.from + shift;
  curve_.to = curve_.to + shift;
  if (!curve_.segment) curve_.centre = curve_.centre + shift;
  if (curve_.bezier()) curve_.power[0] = curve_.power[0] + shift;
  int count = 4;
  if (!curve_.segment && !curve_.closed && !curve_.bezier()) {
    const DyadicVector turned = curve_.metric.quarter(curve_.start);
    const ExactEnd end = end_of(curve_, curve_.orientation > 0 ? turned : -turned);
    const bool full = sgn(end.w) == 0;  // ends with a full quarter
    count = full ? end.quarter : end.quarter + 1;
    last_ = full ? mpq_class(1) : end.w;
  }
  stretches_ = stretches_of(curve_, count);
}

std::vector<Stretch> ExactPiece::whole_stretches() const {
  std::vector<Stretch> all = stretches_;
  // w = w' last: coefficient k of degree d, times the denominator^d.
  const Dyadic p(last_.get_num()), q(last_.get_den());
  Polynomial* parts[] = {&all.back().x, &all.back().y, &all.back().weight};
  std::size_t degree = 0;
  for (const Polynomial* part : parts) degree = std::max(degree, part->size() - 1);
  if (last_ == 1) return all;
  for (Polynomial* part : parts)
    for (std::size_t k = 0; k < part->size(); ++k)
      for (std::size_t i = 0; i < degree; ++i) (*part)[k] = (*part)[k] * (i < k ? p : q);
  return all;
}

bool passes_through(const Stretch& s, const ExactPoint& p) {
  const DyadicVector x{Dyadic(1), Dyadic(0)}, y{Dyadic(0), Dyadic(1)};
  const Polynomial other = form_along(s, y, p);
  for (const RealRoot& root : roots_in_unit(form_along(s, x, p)))
    if (sign_of_value(other, root.value) == 0) return true;
  return false;
}

Polynomial ExactPiece::equation(const Stretch& s) const {
  const ExactCurve& c = curve_;
  if (c.segment) return form_along(s, left(c.direction), {c.from.x, c.from.y, Dyadic(1)});
  const ExactPoint centre{c.centre.x, c.centre.y, Dyadic(1)};
  const Metric& m = c.metric;
  const Polynomial along = form_along(s, m.p, centre), across = form_along(s, left(m.p), centre);
  return plus(plus(times(m.k2, times(along, along)), times(across, across)),
              times(-c.r2, times(s.weight, s.weight)));
}

int ExactPiece::side(const ExactPoint& p) const {
  return equation({{p.x}, {p.y}, {p.w}})[0].sign();
}

Where ExactPiece::where(const Spot& spot) const {
  return place_on(curve_, [&](const DyadicVector& a, const ExactPoint& p) {
    return sign_of_value(form_along(*spot.stretch, a, p), spot.w);
  });
}

Where ExactPiece::where(const ExactPoint& point) const {
  return place_on(curve_, [&](const DyadicVector& a, const ExactPoint& p) {
    return dot(a, DyadicVector{point.x * p.w - p.x * point.w, point.y * p.w - p.y * point.w})
        .sign();
  });
}

Where ExactPiece::where_along(std::size_t index, const AlgebraicRoot& w) const {
  const int from_start = compare(w, mpq_class(0));
  if (from_start < 0) return Where::outside;
  if (from_start == 0 && index == 0 && !curve_.closed) return Where::start;
  const bool last = index + 1 == stretches_.size();
  const int from_end = compare(w, last ? last_ : mpq_class(1));
  if (from_end > 0) return Where::outside;
  if (from_end < 0) return Where::inside;
  // The end of a quarter is the start of the next one.
  return last && !curve_.closed ? Where::end : Where::outside;
}

}  // namespace carom::geometry
