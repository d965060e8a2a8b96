// Larmor radii over eighteen decades: time and place of the next hit against 60 digits, where the
// flight is a circle with a centre and a radius and nothing of the engine's formulas is used.
#include <gtest/gtest.h>

#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <cstdio>

#include "events/recorder.hpp"
#include "random_tables.hpp"

namespace carom::tests {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<60>,
                                           boost::multiprecision::et_off>;
using RealVector = geometry::BasicVector<Real>;

RealVector real(Vector v) { return {Real(v.x), Real(v.y)}; }
RealVector left(const RealVector& v) { return {-v.y, v.x}; }
Real length(const RealVector& v) { return sqrt(dot(v, v)); }

/// A wall by its definition: ends, and for a conic centre and orientation.
struct Wall60 {
  bool bent = false, closed = false;
  RealVector from, to, centre;
  Real ratio = 1;  ///< of an ellipse: the semi-axis left of from - centre over that one
  Real turn = 1;   ///< counter-clockwise: 1

  explicit Wall60(const Curve& curve) {
    if (const auto* s = std::get_if<Segment>(&curve)) {
      from = real(s->from);
      to = real(s->to);
    } else if (const auto* a = std::get_if<CircularArc>(&curve)) {
      from = real(a->from);
      to = real(a->to);
      centre = Real(0.5) * (from + to) + Real(a->offset) * left(to - from);
      turn = a->counterclockwise ? 1 : -1;
      bent = true;
    } else if (const auto* c = std::get_if<Circle>(&curve)) {
      centre = real(c->centre);
      from = to = centre + RealVector{Real(c->radius), Real(0)};
      turn = c->counterclockwise ? 1 : -1;
      bent = closed = true;
    } else {
      const auto& e = std::get<Ellipse>(curve);
      centre = real(e.centre);
      from = to = centre + real(e.axis);
      ratio = Real(e.ratio);
      turn = e.counterclockwise ? 1 : -1;
      bent = closed = true;
    }
  }
  /// The ellipse pressed from a circle: the same in its plane.
  RealVector pressed(const RealVector& d) const {
    if (ratio == 1) return d;
    const RealVector a = from - centre, b = left(a);
    return (dot(a, d) / dot(a, a)) * a + (ratio * dot(b, d) / dot(a, a)) * b;
  }
  /// The rational parametrisation.
  RealVector point(double u) const {
    if (!bent) return from + Real(u) * (to - from);
    RealVector a = from - centre, b = turn * left(a);  // of the circle
    for (; u >= 1.0; u -= 1.0) {
      const RealVector next = -a;
      a = b;
      b = next;
    }
    const Real w = u, n = 1 + w * w;
    return centre + pressed(((1 - w * w) / n) * a + (2 * w / n) * b);
  }
  RealVector inward(const RealVector& x) const {
    RealVector n = bent ? turn * (centre - x) : left(to - from);
    if (ratio != 1) {
      const RealVector a = from - centre, b = left(a), d = turn * (centre - x);
      n = dot(a, d) * a + (dot(b, d) / (ratio * ratio)) * b;
    }
    return (Real(1) / length(n)) * n;
  }
  /// An ellipse's other points on the circle about c through `start`, which lies on both: where the
  /// squared distance from c changes from less to more than the start's, once the start is divided
  /// out. Two crossings between neighbours of the grid would be missed.
  std::vector<RealVector> crossings_of_ellipse(const RealVector& c, const RealVector& start) const {
    const RealVector a = from - centre, b = ratio * left(a);
    const Real begin =
        atan2(dot(b, start - centre) / dot(b, b), dot(a, start - centre) / dot(a, a));
    const Real square = dot(start - c, start - c), whole_turn = 8 * atan(Real(1));
    const auto at = [&](const Real& angle) { return centre + cos(angle) * a + sin(angle) * b; };
    const auto beyond = [&](const Real& way) {
      const RealVector e = at(begin + way) - c;
      return Real((dot(e, e) - square) / sin(way / 2));
    };
    constexpr int grid = 400;
    std::vector<RealVector> found;
    Real low = Real(1e-20), low_value = beyond(low);
    for (int i = 1; i <= grid; ++i) {
      const Real high = i == grid ? Real(whole_turn - Real(1e-20)) : Real(whole_turn * i / grid),
                 high_value = beyond(high);
      if ((low_value < 0) != (high_value < 0)) {
        Real x = low, y = high;
        for (int k = 0; k < 190; ++k) {
          const Real middle = (x + y) / 2;
          ((beyond(middle) < 0) == (low_value < 0) ? x : y) = middle;
        }
        found.push_back(at(begin + x));
      }
      low = high;
      low_value = high_value;
    }
    return found;
  }
  /// The points that it shares with a circle.
  std::vector<RealVector> crossings(const RealVector& c, const RealVector& start) const {
    if (ratio != 1) return crossings_of_ellipse(c, start);
    const Real radius = length(start - c);
    std::vector<RealVector> found;
    if (!bent) {
      const RealVector d = to - from, e = from - c;
      const Real a = dot(d, d), b = dot(e, d), root = b * b - a * (dot(e, e) - radius * radius);
      for (const int sign : {-1, 1}) {
        if (root < 0) continue;
        const Real s = (-b + sign * sqrt(root)) / a;
        if (s >= 0 && s < 1) found.push_back(from + s * d);
      }
      return found;
    }
    const RealVector d = centre - c, r = from - centre;
    const Real distance = length(d);
    const Real along = (radius * radius - dot(r, r) + dot(d, d)) / (2 * distance),
               square = radius * radius - along * along;
    for (const int sign : {-1, 1}) {
      if (square < 0) continue;
      const RealVector x = c + (along / distance) * d + (sign * sqrt(square) / distance) * left(d);
      if (closed || turn * cross(to - from, x - from) < 0) found.push_back(x);
    }
    return found;
  }
};

struct Hit60 {
  int wall = -1;
  Real time;
  RealVector place;
};

/// The first crossing of the boundary after the start, which is a crossing itself.
Hit60 first_hit(const std::vector<Wall60>& walls, const RealVector& x, const RealVector& v,
                const Real& omega) {
  const RealVector centre = x - (Real(1) / omega) * left(v), e = x - centre;
  const Real whole_turn = 8 * atan(Real(1));
  Hit60 first;
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (const RealVector& p : walls[i].crossings(centre, x)) {
      if (length(p - x) < Real(1e-25)) continue;                     // the start
      Real angle = atan2(cross(p - centre, e), dot(p - centre, e));  // clockwise
      if (omega < 0) angle = -angle;
      if (angle < 0) angle += whole_turn;
      const Real time = angle / abs(omega);
      if (first.wall < 0 || time < first.time) first = {static_cast<int>(i), time, p};
    }
  return first;
}

/// Errors in units of 2^-53, times the cosine of incidence: what a rounding of the place does to a
/// hit.
struct Errors {
  double same_wall = 0.0;   ///< of the time, relative
  double other_wall = 0.0;  ///< of the time, against the table's size (at speed 1)
  double place = 0.0;       ///< against the table's size
  int hits = 0;
};

void compare(const Table& table, double size, int decade, Dice& dice, Errors& errors) {
  std::vector<Wall60> walls;
  for (const Wall& wall : table.walls) walls.emplace_back(wall.curve);
  State s;
  s.wall = dice.whole(0, static_cast<int>(walls.size()) - 1);
  const Curve& curve = table.walls[static_cast<std::size_t>(s.wall)].curve;
  s.u = dice.between(0.05, 0.95) * geometry::end_parameter(curve);
  s.position = geometry::point_at(curve, s.u);
  const double angle = dice.between(0.15, 3.0),
               radius = std::pow(10.0, decade) * dice.between(1.0, 2.0);
  s.velocity = std::cos(angle) * geometry::tangent_at(curve, s.u) +
               std::sin(angle) * geometry::normal_at(curve, s.u);
  const double omega = dice.sign() / radius;
  World world(table);
  world.add(particle(omega), s);
  world.limit_hits(1);
  Recorder seen;
  world.run_until(1e300, seen);
  ASSERT_EQ(seen.hits.size(), 1u);
  const HitEvent& hit = seen.hits[0];

  const Wall60& on = walls[static_cast<std::size_t>(s.wall)];
  const Hit60 exact = first_hit(walls, on.point(s.u), real(s.velocity), Real(omega));
  ASSERT_EQ(hit.wall, exact.wall) << "radius " << radius;
  const Wall60& met = walls[static_cast<std::size_t>(hit.wall)];
  const double cosine = abs(dot(met.inward(exact.place), real(hit.before))).convert_to<double>();
  const double off =
      abs(Real(hit.time.high) + Real(hit.time.low) - exact.time).convert_to<double>() * cosine *
      0x1p53;
  if (exact.wall == s.wall)
    errors.same_wall = std::fmax(errors.same_wall, off / exact.time.convert_to<double>());
  else
    errors.other_wall = std::fmax(errors.other_wall, off / size);
  // The exact place is that of (wall, u).
  const double beside = length(met.point(hit.u) - exact.place).convert_to<double>();
  errors.place = std::fmax(errors.place, beside * cosine * 0x1p53 / size);
  ++errors.hits;
}

TEST(LarmorRadii, EighteenDecadesOfRadiiAgreeWithSixtyDigits) {
  struct Case {
    const char* name;
    Table table;
    double size, time, place;  // and twice the largest errors seen in 2000 flights a decade
  };
  const Case all[] = {
      {"segments", square(), 1.0, 8.0, 5.0},
      {"segments and arcs", stadium(), 2.0, 46.0, 30.0},
      {"circle", disc(1.0), 1.0, 14.0, 18.0},
      {"ellipse", loop({Ellipse{{0.1, -0.2}, {0.8, 0.6}, 0.7, true}}), 1.0, 16.0, 20.0}};
  std::printf("largest errors in units of 2^-53, times the cosine of incidence\n");
  for (const Case& one : all) {
    Dice dice(7);
    for (int decade = -6; decade <= 12; ++decade) {
      Errors errors;
      for (long i = cases(25, 2000); i > 0; --i) compare(one.table, one.size, decade, dice, errors);
      std::printf(
          "%-18s radius 1e%+03d: time %5.1f relative, same wall; %5.1f of the size, other; place "
          "%5.1f\n",
          one.name, decade, errors.same_wall, errors.other_wall, errors.place);
      EXPECT_GT(errors.hits, 0);
      EXPECT_LT(std::fmax(errors.same_wall, errors.other_wall), one.time);
      EXPECT_LT(errors.place, one.place);
    }
  }
}

}  // namespace
}  // namespace carom::tests
