// Straight flights and Larmor circles against Bézier curves: the filter, the exact stage, CGAL's
// algebraic kernel, and roots found by signs in 500 digits, which share nothing with each other.
#include <gtest/gtest.h>

#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <random>
#include <set>

#include "carom/geometry/bezier_flight.hpp"
#include "carom/geometry/exact_flight.hpp"
#include "carom/geometry/region.hpp"
#include "geometry/bezier_oracle.hpp"
#include "random_tables.hpp"

namespace carom::geometry {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<500>,
                                           boost::multiprecision::et_off>;

struct Dice {
  std::mt19937_64 random;
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random); }
  int whole(int a, int b) { return std::uniform_int_distribution<int>(a, b)(random); }
  bool coin() { return whole(0, 1) == 0; }
  Vector point(double size) { return {size * (2.0 * unit() - 1.0), size * (2.0 * unit() - 1.0)}; }
};

Bezier random_curve(Dice& dice, double size) {
  for (;;) {
    Bezier b{dice.point(size), dice.point(size), {}, dice.whole(2, 5)};
    for (int i = 1; i < b.degree; ++i)
      b.inner[static_cast<std::size_t>(i - 1)] =
          dice.whole(0, 3) == 0 ? b.from + 0.3 * dice.point(size) : dice.point(size);
    // Some rest at an end.
    if (dice.whole(0, 4) == 0) b.inner[0] = b.from;
    if (dice.whole(0, 4) == 0) b.inner[static_cast<std::size_t>(b.degree - 2)] = b.to;
    try {
      frame_of(b);
      return b;
    } catch (const std::invalid_argument&) {
    }
  }
}

/// The point at u by the definition.
BasicVector<Real> definition(const Bezier& b, const Real& u) {
  BasicVector<Real> sum{0, 0};
  Real binomial = 1;
  for (int i = 0; i <= b.degree; ++i) {
    const Real weight = binomial * pow(u, i) * pow(1 - u, b.degree - i);
    sum = sum + weight * BasicVector<Real>{b.control(i).x, b.control(i).y};
    binomial = binomial * (b.degree - i) / (i + 1);
  }
  return sum;
}

struct Flight {
  Vector start, v;
  double on = -1.0, omega = 0.0;
};

/// Adversarial: along tangents, by a hair beside them, at ends, from places on the curve.
Flight random_flight(Dice& dice, const CurveFrame& f, double size, bool field) {
  Flight flight{dice.point(1.5 * size), dice.point(1.0)};
  const double h =  // half of omega
      field ? std::ldexp(dice.coin() ? 1.0 : -1.0, dice.whole(-7, 5)) / size : 0.0;
  flight.omega = 2.0 * h;
  const double kappa = field ? h * (2.0 * dice.unit() - 1.0) / dice.unit() : 1.0;
  // The velocity of a flight over that way.
  const auto over = [&](Vector d) { return kappa * d + h * left(d); };
  const int kind = dice.whole(0, 5);
  if (dice.whole(0, 2) == 0) {
    flight.on = dice.whole(0, 9) == 0 ? std::ldexp(1.0, -dice.whole(1, 50)) : dice.unit();
    if (dice.whole(0, 9) == 0) flight.on = 1.0 - 0.5 * flight.on;
    flight.start = point_at(f, flight.on);
  }
  const double at = dice.unit();
  if (kind == 0) flight.v = over(point_at(f, at) - flight.start);
  if (kind == 1) flight.v = over(point_at(f, dice.coin() ? 0.0 : 1.0) - flight.start);
  if (kind == 2) {  // nearly along a tangent
    const double off = std::ldexp(dice.unit(), -dice.whole(0, 60));
    const Vector t = tangent_at(f, at);
    if (flight.on >= 0.0) {
      flight.v = tangent_at(f, flight.on) + off * left(tangent_at(f, flight.on));
    } else if (field) {
      const Vector to = point_at(f, at) + (off * size) * left(t);
      flight.start = to + displacement(kappa, -t, -flight.omega, 0.5);
      flight.v = over(to - flight.start);
    } else {
      flight.start = point_at(f, at) - (2.0 * size * dice.unit()) * t + (off * size) * left(t);
      flight.v = t;
    }
  }
  if (flight.on >= 0.0 && cross(direction_at(f, flight.on), flight.v) < 0.0) flight.v = -flight.v;
  return flight;
}

