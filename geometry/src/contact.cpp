#include "contact.hpp"

#include <utility>

namespace carom::geometry {

namespace {

ExactPoint point_of(const DyadicVector& v) { return {v.x, v.y, Dyadic(1)}; }
Vector rounded(const ExactPoint& p) {
  const double weight = p.w.approximate();
  return {p.x.approximate() / weight, p.y.approximate() / weight};
}

Contact swapped(Contact c) {
  std::swap(c.on_first, c.on_second);
  return c;
}

/// Both on one line or conic: the ends tell everything.
std::vector<Contact> contacts_on_one_carrier(const ExactPiece& first, const ExactPiece& second) {
  const ExactCurve &a = first.curve(), &b = second.curve();
  std::vector<Contact> found;
  const auto together = [&](const DyadicVector& at) {
    return std::vector<Contact>{
        {Contact::Kind::together, Where::inside, Where::inside, rounded(point_of(at))}};
  };
  if (a.closed || b.closed) return together(a.closed ? b.from : a.from);
  int shared = 0;
  for (const DyadicVector& end : {a.from, a.to}) {
    const Where on = second.where(point_of(end));
    if (on == Where::inside) return together(end);
    if (on == Where::outside) continue;
    ++shared;
    found.push_back({Contact::Kind::joint, first.where(point_of(end)), on, rounded(point_of(end))});
  }
  for (const DyadicVector& end : {b.from, b.to})
    if (first.where(point_of(end)) == Where::inside) return together(end);
  if (shared == 2) {
    // The same ends: the same piece, or the two parts of one conic.
    const DyadicVector turned = (a.to - a.from) - (b.to - b.from);
    const bool same_chord = turned.x.sign() == 0 && turned.y.sign() == 0;
    if (a.segment || (a.orientation == b.orientation) == same_chord) return together(a.from);
  }
  return found;
}

std::vector<Contact> contacts_of_segments(const ExactCurve& a, const ExactCurve& b) {
  const auto side = [](const ExactCurve& line, const DyadicVector& p) {
    return cross(line.direction, p - line.from).sign();
  };
  const int b0 = side(a, b.from), b1 = side(a, b.to);
  if (b0 * b1 > 0) return {};
  const int a0 = side(b, a.from), a1 = side(b, a.to);
  if (a0 * a1 > 0) return {};
  const auto place = [](int at_start, int at_end) {
    return at_start == 0 ? Where::start : at_end == 0 ? Where::end : Where::inside;
  };
  const Where on_a = place(a0, a1), on_b = place(b0, b1);
  Vector at;
  if (on_a != Where::inside) {
    at = rounded(point_of(on_a == Where::start ? a.from : a.to));
  } else if (on_b != Where::inside) {
    at = rounded(point_of(on_b == Where::start ? b.from : b.to));
  } else {
    const double share = cross(b.direction, b.from - a.from).approximate() /
                         cross(b.direction, a.direction).approximate();
    at = rounded(point_of(a.from + Dyadic(share) * a.direction));
  }
  const bool inner = on_a == Where::inside && on_b == Where::inside;
  return {{inner ? Contact::Kind::cross : Contact::Kind::joint, on_a, on_b, at}};
}

}  // namespace

std::vector<Contact> contacts(const ExactPiece& first, const ExactPiece& second) {
  // The parameter of the simpler piece is put into the other's equation.
  if (second.curve().segment && !first.curve().segment) {
    std::vector<Contact> found = contacts(second, first);
    for (Contact& c : found) c = swapped(c);
    return found;
  }
  if (vanishes(second.equation(first.stretches().front())))
    return contacts_on_one_carrier(first, second);
  if (first.curve().segment && second.curve().segment)
    return contacts_of_segments(first.curve(), second.curve());
  std::vector<Contact> found;
  for (std::size_t i = 0; i < first.stretches().size(); ++i) {
    const Stretch& stretch = first.stretches()[i];
    for (const RealRoot& root : roots_in_unit(second.equation(stretch))) {
      const Where on_first = first.where_along(i, root.value);
      if (on_first == Where::outside) continue;
      const Where on_second = second.where(Spot{&stretch, root.value});
      if (on_second == Where::outside) continue;
      const bool inner = on_first == Where::inside && on_second == Where::inside;
      found.push_back({!inner                       ? Contact::Kind::joint
                       : root.multiplicity % 2 != 0 ? Contact::Kind::cross
                                                    : Contact::Kind::touch,
                       on_first, on_second, rounded_point(stretch, approximate(root.value))});
    }
  }
  return found;
}

Discs compare_discs(const ExactCurve& first, const ExactCurve& second) {
  const DyadicVector d = second.centre - first.centre;
  const Dyadic distance2 = dot(d, d);
  const Dyadic sum = first.start.x + second.start.x, difference = first.start.x - second.start.x;
  const int outer = (distance2 - sum * sum).sign();
  if (outer > 0) return Discs::apart;
  if (outer == 0) return Discs::touching;
  const int inner = (distance2 - difference * difference).sign();
  if (inner > 0) return Discs::crossing;
  if (inner < 0) return Discs::nested;
  return distance2.sign() == 0 ? Discs::equal : Discs::touching_nested;
}

BoundaryRays rays_at(const ExactCurve& in, const ExactCurve& out, const ExactPoint& point) {
  const auto ray = [&](const ExactCurve& c) {
    BoundaryRay r{c.tangent(point), Dyadic(0)};
    if (c.segment) return r;
    // x' = K e up to the orientation and x'' = K (K e) = -scale^2 e.
    const DyadicVector e{point.x - point.w * c.centre.x, point.y - point.w * c.centre.y};
    r.bend = c.metric.scale * c.metric.scale * cross(e, r.t);
    return r;
  };
  BoundaryRay back = ray(in);
  back = {-back.t, -back.bend};
  return {back, ray(out)};
}

namespace {

/// -1, 0, 1 as the curvature of a is less than, equal to, greater than that of b.
int compare_curvature(const BoundaryRay& a, const BoundaryRay& b) {
  const int sign = a.bend.sign();
  if (sign != b.bend.sign()) return sign < b.bend.sign() ? -1 : 1;
  const Dyadic p = dot(a.t, a.t), q = dot(b.t, b.t);
  return sign * (a.bend * a.bend * q * q * q - b.bend * b.bend * p * p * p).sign();
}

/// Which fifth of the turn that starts at `from` a ray lies in: 0 just after it, 1 to the left, 2
/// opposite, 3 to the right, 4 just before it; -1 when it cannot be seen from `from`.
int sector(const BoundaryRay& from, const BoundaryRay& ray) {
  const int side = cross(from.t, ray.t).sign();
  if (side != 0) return side > 0 ? 1 : 3;
  if (dot(from.t, ray.t).sign() < 0) return 2;
  const int bend = compare_curvature(ray, from);
  return bend > 0 ? 0 : bend < 0 ? 4 : -1;
}

/// Is `ray` met before `to` when turning counter-clockwise from `from`?
Sign met_first(const BoundaryRay& from, const BoundaryRay& ray, const BoundaryRay& to) {
  const int s = sector(from, ray), t = sector(from, to);
  if (s < 0) return Sign::zero;
  if (t < 0) return Sign::positive;  // a boundary that returns along itself: all is on its left
  if (s != t) return s < t ? Sign::positive : Sign::negative;
  const int side = cross(ray.t, to.t).sign();
  const int order = side != 0 ? side : compare_curvature(to, ray);
  return order > 0 ? Sign::positive : order < 0 ? Sign::negative : Sign::zero;
}

}  // namespace

Sign pass_through(const BoundaryRays& first, const BoundaryRays& second) {
  const Sign back = met_first(first.forth, second.back, first.back);
  const Sign forth = met_first(first.forth, second.forth, first.back);
  if (back == Sign::zero || forth == Sign::zero) return Sign::zero;
  return back == forth ? Sign::negative : Sign::positive;
}

}  // namespace carom::geometry
