// Centres, semi-axes and angles of arcs lead to the points of the curves.
#include "carom/geometry/arc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace carom::geometry {
namespace {

const std::vector<Curve> curves{
    arc_through({1, 0}, {0, 1}, {-1, 0}),
    arc_through({1, 0}, {0.6, -0.8}, {0, 1}),  // most of a circle, clockwise
    arc_about({3, 1}, {1, 3}, {1, 1}, true),
    Circle{{2, -1}, 0.5, true},
    Circle{{2, -1}, 0.5, false},
    elliptic_arc_through({2, 0}, {0, 1}, {-2, 0}, {1, 0}, 0.5),
    elliptic_arc_through({0, 3}, {-1, 0}, {0, -3}, {1, 0}, 3.0),
    Ellipse{{1, 1}, {0.6, 0.8}, 2.0, false},
    Ellipse{{0, 0}, {0, 2}, 0.25, true},
};

Vector point(const Arc& arc, double share) {
  const double phi = arc.from + share * (arc.to - arc.from);
  const Vector e{std::cos(arc.axis), std::sin(arc.axis)};
  return arc.centre + arc.a * std::cos(phi) * e + arc.b * std::sin(phi) * left(e);
}

TEST(Arc, RunsFromStartToEndOnTheCurve) {
  for (const Curve& curve : curves) {
    const auto arc = arc_of(curve);
    ASSERT_TRUE(arc);
    const auto near = [](Vector p, Vector q) { return std::hypot(p.x - q.x, p.y - q.y) < 1e-14; };
    EXPECT_TRUE(near(point(*arc, 0), start_point(curve))) << curve.index();
    EXPECT_TRUE(near(point(*arc, 1), end_point(curve))) << curve.index();
    for (const double share : {0.2, 0.5, 0.9}) {
      const Vector p = point(*arc, share);
      EXPECT_TRUE(near(p, point_at(curve, parameter_of(curve, p)))) << curve.index();
    }
    double length = 0.0;  // of a polygon: the right way round, and once
    for (int i = 0; i < 1000; ++i) {
      const Vector step = point(*arc, (i + 1) / 1000.0) - point(*arc, i / 1000.0);
      length += std::hypot(step.x, step.y);
    }
    EXPECT_NEAR(length, geometry::length(curve), 1e-4 * length) << curve.index();
  }
}

TEST(Arc, OfASegmentThereIsNone) { EXPECT_FALSE(arc_of(Segment{{0, 0}, {1, 0}})); }

}  // namespace
}  // namespace carom::geometry