/// The first of the roots of g, v x (x(u) - start) or the side of a Larmor circle, at which the
/// flight leaves, by bisection.
struct Reference {
  bool found = false;
  double u = 0.0;
};
Reference reference(const Bezier& b, const Flight& f) {
  const BasicVector<Real> start =
      f.on < 0.0 ? BasicVector<Real>{f.start.x, f.start.y} : definition(b, f.on);
  const BasicVector<Real> v{f.v.x, f.v.y};
  const Real omega(f.omega);
  // Standing on the curve g / (u - on), which rises where g does after the start, falls before it.
  const auto g = [&](const Real& u) {
    const BasicVector<Real> d = definition(b, u) - start;
    const Real value = 2 * cross(v, d) + omega * dot(d, d);
    return f.on < 0.0 ? value : Real(value / (u - Real(f.on)));
  };
  const Real h("1e-150");
  const auto slope = [&](const Real& u) { return Real(g(u + h) - g(u - h)); };
  const auto bend = [&](const Real& u) { return Real(g(u + h) - 2 * g(u) + g(u - h)); };
  const auto root = [](const auto& function, Real low, Real high) {
    const bool rises = function(low) < 0;
    for (int i = 0; i < 300; ++i) {
      const Real middle = (low + high) / 2;
      ((function(middle) < 0) == rises ? low : high) = middle;
    }
    return low;
  };
  // Between the places where g turns it is monotone, so that no pair of roots is missed; slopes may
  // vanish twice where the curve bends to the other side, beside a flight along its tangent there.
  std::vector<Real> cells{0}, nodes{0};
  constexpr int mesh = 50;
  for (int k = 0; k < mesh; ++k) {
    // On no simple fraction, where curves with few bits turn or stand.
    const Real from = (Real(k) + Real("0.0012345")) / mesh,
               to = (Real(k + 1) + Real("0.0012345")) / mesh;
    cells.push_back(from);
    if (bend(from) * bend(to) < 0) cells.push_back(root(bend, from, to));
  }
  cells.push_back(1);
  for (std::size_t k = 1; k < cells.size(); ++k) {
    if (slope(cells[k - 1]) * slope(cells[k]) < 0)
      nodes.push_back(root(slope, cells[k - 1], cells[k]));
    nodes.push_back(cells[k]);
  }
  Reference first;
  Real nearest = 0;
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const Real before = g(nodes[k - 1]), value = g(nodes[k]);
    if (before * value < 0) {
      const bool rises = before < 0;
      const Real low = root(g, nodes[k - 1], nodes[k]);
      const BasicVector<Real> d = definition(b, low) - start;
      const Real kappa = dot(v, d) / dot(d, d);
      const bool leaves = rises == (f.on < 0.0 || low > Real(f.on));
      if (leaves && (kappa > 0 || f.omega != 0.0) && (!first.found || kappa > nearest)) {
        first = {true, static_cast<double>(low)};
        nearest = kappa;
      }
    }
  }
  return first;
}

struct Tally {
  long cases = 0, decided = 0, exits = 0;
};

Tally compare(unsigned seed, int curves, int flights, double size, bool field,
              bool with_reference) {
  Dice dice{std::mt19937_64(seed)};
  Tally tally;
  for (int i = 0; i < curves; ++i) {
    const Bezier curve = random_curve(dice, size);
    const PreparedCurve prepared{Curve(curve)};
    const CurveFrame& frame = prepared.parametrisation;
    const ExactBoundary boundary({{curve, {}, -1, false}}, {}, {});
    for (int k = 0; k < flights; ++k) {
      const Flight f = random_flight(dice, frame, size, field);
      if (f.on >= 0.0 && boundary.inward(0, f.on, f.v) != Sign::positive) continue;
      const double delta = f.on < 0.0 ? 0.0 : prepared.point_error;
      const FlightScale scale{delta, std::fabs(f.v.x) + std::fabs(f.v.y), std::fabs(f.omega), 1.0};
      const ExactFlight exact(boundary, f.on < 0.0 ? -1 : 0, f.on, f.start, f.v, f.omega);
      const auto beside = [&](Vector joint) {
        const Vector d = joint - f.start;
        return std::fabs(side_of_flight(f.v, d, f.omega)) >
               side_error(scale, std::fabs(d.x) + std::fabs(d.y));
      };
      if (f.on < 0.0 && !(beside(curve.from) && beside(curve.to)))
        continue;  // the driver asks for joints first
      ++tally.cases;
      const CurveExit exit = field ? first_exit(*frame.bezier, f.start, f.v, f.omega, scale, f.on)
                                   : first_exit(*frame.bezier, f.start, f.v, scale, f.on);
      const ExactFlight::First first = exact.first({0}, {}, -1, f.on < 0.0 ? -1 : 0, -1);
      const bool leaves = first.kind == ExactFlight::First::Kind::exit;
      if (exit.leaves != Sign::undecided) {
        ++tally.decided;
        EXPECT_EQ(exit.leaves == Sign::positive, leaves) << seed << " " << i << " " << k;
        if (leaves) {
          ++tally.exits;
          EXPECT_NEAR(exit.u, first.u, 1e-6) << seed << " " << i << " " << k;
          const double place = field ? first.kappa : dot(f.v, f.v) / first.kappa;
          EXPECT_LE(std::fabs(exit.place - place), exit.error + 1e-15 * std::fabs(place))
              << seed << " " << i << " " << k;
        }
      }
      if (!with_reference) continue;
      const Reference other = reference(curve, f);
      EXPECT_EQ(other.found, leaves) << seed << " " << i << " " << k;
      if (other.found && leaves) {
        EXPECT_NEAR(other.u, first.u, 1e-12) << seed << " " << i << " " << k;
      }
    }
  }
  return tally;
}

