// Curves against sixty digits.
#include "carom/geometry/curve.hpp"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <random>
#include <stdexcept>

#include "carom/geometry/curve_frame.hpp"
#include "exact_curve.hpp"
#include "rational.hpp"

namespace carom::geometry {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<60>,
                                           boost::multiprecision::et_off>;
using Point = BasicVector<Real>;

Real real(const mpq_class& q) { return Real(q.get_num().get_str()) / Real(q.get_den().get_str()); }
Real real(const Dyadic& d) { return real(d.rational()); }

/// The definition of curve.hpp, in sixty digits.
struct Reference {
  Point from, to, centre, a, b;
  bool segment = false;
  explicit Reference(const Curve& curve) {
    const ExactCurve c(curve);
    segment = c.segment;
    from = {real(c.from.x), real(c.from.y)};
    to = {real(c.to.x), real(c.to.y)};
    if (segment) return;
    centre = {real(c.centre.x), real(c.centre.y)};
    a = from - centre;
    const DyadicVector turned = c.metric.quarter(c.start);
    const Real scale = real(c.metric.scale) * c.orientation;
    b = {real(turned.x) / scale, real(turned.y) / scale};
  }
  Point at(const Real& u) const {
    if (segment) return from + u * (to - from);
    const Real n = floor(u), w = u - n;
    Point p = a, q = b;
    for (int i = 0; i < static_cast<int>(n); ++i) {
      const Point old = p;
      p = q;
      q = -old;
    }
    const Real weight = 1 + w * w;
    return centre + ((1 - w * w) / weight) * p + (2 * w / weight) * q;
  }
  Point derivative(const Real& u) const {
    const Real h("1e-18");
    const Point d = at(u + h) - at(u);
    const Point e = at(u + 2 * h) - at(u + h);
    return (1 / h) * (d + Real("-0.5") * (e - d));
  }
  Real length(const Real& u) const {
    const auto speed = [&](const Real& v) {
      const Point d = derivative(v);
      return sqrt(dot(d, d));
    };
    Real sum = 0;
    const Real top = u;
    for (Real v = 0; v < top; v += Real("0.125")) {
      const Real end = v + Real("0.125") < top ? v + Real("0.125") : top;
      sum += boost::math::quadrature::gauss<Real, 15>::integrate(speed, v, end);
    }
    return sum;
  }
};

double norm(Vector v) { return std::sqrt(dot(v, v)); }
double distance(const Point& p, Vector v) {
  const Point d = p - Point{Real(v.x), Real(v.y)};
  return static_cast<double>(Real(sqrt(dot(d, d))));
}

std::vector<Curve> family(double size, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> box(-size, size), ratio(0.2, 3.0), offset(-2.0, 2.0);
  const auto point = [&] { return Vector{box(random), box(random)}; };
  std::vector<Curve> curves;
  for (const bool turn : {true, false}) {
    curves.push_back(Segment{point(), point()});
    curves.push_back(Circle{point(), size * ratio(random), turn});
    curves.push_back(Ellipse{point(), point(), ratio(random), turn});
    curves.push_back(CircularArc{point(), point(), 0.0, turn});
    curves.push_back(EllipticArc{point(), point(), point(), ratio(random), 0.0, turn});
    for (int i = 0; i < 4; ++i) {
      curves.push_back(CircularArc{point(), point(), offset(random), turn});
      const Vector axis = point();  // the offset of an elliptic arc is counted in |axis|^-2
      curves.push_back(EllipticArc{point(), point(), axis, ratio(random),
                                   offset(random) / dot(axis, axis), turn});
    }
  }
  return curves;
}

class Curves : public testing::TestWithParam<double> {
 protected:
  std::vector<Curve> curves = family(GetParam(), 7);
  double size = GetParam();
  std::mt19937_64 random{11};
  double parameter(const Curve& c) {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random) * last_parameter(c);
  }
};

TEST_P(Curves, PointsAreTheRationalParametrisationRounded) {
  for (const Curve& c : curves) {
    const Reference exact(c);
    const CurveFrame f = frame_of(c);
    for (int i = 0; i < 50; ++i) {
      const double u = i == 0 ? first_parameter : i == 1 ? f.last : parameter(c);
      const Vector p = point_at(c, u);
      const Point q = exact.at(Real(u));
      constexpr double unit = 0x1p-53;
      // The bound beside conic_point, coordinate by coordinate.
      const double reach = f.kind == CurveFrame::Kind::segment ? 0.0 : 10.0;
      EXPECT_LE(
          static_cast<double>(abs(q.x - p.x)),
          unit * (std::fabs(p.x) * 1.001 + (2.0 + reach) * (std::fabs(f.a.x) + std::fabs(f.b.x))));
      EXPECT_LE(
          static_cast<double>(abs(q.y - p.y)),
          unit * (std::fabs(p.y) * 1.001 + (2.0 + reach) * (std::fabs(f.a.y) + std::fabs(f.b.y))));
    }
  }
}

