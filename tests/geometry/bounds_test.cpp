// Every bound of the filter against the error it bounds: never above it, and not idle.
#include <gtest/gtest.h>

#include <string>

#include "carom/geometry/quartic.hpp"
#include "geometry/bounds.hpp"

namespace carom::tests {
namespace {

using namespace bounds;
using namespace geometry;

TEST(Bounds, SideOfAJointHasItsBound) {
  sweep("side", random_segment, [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
    const Vector joint = start_point(scene.curve), d = joint - s.start;
    const Quad side = side_of_flight(quad(s.velocity), quad(joint) - s.exact_start, Quad(s.omega));
    r.add("side", side, side_of_flight(s.velocity, d, s.omega), side_error(s.scale, norm_1(d)));
  });
}

TEST(Bounds, CentreOfALarmorCircleHasItsBound) {
  sweep("centre", random_segment, [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
    if (s.omega == 0.0) return;
    const PreparedCurve& w = scene.rounded;
    const QuadCurve& q = scene.exact;
    const double turn = s.omega > 0.0 ? 1.0 : -1.0, omega = turn * s.omega;
    const QuadVector v = quad(turn * s.velocity), d = q.to - q.from;
    const Quad length = root(dot(d, d));
    const QuadVector tangent = (Quad(1) / length) * d,
                     centre = centre_of_circle(s.exact_start - q.from, v, Quad(omega));
    const Vector e = s.start - w.from, rounded = centre_of_circle(e, turn * s.velocity, omega);
    const CentreError bound = centre_error(
        s.scale, std::fmax(norm_1(e), std::fmax(norm_1(s.start - w.to), norm_1(w.direction))));
    r.add("joint inside", dot(centre, centre) - dot(v, v), dot(rounded, rounded) - s.square,
          bound.joint);
    r.add("height", root(dot(v, v)) - magnitude(cross(tangent, centre)),
          std::sqrt(s.square) - std::fabs(cross(w.tangent, rounded)), bound.segment);
    r.add("foot", dot(tangent, centre), dot(w.tangent, rounded), bound.segment);
    r.add("far foot", Quad(omega) * length - dot(tangent, centre),
          omega * w.length - dot(w.tangent, rounded), bound.segment);
  });
}

TEST(Bounds, LineHasItsBound) {
  sweep("line", random_segment, [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
    const PreparedCurve& w = scene.rounded;
    const QuadCurve& q = scene.exact;
    const QuadVector d = q.to - q.from;
    const QuadVector tangent = (Quad(1) / root(dot(d, d))) * d;
    const auto value =
        line_quadratic(s.exact_start - q.from, tangent, quad(s.velocity), Quad(s.omega), Quad(0.5));
    const Vector e = s.start - w.from;
    const auto rounded = line_quadratic(e, w.tangent, s.velocity, s.omega, 0.5);
    const QuadraticError bound = line_error(s.scale, norm_1(e));
    r.add("line a", value.a, rounded.a, bound.a);
    r.add("line b", value.b, rounded.b, bound.b);
    if (s.omega != 0.0) r.add("line c", value.c, rounded.c, bound.c);
  });
}

TEST(Bounds, CircleAndDerivedNumbersHaveTheirBounds) {
  sweep("circle", random_circle, [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
    const PreparedCurve& w = scene.rounded;
    const QuadCurve& q = scene.exact;
    const auto value =
        circle_quadratic(s.exact_start - q.centre, dot(q.a, q.a), quad(s.velocity),
                         dot(quad(s.velocity), quad(s.velocity)), Quad(s.omega), Quad(0.5));
    const Vector e = s.start - w.centre;
    const auto rounded = s.omega == 0.0
                             ? circle_quadratic(e, w.r2, s.velocity, s.square)
                             : circle_quadratic(e, w.r2, s.velocity, s.square, s.omega, 0.5);
    const QuadraticError bound = circle_error(s.scale, norm_1(e), w.centre_error, w.r2);
    r.add("circle a", value.a, rounded.a, bound.a);
    r.add("circle b", value.b, rounded.b, bound.b);
    r.add("circle c", value.c, rounded.c, bound.c);
    r.add("circle discriminant", value.b * value.b - value.a * value.c,
          rising_root(rounded).discriminant, discriminant_error(rounded, bound));
  });
}

// Near the centre of a circle nothing but the roundings of r^2 is left, and all of them count.
TEST(Bounds, CircleSeenFromNearItsCentreHasItsBound) {
  Ratios r;
  Dice dice(11);
  for (long i = cases(200000, 20000000); i > 0; --i) {
    const double radius = dice.between(1.0, 1.0005),
                 r2 = PreparedCurve(Circle{{0, 0}, radius, false}).r2;
    const Vector e = dice.spread(0x1p-28, 0x1p-25) * dice.direction();
    const FlightScale still{};
    const Quad exact = dot(quad(e), quad(e)) - Quad(radius) * Quad(radius);
    r.add("circle a near the centre", exact, circle_quadratic(e, r2, Vector{1, 0}, 1.0).a,
          circle_error(still, norm_1(e), 0.0, r2).a);
  }
  r.expect();
}

TEST(Bounds, DiscriminantAndKappaHaveTheirBounds) {
  // Coefficients at the edge of their errors.
  Ratios r;
  Dice dice(5);
  for (long i = cases(100000, 10000000); i > 0; --i) {
    const double scale = dice.spread(1e-6, 1e6);
    Quadratic<double> q{dice.between(-1, 1), dice.between(-1, 1) * scale,
                        dice.between(-1, 1) * scale * scale};
    const double part = dice.coin() ? 0.0 : dice.spread(u, 1e-6);
    const QuadraticError e{part * dice.unit(), part * dice.unit() * scale,
                           part * dice.unit() * scale * scale};
    const Quad a = Quad(q.a) + Quad(e.a) * Quad(dice.sign()),
               b = Quad(q.b) + Quad(e.b) * Quad(dice.sign()),
               c = Quad(q.c) + Quad(e.c) * Quad(dice.sign()), discriminant = b * b - a * c;
    const Root found = rising_root(q);
    const char* kind = part == 0.0 ? "rounding alone" : "with errors";
    r.add((std::string("discriminant, ") + kind).c_str(), discriminant, found.discriminant,
          discriminant_error(q, e));
    const double error = kappa_error(q, e, found);
    if (!(error < HUGE_VAL)) continue;
    ASSERT_GT(double(discriminant), 0.0);
    const Quad n = root(discriminant);
    const Quad kappa = q.b <= 0.0 ? (n - b) / a : -c / (b + n);
    r.add((std::string("kappa, ") + kind).c_str(), kappa, found.kappa, error);
    // The point there: kappa at the edge of its error.
    Sample s(dice, part == 0.0, random_size(dice));
    s.scale.omega = std::fabs(s.omega = dice.coin() ? 0.0
                                                    : dice.sign() * dice.spread(1e-3, 1e3) *
                                                          std::fabs(found.kappa));
    const QuadVector x = displacement(kappa, quad(s.velocity), Quad(s.omega), Quad(0.5));
    const Vector d = displacement(found.kappa, s.velocity, s.omega, 0.5);
    r.add((std::string("point, ") + kind).c_str(),
          largest(x + (s.exact_start - quad(s.start)) - quad(d)),
          point_error(s.scale, found.kappa, error, norm_1(d)));
  }
  r.expect();
}

TEST(Bounds, EllipseWithoutFieldHasItsBounds) {
  sweep("ellipse", random_ellipse, [](const Sample& s, const Scene& scene, Dice&, Ratios& r) {
    const PreparedCurve& w = scene.rounded;
    const QuadCurve& q = scene.exact;
    const QuadVector e = s.exact_start - q.centre, v = quad(s.velocity);
    const Quad r2 = q.metric(q.a, q.a);
    const Vector f = s.start - w.centre;
    const auto rounded = geometry::ellipse_quadratic(f, s.velocity, w.first_direction,
                                                     w.first_weight, w.second_weight);
    const QuadraticError bound = ellipse_error(
        s.scale, norm_1(f), w.centre_error, std::max(norm_1(w.first_axis), norm_1(w.second_axis)));
    r.add("ellipse a", q.metric(e, e) / r2 - Quad(1), rounded.a, bound.a);
    r.add("ellipse b", q.metric(e, v) / r2, rounded.b, bound.b);
    r.add("ellipse c", q.metric(v, v) / r2, rounded.c, bound.c);
  });
}

TEST(Bounds, EllipseInAFieldHasItsBounds) {
  sweep("quartic", random_ellipse, [](Sample s, const Scene& scene, Dice&, Ratios& r) {
    if (s.omega == 0.0) s.omega = s.scale.omega = 1.0 / s.size;
    const PreparedCurve& w = scene.rounded;
    const QuadCurve& q = scene.exact;
    const QuadVector e = s.exact_start - q.centre, v = quad(s.velocity), j = right(v);
    const Quad r2 = q.metric(q.a, q.a), omega(s.omega), n = Quad(0.25) * omega * omega;
    const Quad h = q.metric(e, e) / r2 - Quad(1), ev = q.metric(e, v) / r2,
               ew = omega * q.metric(e, j) / r2;
    const Quad value[5] = {n * (n * h + ew + q.metric(j, j) / r2),
                           Quad(2) * n * ev + omega * q.metric(v, j) / r2,
                           Quad(2) * n * h + ew + q.metric(v, v) / r2, Quad(2) * ev, h};
    const Vector f = s.start - w.centre, jv = right(s.velocity);
    const auto map = [&](Vector x) { return Vector{dot(w.first_axis, x), dot(w.second_axis, x)}; };
    const Quartic<double> rounded =
        ellipse_quartic(map(f), 1.0, map(s.velocity), map(jv), s.omega, 0.5);
    const QuarticError bound =
        quartic_error(s.scale, norm_1(f), w.centre_error,
                      std::max(norm_1(w.first_axis), norm_1(w.second_axis)), false);
    const char* names[] = {"quartic 0", "quartic 1", "quartic 2", "quartic 3", "quartic 4"};
    for (int i = 0; i < 5; ++i) r.add(names[i], value[i], rounded.q[i], bound.q[i]);
  });
}

Curve displaced(Curve curve, Vector by) {
  std::visit(
      [&](auto& c) {
        if constexpr (requires { c.centre; }) {
          c.centre = c.centre + by;
        } else {
          c.from = c.from + by;
          c.to = c.to + by;
        }
      },
      curve);
  return curve;
}

TEST(Bounds, PointsAndNormalsHaveTheirBounds) {
  Dice dice(6);
  Ratios r;
  constexpr int points = 25;
  for (long left = cases(50000, 30000000); left > 0; left -= points) {
    const double size = random_size(dice);
    const int kind = dice.whole(0, 2);
    Curve curve = kind == 0   ? random_segment(size, dice)
                  : kind == 1 ? random_circle(size, dice)
                              : random_ellipse(size, dice);
    // Now and then a small curve far from the origin.
    if (dice.whole(0, 3) == 0)
      curve = displaced(curve, (dice.spread(1.0, 1e6) * size) * dice.direction());
    const std::string name = kind == 0 ? "segment" : kind == 1 ? "circle" : "ellipse";
    const PreparedCurve w(curve);
    const QuadCurve q(curve);
    for (int i = 0; i < points; ++i) {
      const double at = std::fmin(std::fmax(first_parameter, dice.unit() * end_parameter(curve)),
                                  last_parameter(curve));
      const Vector x = w.point(at);
      r.add((name + " point").c_str(), largest(q.point(at) - quad(x)), w.point_error);
      // A hit lands beside the curve by the rounding of the flight.
      const double beside = dice.spread(1e-17, 1e-13) * w.extent;
      const PreparedCurve::Frame f = w.settle(x + beside * dice.direction());
      const double v = w.parameter(f.point);
      if (v == first_parameter || v == last_parameter(curve)) continue;
      const QuadVector exact = q.point(v);
      r.add((name + " settled point").c_str(), largest(exact - quad(f.point)), w.point_error);
      const QuadVector n = q.normal(exact), m = quad(f.normal);
      const Quad length = root(dot(m, m) / dot(n, n));
      r.add((name + " normal").c_str(), largest(length * n - m), w.normal_error * norm_1(f.normal));
    }
  }
  r.expect();
}

}  // namespace
}  // namespace carom::tests