TEST(BezierFlights, FilterAndExactStageAgree) {
  for (const bool field : {false, true})
    for (const double size : {1.0, 1e-6, 1e6}) {
      const Tally t = compare(3, static_cast<int>(tests::cases(16, 3000)), field ? 20 : 100, size,
                              field, false);
      std::printf("size %g, field %d: %ld flights, %ld decided, %ld exits\n", size, field, t.cases,
                  t.decided, t.exits);
      EXPECT_GT(t.exits, t.cases / 10);
      EXPECT_GT(t.decided, t.cases * 3 / 4);  // of adversarial flights
    }
}

TEST(BezierFlights, ExactStageAndCgalAgree) {
  Dice dice{std::mt19937_64(5)};
  int exits = 0;
  for (long i = 0; i < tests::cases(40, 20000); ++i) {
    const Bezier curve = random_curve(dice, 1.0);
    const CurveFrame frame = frame_of(curve);
    const ExactBoundary boundary({{curve, {}, -1, false}}, {}, {});
    for (int k = 0; k < 6; ++k) {
      const Flight f = random_flight(dice, frame, 1.0, k % 2 == 1);
      if (f.on >= 0.0 && boundary.inward(0, f.on, f.v) != Sign::positive) continue;
      if (f.on < 0.0 && (side_of_flight(f.v, curve.from - f.start, f.omega) == 0.0 ||
                         side_of_flight(f.v, curve.to - f.start, f.omega) == 0.0))
        continue;  // at a joint, to rounding: there is no other wall here
      const ExactFlight exact(boundary, f.on < 0.0 ? -1 : 0, f.on, f.start, f.v, f.omega);
      const ExactFlight::First first = exact.first({0}, {}, -1, f.on < 0.0 ? -1 : 0, -1);
      const bool leaves = first.kind == ExactFlight::First::Kind::exit;
      const std::optional<double> other =
          tests::first_exit_by_kernel(curve, f.start, f.v, f.omega, f.on);
      EXPECT_EQ(other.has_value(), leaves) << i << " " << k;
      if (!other || !leaves) continue;
      ++exits;
      EXPECT_NEAR(*other, first.u, 1e-12) << i << " " << k;
    }
  }
  EXPECT_GT(exits, 30);
}

TEST(BezierFlights, CurvesThatRestAtAnEndAreKnownThere) {
  // x = u^2 (3, 0) + u^3 (-1, 1) on one side, the same to its end on the other.
  const Bezier curve{{0, 0}, {2, 1}, {{{0, 0}, {1, 0}}}, 3};
  const CurveFrame from = frame_of(curve), to = frame_of(std::get<Bezier>(reversed(curve)));
  EXPECT_TRUE(from.bezier->rests_at_start && to.bezier->rests_at_end);
  for (const double u : {1.0, 0.5, 0x1p-10, 0x1p-40, 0x1p-52}) {
    // The slope u/(2 - u); y''x' - x''y' = 18 u^2, |x'| = 3 u |(2 - u, u)|.
    const Vector t{2.0 - u, u};
    const double size = std::sqrt(dot(t, t));
    const Vector unit = (1.0 / size) * t;
    EXPECT_LT(std::fabs(cross(unit, tangent_at(from, u))), 4e-16) << u;
    EXPECT_LT(std::fabs(cross(unit, tangent_at(to, 1.0 - u))), 4e-16) << u;
    EXPECT_GT(dot(unit, tangent_at(from, u)), 0.9);
    EXPECT_LT(dot(unit, tangent_at(to, 1.0 - u)), -0.9);
    const double curvature = 2.0 / (3.0 * u * size * size * size);
    EXPECT_NEAR(curvature_at(from, u), curvature, 1e-14 * curvature) << u;
    EXPECT_NEAR(curvature_at(to, 1.0 - u), -curvature, 1e-14 * curvature) << u;
  }
  EXPECT_NEAR(parameter_at_length(from, arc_length_at(from, 0x1p-20)), 0x1p-20, 0x1p-50);
  // Both inner points on one end: no direction is left there.
  EXPECT_THROW(frame_of(Bezier{{0, 0}, {2, 1}, {{{0, 0}, {0, 0}}}, 3}), std::invalid_argument);
}

TEST(BezierFlights, BothAgreeWithBisectionInFiveHundredDigits) {
  for (const bool field : {false, true}) {
    const int curves = static_cast<int>(tests::cases(5, 100));
    const Tally t = compare(4, curves, field ? 12 : 25, 1.0, field, true);
    EXPECT_GT(t.exits, (field ? 1.25 : 2.5) * curves);
  }
}

}  // namespace
}  // namespace carom::geometry