TEST_P(Curves, EndsAreExact) {
  for (const Curve& c : curves) {
    const double last = last_parameter(c), end = end_parameter(c);
    EXPECT_EQ(end, std::nextafter(last, 8.0));
    if (is_closed(c)) {
      EXPECT_EQ(end, 4.0);
      continue;
    }
    // The exact point at `last` lies before `to` and the one at `end` does not: by the direction of
    // travel at `to`, in rational numbers.
    const ExactCurve e(c);
    const DyadicVector forward = e.tangent(e.end_point());
    const auto ahead = [&](double u) {
      const ExactPoint p = e.point(u);
      return dot(forward, DyadicVector{p.x - p.w * e.to.x, p.y - p.w * e.to.y}).sign();
    };
    EXPECT_LT(ahead(last), 0);
    EXPECT_GE(ahead(end), 0);
    EXPECT_EQ(point_at(c, 0.0), start_point(c));
    EXPECT_LE(norm(point_at(c, last) - end_point(c)), 1e-14 * size);
  }
}

TEST_P(Curves, ParameterOfPointReturns) {
  for (const Curve& c : curves) {
    const CurveFrame f = frame_of(c);
    for (int i = 0; i < 50; ++i) {
      const double u = parameter(c);
      const Vector p = point_at(c, u);
      const double back = parameter_of(c, p);
      EXPECT_GE(back, first_parameter);
      EXPECT_LE(back, f.last);
      // The point is rounded to 2^-53 of its distance from the origin of the plane.
      const double bound = 4e-15 * (1.0 + (norm(p) + f.major) / f.minor * (f.major / f.minor));
      EXPECT_NEAR(back, u, bound);
    }
    if (is_closed(c)) continue;
    const Vector t0 = tangent_at(c, first_parameter), t1 = tangent_at(c, f.last);
    EXPECT_EQ(parameter_of(c, start_point(c) - (1e-6 * size) * t0), first_parameter);
    EXPECT_EQ(parameter_of(c, end_point(c) + (1e-6 * size) * t1), f.last);
  }
}

TEST_P(Curves, TangentIsTheDerivative) {
  for (const Curve& c : curves) {
    const Reference exact(c);
    for (int i = 0; i < 20; ++i) {
      const double u = parameter(c);
      const Point d = exact.derivative(Real(u));
      const Real n = sqrt(dot(d, d));
      EXPECT_LE(distance((1 / n) * d, tangent_at(c, u)), 1e-14);
      const Vector t = tangent_at(c, u), inward = normal_at(c, u);
      EXPECT_EQ(inward, left(t));
    }
  }
}

TEST_P(Curves, CurvatureTurnsTheTangent) {
  for (const Curve& c : curves) {
    const Reference exact(c);
    for (int i = 0; i < 20; ++i) {
      const double u = 0.01 + 0.98 * parameter(c);
      if (exact.segment) {
        EXPECT_EQ(curvature_at(c, u), 0.0);
        continue;
      }
      const Real h("1e-12");
      const Point before = exact.derivative(Real(u) - h), after = exact.derivative(Real(u) + h),
                  here = exact.derivative(Real(u));
      const Real turned = cross(before, after) / (2 * h);
      const Real cube = dot(here, here) * sqrt(dot(here, here));
      const double expected = static_cast<double>(Real(turned / cube));
      EXPECT_NEAR(curvature_at(c, u), expected, 1e-10 * std::fabs(expected));
    }
  }
}

TEST_P(Curves, LengthIsTheIntegral) {
  for (const Curve& c : curves) {
    const Reference exact(c);
    const double total = length(c);
    const CurveFrame f = frame_of(c);
    for (int i = 0; i < 3; ++i) {
      const double u = i == 0 ? f.end : parameter(c);
      const double expected = static_cast<double>(exact.length(Real(u)));
      EXPECT_NEAR(arc_length_at(c, u), expected, 1e-15 * (total + 4.0 * f.major));
    }
  }
}

