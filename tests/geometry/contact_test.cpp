// Contacts of pieces against CGAL's circular kernel, which shares no code with them.
#include "contact.hpp"

#include <CGAL/Exact_circular_kernel_2.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/one_of.hpp"

namespace carom::geometry {
namespace {

using K = CGAL::Exact_circular_kernel_2;
using Arc = K::Circular_arc_2;
using Line = K::Line_arc_2;

struct Met {
  int points = 0, overlaps = 0;
  std::vector<double> places;
};

K::FT number(const Dyadic& d) { return K::FT(d.rational().get_mpq_t()); }
K::Point_2 point(const DyadicVector& v) { return {number(v.x), number(v.y)}; }

template <class A, class B>
Met oracle(const A& a, const B& b) {
  using Result = typename CGAL::CK2_Intersection_traits<K, A, B>::type;
  std::vector<Result> all;
  CGAL::intersection(a, b, std::back_inserter(all));
  Met met;
  for (const Result& r : all) {
    if (const auto* p = one_of<std::pair<K::Circular_arc_point_2, unsigned>>(r)) {
      ++met.points;
      met.places.push_back(CGAL::to_double(p->first.x()) + 1e3 * CGAL::to_double(p->first.y()));
    } else {
      ++met.overlaps;
    }
  }
  std::sort(met.places.begin(), met.places.end());
  return met;
}

Arc arc_of(const Curve& curve) {
  const ExactCurve c(curve);
  const K::Circle_2 circle(point(c.centre), number(c.r2));
  if (c.closed) return Arc(circle);
  const DyadicVector& from = c.orientation > 0 ? c.from : c.to;
  const DyadicVector& to = c.orientation > 0 ? c.to : c.from;
  return {circle, K::Circular_arc_point_2(point(from)), K::Circular_arc_point_2(point(to))};
}
Line line_of(const Curve& curve) {
  const ExactCurve c(curve);
  return {point(c.from), point(c.to)};
}

Met oracle(const Curve& a, const Curve& b) {
  const bool line_a = std::holds_alternative<Segment>(a),
             line_b = std::holds_alternative<Segment>(b);
  if (line_a && line_b) return oracle(line_of(a), line_of(b));
  if (line_a) return oracle(line_of(a), arc_of(b));
  if (line_b) return oracle(line_of(b), arc_of(a));
  return oracle(arc_of(a), arc_of(b));
}

std::vector<Contact> own(const Curve& a, const Curve& b) {
  return contacts(ExactPiece(a, DyadicVector{}), ExactPiece(b, DyadicVector{}));
}

/// Small whole numbers, so that joints, tangencies and common carriers are frequent.
struct Family {
  std::mt19937_64 random{17};
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }
  Vector grid() { return {double(whole(-3, 3)), double(whole(-3, 3))}; }
  Curve next() {
    for (;;) {
      const Vector a = grid(), b = grid();
      if (a == b) continue;
      switch (whole(0, 4)) {
        case 0:
        case 1:
          return Segment{a, b};
        case 2:
          return Circle{a, double(whole(1, 3)), whole(0, 1) == 0};
        default:
          return CircularArc{a, b, 0.25 * whole(-4, 4), whole(0, 1) == 0};
      }
    }
  }
};

/// A piece of the same line or circle.
Curve sibling(const Curve& curve, Family& family) {
  if (const auto* s = std::get_if<Segment>(&curve)) {
    const Vector d = s->to - s->from;
    const double from = 0.5 * family.whole(-3, 4), to = from + 0.5 * family.whole(1, 4);
    const Segment along{s->from + from * d, s->from + to * d};
    return family.whole(0, 1) == 0 ? along : std::get<Segment>(reversed(along));
  }
  if (const auto* c = std::get_if<Circle>(&curve))
    return CircularArc{{c->centre.x + c->radius, c->centre.y},
                       {c->centre.x - c->radius, c->centre.y},
                       0.0,
                       family.whole(0, 1) == 0};
  // Between the ends and the points opposite to them.
  auto arc = std::get<CircularArc>(curve);
  const Vector c = 0.5 * (arc.from + arc.to) + arc.offset * left(arc.to - arc.from);
  arc.counterclockwise = family.whole(0, 1) == 0;
  const int kind = family.whole(0, 3);
  if (kind == 1) arc = {arc.from, c + c - arc.from, 0.0, arc.counterclockwise};
  if (kind == 2) arc = {c + c - arc.to, arc.to, 0.0, arc.counterclockwise};
  if (kind == 3) arc = {c + c - arc.from, c + c - arc.to, arc.offset, arc.counterclockwise};
  return arc;
}

TEST(Contact, AgreesWithTheCircularKernel) {
  Family family;
  int crossings = 0, touches = 0, joints = 0, common = 0;
  for (int i = 0; i < 8000; ++i) {
    const Curve a = family.next(), b = i % 16 == 0 ? sibling(a, family) : family.next();
    const std::vector<Contact> mine = own(a, b);
    const Met expected = oracle(a, b);
    const bool together = !mine.empty() && mine[0].kind == Contact::Kind::together;
    ASSERT_EQ(together, expected.overlaps > 0) << i;
    common += together;
    if (together) continue;
    ASSERT_EQ(static_cast<int>(mine.size()), expected.points) << i;
    std::vector<double> places;
    for (const Contact& c : mine) {
      places.push_back(c.place.x + 1e3 * c.place.y);
      crossings += c.kind == Contact::Kind::cross;
      touches += c.kind == Contact::Kind::touch;
      joints += c.kind == Contact::Kind::joint;
    }
    std::sort(places.begin(), places.end());
    for (std::size_t k = 0; k < places.size(); ++k)
      ASSERT_NEAR(places[k], expected.places[k], 1e-9) << i;
  }
  // Each kind has been met often.
  EXPECT_GT(crossings, 1000);
  EXPECT_GT(touches, 20);
  EXPECT_GT(joints, 1000);
  EXPECT_GT(common, 200);
}

/// (x, y) -> (x, y/2): circles become ellipses, and contacts stay contacts.
Curve flattened(const Curve& curve) {
  const auto flat = [](Vector v) { return Vector{v.x, 0.5 * v.y}; };
  if (const auto* s = std::get_if<Segment>(&curve)) return Segment{flat(s->from), flat(s->to)};
  if (const auto* c = std::get_if<Circle>(&curve))
    return Ellipse{flat(c->centre), {c->radius, 0.0}, 0.5, c->counterclockwise};
  const auto& arc = std::get<CircularArc>(curve);
  // left(B - A) flattened is 2 K (B - A) for p = (1, 0), k = 1/2.
  return EllipticArc{flat(arc.from),   flat(arc.to),        {1.0, 0.0}, 0.5,
                     2.0 * arc.offset, arc.counterclockwise};
}

TEST(Contact, EllipsesAreFlattenedCircles) {
  Family family;
  for (int i = 0; i < 1500; ++i) {
    const Curve a = family.next(), b = family.next();
    const std::vector<Contact> round = own(a, b), flat = own(flattened(a), flattened(b));
    ASSERT_EQ(round.size(), flat.size()) << i;
    for (std::size_t k = 0; k < round.size(); ++k) {
      EXPECT_EQ(round[k].kind, flat[k].kind) << i;
      EXPECT_EQ(round[k].on_first, flat[k].on_first) << i;
      EXPECT_EQ(round[k].on_second, flat[k].on_second) << i;
    }
  }
}

TEST(Contact, EitherOrderAndDirectionTellTheSame) {
  Family family;
  for (int i = 0; i < 1000; ++i) {
    const Curve a = family.next(), b = flattened(family.next());
    const auto kinds = [](std::vector<Contact> found) {
      std::vector<int> k;
      for (const Contact& c : found) k.push_back(static_cast<int>(c.kind));
      std::sort(k.begin(), k.end());
      return k;
    };
    EXPECT_EQ(kinds(own(a, b)), kinds(own(b, a))) << i;
    EXPECT_EQ(kinds(own(a, b)), kinds(own(reversed(a), reversed(b)))) << i;
  }
}

TEST(Contact, CrossingThroughAJointIsToldFromTouching) {
  // Boundary along the x axis, and others that come to the origin and leave it.
  const auto rays = [](const Curve& in, const Curve& out) {
    return rays_at(ExactCurve(in), ExactCurve(out), {Dyadic(0), Dyadic(0), Dyadic(1)});
  };
  const Segment axis{{-1, 0}, {1, 0}};
  const BoundaryRays x = rays(axis, axis);
  const auto corner = [&](Vector from, Vector to) {
    return pass_through(x, rays(Segment{from, {0, 0}}, Segment{{0, 0}, to}));
  };
  EXPECT_EQ(corner({-1, 1}, {1, 1}), Sign::negative);
  EXPECT_EQ(corner({-1, -1}, {1, -1}), Sign::negative);
  EXPECT_EQ(corner({-1, 1}, {1, -1}), Sign::positive);
  EXPECT_EQ(corner({-1, -1}, {1, 1}), Sign::positive);
  // Arcs tangent to the axis, bent up or down: curvature decides.
  const Curve up_right = arc_about({0, 0}, {1, 1}, {0, 1}, true),
              up_left = arc_about({-1, 1}, {0, 0}, {0, 1}, true);
  const Curve down_right = arc_about({0, 0}, {1, -1}, {0, -1}, false);
  EXPECT_EQ(pass_through(x, rays(up_left, up_right)), Sign::negative);
  EXPECT_EQ(pass_through(x, rays(up_left, down_right)), Sign::positive);
  // The same tangent and curvature: not decided.
  EXPECT_EQ(pass_through(rays(up_left, up_right), rays(up_left, up_right)), Sign::zero);
  // A rounder arc on the same side is inside.
  const Curve tight_right = arc_about({0, 0}, {0.5, 0.5}, {0, 0.5}, true),
              tight_left = arc_about({-0.5, 0.5}, {0, 0}, {0, 0.5}, true);
  EXPECT_EQ(pass_through(rays(up_left, up_right), rays(tight_left, tight_right)), Sign::negative);
  EXPECT_EQ(pass_through(rays(up_left, up_right), rays(tight_left, down_right)), Sign::positive);
}

}  // namespace
}  // namespace carom::geometry