TEST_P(Curves, LengthAndParameterReturn) {
  for (const Curve& c : curves) {
    const CurveFrame f = frame_of(c);
    const double total = length(f);
    EXPECT_EQ(parameter_at_length(f, 0.0), 0.0);
    EXPECT_EQ(parameter_at_length(f, total), f.end);
    EXPECT_EQ(parameter_at_length(f, 2.0 * total), f.end);
    double previous = 0.0;
    for (int i = 1; i < 60; ++i) {
      const double s = total * i / 60.0;
      const double u = parameter_at_length(f, s);
      EXPECT_GT(u, previous);
      previous = u;
      EXPECT_NEAR(arc_length_at(f, u), s, 1.5e-15 * (total + f.major)) << i;
    }
    for (int i = 0; i < 30; ++i) {
      const double u = parameter(c);
      EXPECT_NEAR(parameter_at_length(f, arc_length_at(f, u)), u, 1e-14 * f.major / f.minor);
    }
  }
}

TEST_P(Curves, ReversedIsTheSamePointSet) {
  for (const Curve& c : curves) {
    const Curve r = reversed(c);
    EXPECT_EQ(start_point(r), end_point(c));
    EXPECT_EQ(end_point(r), start_point(c));
    EXPECT_NEAR(length(r), length(c), 1e-14 * length(c));
    EXPECT_NEAR(area_integral(r), -area_integral(c),
                1e-13 * (size * size + std::fabs(area_integral(c))));
    for (int i = 0; i < 20; ++i) {
      const double u = parameter(c);
      const Vector p = point_at(c, u);
      const double back = parameter_of(r, p);
      EXPECT_LE(norm(point_at(r, back) - p), 1e-14 * (size + frame_of(c).major));
      EXPECT_NEAR(arc_length_at(r, back), length(c) - arc_length_at(c, u),
                  1e-13 * (size + length(c)));
    }
  }
}

TEST_P(Curves, BoxesContainTheCurveTightly) {
  for (const Curve& c : curves) {
    const Box box = bounding_box(c);
    const Reference exact(c);
    Vector low = start_point(c), high = low;
    const double end = last_parameter(c);
    for (int i = 0; i <= 4000; ++i) {
      const double u = end * i / 4000.0;
      const Point p = exact.at(Real(u));
      const Real digits = size * Real("1e-50");  // of the reference itself
      ASSERT_TRUE(p.x >= box.low.x - digits && p.x <= box.high.x + digits &&
                  p.y >= box.low.y - digits && p.y <= box.high.y + digits)
          << "kind " << c.index() << " u = " << u << ": " << p.x - box.low.x << " "
          << box.high.x - p.x << " " << p.y - box.low.y << " " << box.high.y - p.y;
      const Vector q{static_cast<double>(p.x), static_cast<double>(p.y)};
      low = {std::fmin(low.x, q.x), std::fmin(low.y, q.y)};
      high = {std::fmax(high.x, q.x), std::fmax(high.y, q.y)};
    }
    const double tight = 1e-5 * (norm(high - low) + 0.0);
    EXPECT_NEAR(box.low.x, low.x, tight);
    EXPECT_NEAR(box.low.y, low.y, tight);
    EXPECT_NEAR(box.high.x, high.x, tight);
    EXPECT_NEAR(box.high.y, high.y, tight);
  }
}

TEST_P(Curves, AreaIsTheIntegralAlongTheCurve) {
  for (const Curve& c : curves) {
    const Reference exact(c);
    const double end = end_parameter(c);
    const auto form = [&](const Real& u) {
      const Point p = exact.at(u), d = exact.derivative(u);
      return cross(p, d) / 2;
    };
    Real sum = 0;
    for (double u = 0.0; u < end; u += 0.25) {
      const Real top(std::fmin(u + 0.25, end));
      sum += boost::math::quadrature::gauss<Real, 30>::integrate(form, Real(u), top);
    }
    const CurveFrame f = frame_of(c);
    const double scale = size * size + f.major * f.major;
    EXPECT_NEAR(area_integral(c) / scale, static_cast<double>(Real(sum / scale)), 1e-14);
  }
}

TEST_P(Curves, ArcsLeadThroughThreePoints) {
  std::uniform_real_distribution<double> box(-size, size), ratio(0.2, 3.0);
  const auto point = [&] { return Vector{box(random), box(random)}; };
  for (int i = 0; i < 200; ++i) {
    const Vector a = point(), b = point(), c = point();
    const CircularArc arc = arc_through(a, b, c);
    const EllipticArc elliptic = elliptic_arc_through(a, b, c, point(), ratio(random));
    for (const Curve& curve : {Curve(arc), Curve(elliptic)}) {
      const CurveFrame f = frame_of(curve);
      const double u = parameter_of(curve, b);
      EXPECT_GT(u, 10 * first_parameter);  // strictly between the ends
      EXPECT_LT(u, f.last);
      EXPECT_LE(norm(point_at(curve, u) - b), 1e-14 * (size + f.major * f.major / f.minor));
    }
    const CircularArc about = arc_about(a, c, centre(arc), arc.counterclockwise);
    EXPECT_NEAR(about.offset, arc.offset, 1e-13 * (1.0 + std::fabs(arc.offset)));
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Curves, testing::Values(1e-6, 1.0, 1e6));

TEST(Curve, FlatArcsKeepTheirDigits) {
  // Radius 1e9, chord 1: the centre is known to 1e-7 only, the arc to the last digit.
  const Curve flat = CircularArc{{0.0, 0.0}, {1.0, 0.0}, 1e9, true};
  const Reference exact(flat);
  const double end = end_parameter(flat);
  for (int i = 1; i < 10; ++i) {
    const double u = end * i / 10.0;
    EXPECT_LE(distance(exact.at(Real(u)), point_at(flat, u)), 1e-15);
    EXPECT_NEAR(parameter_of(flat, point_at(flat, u)), u, 1e-15 * end);
    EXPECT_NEAR(parameter_at_length(flat, arc_length_at(flat, u)), u, 1e-15 * end);
  }
  EXPECT_NEAR(length(flat), 1.0, 1e-15);
  EXPECT_NEAR(area_integral(flat) * 1.2e10, 1.0, 1e-9);  // chord^3/(12 r)
  const Box box = bounding_box(flat);
  EXPECT_NEAR(box.low.y, -1.25e-10, 1e-18);  // chord^2/(8 r)
}

TEST(Curve, FlatEllipticArcsKeepTheirDigits) {
  // Counter-clockwise with the centre on the left of the chord: the short way round.
  const Curve arc = EllipticArc{{0.0, 0.0}, {1.0, 0.0}, {0.6, 0.8}, 0.25, 1e9, true};
  const Reference reference(arc);
  for (int i = 1; i <= 10; ++i) {
    const double u = end_parameter(arc) * i / 10.0;
    EXPECT_NEAR(arc_length_at(arc, u), static_cast<double>(reference.length(Real(u))), 4e-16);
    EXPECT_NEAR(parameter_at_length(arc, arc_length_at(arc, u)), u, 1e-15 * end_parameter(arc));
  }
  EXPECT_NEAR(length(arc), 1.0, 1e-15);
}

TEST(Curve, HalfTurnsAreHalfTurns) {
  const Curve half = CircularArc{{1.0, 0.0}, {-1.0, 0.0}, 0.0, true};
  EXPECT_EQ(end_parameter(half), 2.0);
  EXPECT_EQ(length(half), std::acos(-1.0));
  EXPECT_EQ(curvature_at(half, 0.5), 1.0);
  EXPECT_EQ(curvature_at(reversed(half), 0.5), -1.0);
  EXPECT_EQ(point_at(half, 1.0), (Vector{0.0, 1.0}));
  EXPECT_EQ(point_at(reversed(half), 1.0), (Vector{0.0, 1.0}));
  const Curve quarter = arc_about({1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}, true);
  EXPECT_EQ(end_parameter(quarter), 1.0);
  const Curve three_quarters = arc_about({0.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}, true);
  EXPECT_EQ(end_parameter(three_quarters), 3.0);
}

TEST(Curve, EllipsesHaveKnownLengths) {
  const Curve e = Ellipse{{0.0, 0.0}, {1.0, 0.0}, 0.75, true};
  EXPECT_NEAR(length(e), 5.525873040177376, 2e-15);  // 4 E(7/16), sixty digits rounded
  EXPECT_NEAR(area_integral(e), 0.75 * std::acos(-1.0), 1e-15);
  EXPECT_NEAR(arc_length_at(e, 2.0), 0.5 * length(e), 1e-15);
  EXPECT_NEAR(curvature_at(e, 0.0), 1.0 / 0.5625, 1e-15);
  EXPECT_NEAR(curvature_at(e, 1.0), 0.75, 1e-15);
  const Curve round = Ellipse{{0.0, 0.0}, {2.0, 0.0}, 1.0, false};
  EXPECT_NEAR(length(round), 4.0 * std::acos(-1.0), 4e-15);
}

TEST(Curve, ThinEllipsesHaveTheirLengths) {
  for (const double ratio : {0.01, 0.1, 10.0, 100.0}) {
    const Curve thin = Ellipse{{0.5, 0.25}, {0.6, 0.8}, ratio, true};
    const Reference exact(thin);
    const CurveFrame f = frame_of(thin);
    const double total = length(f), seam = 0x1p-5 * f.minor / f.major;
    // Both sides of the seam between the short rule and the elliptic integral, and some others.
    for (const double u :
         {0.5 * seam, std::nextafter(seam, 0.0), seam, 1.5 * seam, 0.3, 1.0, 2.7, 3.99}) {
      const auto speed = [&](const Real& v) {
        const Point d = exact.derivative(v);
        return sqrt(dot(d, d));
      };
      Real sum = 0;  // short panels, as the speed changes quickly, and none across a quarter's end
      for (int quarter = 0; quarter < u; ++quarter) {
        const Real step = (Real(std::fmin(u, quarter + 1.0)) - quarter) / 32;
        for (int i = 0; i < 32; ++i)
          sum += boost::math::quadrature::gauss<Real, 30>::integrate(speed, quarter + i * step,
                                                                     quarter + (i + 1) * step);
      }
      EXPECT_NEAR(arc_length_at(f, u), static_cast<double>(sum), 1e-15 * total)
          << ratio << " " << u;
      EXPECT_NEAR(parameter_at_length(f, arc_length_at(f, u)), u, 1e-15 * f.major / f.minor)
          << ratio << " " << u;
    }
  }
}

TEST(Curve, QuartersOfEllipsesEndAtTheirLengths) {
  // Starts near the ends of the axes, so that rounding may show either quarter of the ellipse.
  for (int i = -20; i <= 20; ++i)
    for (const double angle : {0.0, 0.5, 1.0, 1.5}) {
      const Curve whole = Ellipse{{0.1, 0.2}, {1.3, 0.7}, 0.3, true};
      const double at = 2.0 * angle;
      const CurveFrame f = frame_of(whole);
      const Vector from = point_at(f, at) + Vector{i * 0x1p-54, -i * 0x1p-54};
      const Vector opposite = Vector{0.2, 0.4} - from;
      const Curve half = EllipticArc{from, opposite, {1.3, 0.7}, 0.3, 0.0, i % 2 == 0};
      const CurveFrame g = frame_of(half);
      EXPECT_NEAR(length(g), 0.5 * length(f), 5e-14) << i << " " << angle;
      for (const double u : {1.0 - 0x1p-53, 1.0, 1.0 + 0x1p-52, 2.0 - 0x1p-52})
        EXPECT_NEAR(arc_length_at(g, u), (u < 1.5 ? 0.25 : 0.5) * length(f), 5e-14)
            << i << " " << angle;
    }
}

TEST(Curve, RefusesWhatHasNoExtent) {
  EXPECT_THROW(arc_through({0, 0}, {1, 1}, {2, 2}), std::invalid_argument);
  EXPECT_THROW(arc_through({0, 0}, {1, 1}, {0, 0}), std::invalid_argument);
  EXPECT_THROW(arc_about({0, 0}, {0, 0}, {1, 1}, true), std::invalid_argument);
  EXPECT_THROW(elliptic_arc_through({0, 0}, {1, 1}, {2, 0}, {0, 0}, 1.0), std::invalid_argument);
  EXPECT_THROW(elliptic_arc_through({0, 0}, {1, 1}, {2, 0}, {1, 0}, -1.0), std::invalid_argument);
  EXPECT_THROW(frame_of(Segment{{1, 1}, {1, 1}}), std::invalid_argument);
  EXPECT_THROW(frame_of(Circle{{1, 1}, 0.0, true}), std::invalid_argument);
  EXPECT_THROW(frame_of(Ellipse{{1, 1}, {0, 0}, 1.0, true}), std::invalid_argument);
  EXPECT_THROW(frame_of(CircularArc{{1, 1}, {1, 1}, 1.0, true}), std::invalid_argument);
}

TEST(Rational, RoundsToTheNearestDouble) {
  EXPECT_EQ(nearest(mpq_class(1, 3)), 1.0 / 3.0);
  EXPECT_EQ(nearest(mpq_class(2, 3)), 2.0 / 3.0);
  EXPECT_EQ(nearest(mpq_class(-2, 3)), -2.0 / 3.0);
  const mpq_class half(mpz_class(1), mpz_class(1) << 53);
  EXPECT_EQ(nearest(1 + half), 1.0);  // a tie: the even neighbour
  EXPECT_EQ(nearest(1 + 3 * half), 1.0 + 0x1p-51);
  EXPECT_EQ(largest_below(mpq_class(1)), 1.0 - 0x1p-53);
  EXPECT_EQ(largest_below(mpq_class(1, 3)), 0x1.5555555555555p-2);
}

}  // namespace
}  // namespace carom::geometry
