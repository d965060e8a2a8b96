// Billiards in Bézier curves, with and without field: stages, statistics, reversal, and the circle
// written as a curve.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "carom/base/error.hpp"
#include "carom/table/make.hpp"
#include "events/flight/next_hit.hpp"
#include "events/recorder.hpp"
#include "random_tables.hpp"

namespace carom::tests {

using namespace events;

namespace {

ExactPoint at(double x, double y) { return {ExactNumber(x), ExactNumber(y)}; }

Table polar(const char* radius) {
  TableSpec spec;
  spec.shape = "polar";
  spec.formulas["radius"] = {radius, {}};
  return build_table(spec);
}
Table parametric(const char* x, const char* y) {
  TableSpec spec;
  spec.shape = "parametric";
  spec.formulas["x"] = {x, {}};
  spec.formulas["y"] = {y, {}};
  return build_table(spec);
}
TableSpec implicit_spec(const char* equation, ExactPoint inside = at(0, 0)) {
  TableSpec spec;
  spec.shape = "implicit";
  spec.formulas["equation"] = {equation, {}};
  spec.points["inside"] = {inside};
  return spec;
}
Table spline(std::vector<ExactPoint> points) {
  TableSpec spec;
  spec.shape = "spline";
  spec.points["points"] = std::move(points);
  return build_table(spec);
}
PieceSpec bezier(std::vector<ExactPoint> points) {
  PieceSpec piece;
  piece.kind = PieceSpec::Kind::bezier;
  piece.to = points.back();
  points.pop_back();
  piece.control = std::move(points);
  return piece;
}
PieceSpec line(ExactPoint to) {
  PieceSpec piece;
  piece.to = to;
  return piece;
}
TableSpec path_spec(ExactPoint from, std::vector<PieceSpec> pieces) {
  TableSpec spec;
  spec.shape = "path";
  spec.loops.push_back({from, std::move(pieces), {}});
  return spec;
}

/// A box with one wall of degree 5 that bends both ways, and a circle in it.
Table wavy_box() {
  TableSpec spec = path_spec(
      at(0, 0), {line(at(4, 0)), bezier({at(6, 1), at(2, 1.5), at(6.5, 2), at(3, 2.5), at(4, 3)}),
                 bezier({at(3, 3.5), at(1, 2), at(0, 3)}), line(at(0, 0))});
  spec.obstacles.push_back(disc(at(1.5, 1.25), ExactNumber(0.5)));
  return build_table(spec);
}

std::vector<std::pair<const char*, Table>> tables() {
  std::vector<std::pair<const char*, Table>> all;
  all.emplace_back("cardioid", build_table(*carom::cardioid(1).spec));
  all.emplace_back("limacon", polar("1 + 0.5*cos(phi)"));
  all.emplace_back("Robnik's", parametric("cos(t) + 0.3*cos(2*t)", "sin(t) + 0.3*sin(2*t)"));
  all.emplace_back("flower", polar("1 + 0.2*sin(5*phi)"));
  all.emplace_back("superellipse", polar("(cos(phi)^4 + sin(phi)^4)^(-1/4)"));
  all.emplace_back("implicit", build_table(implicit_spec("exp(x)+exp(y)+exp(-x-y)-5")));
  all.emplace_back("spline",
                   spline({at(0, 0), at(3, -1), at(4, 1), at(2, 2), at(1, 4), at(-1, 2)}));
  all.emplace_back("wavy box", wavy_box());
  return all;
}

struct Lengths : Observer {
  double sum = 0.0, squares = 0.0, speed = 0.0;
  std::uint64_t hits = 0;
  void hit(const HitEvent& e) override {
    ++hits;
    sum += e.flight_time;
    squares += e.flight_time * e.flight_time;
    speed = std::max(speed, std::fabs(std::sqrt(dot(e.after, e.after)) - 1.0));
  }
};

/// `omega`: so small that no Larmor circle fits into the table.
void expect_mean_flight_of_area(double omega) {
  for (const auto& [name, table] : tables()) {
    World world(table);
    Lengths seen;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    // Starts by the invariant measure: uniform in the wall's length and the sine of the angle.
    std::vector<double> ends{0.0};
    for (const Wall& wall : table.walls) ends.push_back(ends.back() + geometry::length(wall.curve));
    constexpr int orbits = 3000;
    for (int i = 0; i < orbits; ++i) {
      const double s = unit(random) * ends.back();
      const auto next = std::upper_bound(ends.begin(), ends.end() - 1, s);
      const int wall = static_cast<int>(next - ends.begin()) - 1;
      State state;
      state.wall = wall;
      state.u = geometry::parameter_at_length(table.wall(wall).curve, s - *(next - 1));
      state.position = geometry::point_at(table.wall(wall).curve, state.u);
      const Vector n = geometry::normal_at(table.wall(wall).curve, state.u);
      const double sine = 2.0 * unit(random) - 1.0;
      const Vector v = std::sqrt(1.0 - sine * sine) * n - sine * left(n);
      state.velocity = (1.0 / std::sqrt(dot(v, v))) * v;
      world.clear();
      world.limit_hits(20);
      world.add(particle(omega), state);
      world.run_until(1e300, seen);
      ASSERT_EQ(world.fate(0), Fate::capped) << name << ": " << world.report(0);
    }
    const double count = static_cast<double>(seen.hits), mean = seen.sum / count;
    // Hits of one orbit are not independent: as if there were 20 times fewer.
    const double error =
        std::sqrt((seen.squares / count - mean * mean) / static_cast<double>(orbits));
    EXPECT_NEAR(mean, measure(table).mean_flight, 4.0 * error) << name;
    EXPECT_LT(seen.speed, 1e-14) << name;
    const DecisionCounts& counts = world.decisions();
    EXPECT_GT(static_cast<double>(counts.filter), 0.999 * static_cast<double>(counts.exact))
        << name;
    std::printf("%-14s omega %g, %3zu walls, mean flight %.5f of %.5f, exact %llu of %llu\n", name,
                omega, table.walls.size(), mean, measure(table).mean_flight,
                static_cast<unsigned long long>(counts.exact),
                static_cast<unsigned long long>(counts.filter + counts.exact));
  }
}

TEST(Beziers, MeanFlightIsPiAreaOverPerimeter) {
  expect_mean_flight_of_area(0.0);
  expect_mean_flight_of_area(-0.25);
}

TEST(Beziers, StagesGiveTheSameBits) {
  for (const auto& [name, table] : tables()) {
    HitFinder filter(table), exact(table, {1e300}), inflated(table, {0x1p20}),
        without_grid(table, {1.0, 1 << 30});
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const int flights = static_cast<int>(cases(12, 400));
    for (int i = 0; i < flights; ++i) {
      Flight f;
      const int wall = static_cast<int>(unit(random) * static_cast<double>(table.walls.size()));
      const geometry::Curve& curve = table.wall(wall).curve;
      const double u = std::max(0x1p-53, unit(random) * geometry::last_parameter(curve));
      const Vector n = geometry::normal_at(curve, u);
      double sine = 2.0 * unit(random) - 1.0;
      if (i % 5 == 0) sine = std::copysign(1.0 - std::ldexp(unit(random), -i % 40), sine);
      f.velocity = std::sqrt((1.0 - sine) * (1.0 + sine)) * n - sine * left(n);
      if (i % 7 == 0) {  // at a joint
        const int other = static_cast<int>(unit(random) * static_cast<double>(table.walls.size()));
        const Vector to = geometry::start_point(table.wall(other).curve);
        const Vector d = to - geometry::point_at(curve, u);
        if (dot(d, n) > 0.0) f.velocity = (1.0 / std::sqrt(dot(d, d))) * d;
      }
      f.omega = i % 2 == 0 ? 0.0 : std::ldexp(i % 4 == 1 ? 1.0 : -1.0, i % 6 - 2);
      f.square_speed = dot(f.velocity, f.velocity);
      filter.pieces().begin_on_wall(f, wall, u, geometry::point_at(curve, u), f.velocity);
      DecisionCounts counts;
      if (filter.pieces().inward(wall, u, f.velocity, n, counts) != Sign::positive) continue;
      const Ahead first = filter.next(f, counts);
      for (HitFinder* other : {&exact, &inflated, &without_grid}) {
        const Ahead again = other->next(f, counts);
        EXPECT_EQ(first.kind, again.kind) << name << " " << i;
        EXPECT_EQ(first.piece, again.piece) << name << " " << i;
        EXPECT_EQ(first.kappa, again.kappa) << name << " " << i;
        EXPECT_EQ(first.duration, again.duration) << name << " " << i;
        if (first.kind == Ahead::Kind::wall) {
          EXPECT_EQ(first.u, again.u) << name << " " << i;
        }
      }
    }
  }
}

TEST(Beziers, FlightsBesideACuspAreDecided) {
  const Table table = build_table(*carom::cardioid(1).spec);
  const int last = static_cast<int>(table.walls.size()) - 1;
  HitFinder filter(table), exact(table, {1e300});
  int hits[2] = {0, 0};
  for (int i = 0; i < 60; ++i) {
    const double off = std::ldexp(i % 2 == 0 ? 1.0 : -1.0, -20 - i / 2);
    Flight f;
    f.omega = i % 3 == 0 ? 0.0 : 0.25;
    DecisionCounts counts;
    if (i % 10 < 5) {  // towards it, from within
      const Vector from{1.5, 0.125 * (i % 10)};
      f.velocity = Vector{0.0, off} - from + 0.5 * f.omega * left(Vector{0.0, off} - from);
      f.square_speed = dot(f.velocity, f.velocity);
      f.start = from;
      filter.pieces().begin(f);
    } else {  // from the wall beside it
      const int wall = i % 2 == 0 ? 0 : last;
      const double away = std::fabs(off) * 0.5,
                   u = std::clamp(wall == 0 ? away : 1.0 - away, 0x1p-53, 1.0 - 0x1p-53);
      const Vector n = geometry::normal_at(table.wall(wall).curve, u);
      f.velocity = n + (0.5 * (i % 10 - 7)) * left(n);
      f.square_speed = dot(f.velocity, f.velocity);
      filter.pieces().begin_on_wall(f, wall, u, geometry::point_at(table.wall(wall).curve, u),
                                    f.velocity);
    }
    const Ahead first = filter.next(f, counts), again = exact.next(f, counts);
    // What is aimed by less than rounding beside it flies into the tip.
    EXPECT_EQ(first.kind, again.kind) << i;
    EXPECT_EQ(first.piece, again.piece) << i;
    EXPECT_EQ(first.kappa, again.kappa) << i;
    EXPECT_EQ(first.u, again.u) << i;
    if (first.piece == 0) ++hits[0];
    if (first.piece == last) ++hits[1];
  }
  EXPECT_GT(hits[0], 0);
  EXPECT_GT(hits[1], 0);
  // Into the tip itself, and from it only away.
  World world(table);
  Recorder seen;
  world.add(particle(), start({1.0, 0.0}, {-1.0, 0.0}));
  world.run_until(3.0, seen);
  EXPECT_EQ(world.fate(0), Fate::singular) << world.report(0);
}

TEST(Beziers, ReversedOrbitsReturn) {
  for (const auto& [name, table] : tables()) {
    for (const double omega : {0.0, 0.7}) {
      World world(table);
      Recorder there;
      world.add(particle(omega), start({0.3, 0.6}, {0.6, 0.8}));
      world.limit_hits(6);
      world.run_until(1e300, there);
      ASSERT_EQ(there.hits.size(), 6u) << name;
      const HitEvent &before = there.hits[4], &last = there.hits[5];
      // Half of the last flight.
      const double half = 0.5 * last.flight_time, angle = omega * half;
      const double kappa = omega == 0.0 ? 1.0 / half : 0.5 * omega / std::tan(0.5 * angle);
      const Vector middle =
          before.position + geometry::displacement(kappa, before.after, omega, 0.5);
      const Vector velocity =
          geometry::turned_by(std::sin(angle), 1.0 - std::cos(angle), before.after);
      World back(table);
      back.add(particle(-omega), start(middle, -velocity));
      Recorder again;
      back.limit_hits(5);
      back.run_until(1e300, again);
      for (std::size_t i = 0; i < 5; ++i) {
        const Vector d = again.hits[i].position - there.hits[4 - i].position;
        EXPECT_LT(std::sqrt(dot(d, d)), 1e-9) << name << " " << omega << " " << i;
      }
      EXPECT_EQ(world.state(0).wall, last.wall);
    }
  }
}

/// Equal but for roundings, which grow by `growth` a hit at most.
void expect_same_orbits(const Table& curve, const Table& conic, double growth, double omega,
                        std::size_t count = 200) {
  EXPECT_GT(curve.walls.size(), 4u);
  EXPECT_LE(curve.curve_errors.distance, 2e-14);
  Recorder a, b;
  World one(curve), other(conic);
  for (auto [world, seen] : {std::pair{&one, &a}, std::pair{&other, &b}}) {
    world->add(particle(omega), start({0.3, 0.1}, {0.6, 0.8}));
    world->limit_hits(static_cast<std::uint64_t>(count));
    world->run_until(1e300, *seen);
  }
  ASSERT_EQ(a.hits.size(), count);
  ASSERT_EQ(b.hits.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector d = a.hits[i].position - b.hits[i].position;
    EXPECT_LT(std::sqrt(dot(d, d)), growth * static_cast<double>(i + 1)) << i << " " << omega;
  }
  EXPECT_NEAR(measure(curve).perimeter, measure(conic).perimeter, 1e-12);
  EXPECT_NEAR(measure(curve).area, measure(conic).area, 1e-12);
}

TEST(Beziers, NormalsAndCurvaturesAreAsCloseAsIsSaid) {
  for (const Table& table : {polar("1 + 0*phi"), parametric("cos(t)", "sin(t)"),
                             build_table(implicit_spec("x^2 + y^2 - 1"))}) {
    const CurveErrors& off = table.curve_errors;
    for (const Wall& wall : table.walls) {
      const geometry::CurveFrame frame = geometry::frame_of(wall.curve);
      for (double u = 0.0; u <= 1.0; u += 0.125) {
        const Vector x = point_at(frame, u), n = normal_at(frame, u);
        const double r = std::sqrt(dot(x, x)), rounding = 1e-16 / frame.minor;
        EXPECT_LE(std::fabs(r - 1.0), off.distance + 4e-16);
        EXPECT_LE(std::fabs(cross(n, x)), off.normal + 40.0 * rounding);
        EXPECT_LE(std::fabs(curvature_at(frame, u) - 1.0),
                  off.curvature + 400.0 * rounding / frame.minor);
      }
    }
  }
  for (const auto& [name, table] : tables()) {
    const CurveErrors& off = table.curve_errors;
    std::printf("%-14s distance %.1e, normals %.1e, curvatures %.1e\n", name, off.distance,
                off.normal, off.curvature);
    EXPECT_LE(off.normal, 1e-11) << name;
    EXPECT_LE(off.curvature, 1e-8) << name;
  }
}

// The bound is that of the middle of a piece, where (u - 1/2)^3 is not small: it is nearly reached.
TEST(Beziers, PiecesAreAsFarFromTheirCurveAsIsSaid) {
  const std::pair<const char*, double (*)(double)> curves[] = {
      {"1 + 0.5*cos(phi)", [](double phi) { return 1.0 + 0.5 * std::cos(phi); }},
      {"1 + 0.2*sin(5*phi)", [](double phi) { return 1.0 + 0.2 * std::sin(5.0 * phi); }},
      {"exp(0.5*cos(2*phi))", [](double phi) { return std::exp(0.5 * std::cos(2.0 * phi)); }},
      {"1/(2 + sin(phi))", [](double phi) { return 1.0 / (2.0 + std::sin(phi)); }}};
  for (const auto& [text, radius] : curves) {
    const Table table = polar(text);
    double worst = 0.0;
    for (const Wall& wall : table.walls) {
      const Vector a = start_point(wall.curve), b = end_point(wall.curve);
      const double from = std::atan2(a.y, a.x), turn = std::atan2(cross(a, b), dot(a, b)),
                   middle = from + 0.5 * turn;
      const Vector at = point_at(geometry::frame_of(wall.curve), 0.5),
                   d = at - radius(middle) * Vector{std::cos(middle), std::sin(middle)};
      worst = std::max(worst, std::sqrt(dot(d, d)));
    }
    EXPECT_LE(worst, table.curve_errors.distance + 6e-16) << text;
    EXPECT_GE(worst, 0.2 * table.curve_errors.distance) << text;
  }
}

TEST(Beziers, ConicsWrittenAsCurvesHaveTheirOrbits) {
  const Table circle = build_table(*carom::circle(1).spec),
              ellipse = build_table(*carom::ellipse(2, 1).spec);
  for (const double omega : {0.0, 0.3, -1.2})
    expect_same_orbits(polar("1 + 0*phi"), circle, 3e-11, omega);
  for (const TableSpec& spec :
       {implicit_spec("x^2 + y^2 - 1"), implicit_spec("1 - sqrt(x^2 + y^2)", at(0.25, 0.5))})
    for (const double omega : {0.0, 0.3, -1.2})
      expect_same_orbits(build_table(spec), circle, 3e-11, omega);
  expect_same_orbits(parametric("2*cos(t)", "sin(t)"), ellipse, 3e-11, 0.0);
  expect_same_orbits(build_table(implicit_spec("x^2/4 + y^2 - 1")), ellipse, 3e-11, 0.0);
  // The other way round it is the same table.
  expect_same_orbits(parametric("2*cos(t)", "-sin(t)"), ellipse, 3e-11, 0.0);
  // Chaotic in a field, so for a few hits alone.
  expect_same_orbits(parametric("2*cos(t)", "sin(t)"), ellipse, 1e-11, 1.5, 8);
}

TEST(Beziers, JointsReflectWhereCurvesRest) {
  // Both halves rest at both ends, where they go up and down: smooth joints.
  const Table table = build_table(
      path_spec(at(1, 0), {bezier({at(1, 0), at(1, 1), at(-1, 1), at(-1, 0), at(-1, 0)}),
                           bezier({at(-1, 0), at(-1, -1), at(1, -1), at(1, 0), at(1, 0)})}));
  for (const Vector from : {Vector{0, 0}, Vector{0, -0.25}, Vector{0, 0.25}, Vector{0.5, 0.125}})
    for (const double side : {1.0, -1.0})
      for (const double omega : {0.0, 0.25, -0.125}) {
        const Vector way = Vector{side, 0} - from, v = way + 0.5 * omega * left(way);  // exact
        World world(table);
        Recorder seen;
        world.add(particle(omega, std::sqrt(dot(v, v))), start(from, v));
        world.limit_hits(2);
        world.run_until(1e300, seen);
        ASSERT_EQ(seen.hits.size(), 2u) << world.report(0);
        EXPECT_EQ(seen.hits[0].position, (Vector{side, 0}))
            << from.y << " " << side << " " << omega;
        EXPECT_EQ(seen.hits[0].u, 0.0);
        const Vector before = seen.hits[0].before, after = seen.hits[0].after;
        EXPECT_NEAR(after.x, -before.x, 1e-15);
        EXPECT_NEAR(after.y, before.y, 1e-15);
      }
}

TEST(Beziers, JointsOfOneCurveReflect) {
  const Table table = spline({at(0, 0), at(3, -1), at(4, 1), at(2, 2), at(1, 4), at(-1, 2)});
  for (const Vector joint : {Vector{3, -1}, Vector{4, 1}, Vector{1, 4}, Vector{-1, 2}}) {
    for (const double omega : {0.0, 0.25, -0.125}) {
      World world(table);
      Recorder seen;
      const Vector from{1, 1}, way = joint - from, v = way + 0.5 * omega * left(way);  // exact
      world.add(particle(omega, std::sqrt(dot(v, v))), start(from, v));
      world.limit_hits(3);
      world.run_until(1e300, seen);
      ASSERT_EQ(seen.hits.size(), 3u) << world.report(0);
      EXPECT_EQ(seen.hits[0].u, 0.0);
      EXPECT_EQ(seen.hits[0].reflections, 1);
    }
  }
}

std::string fault_of(const TableSpec& spec) {
  try {
    build_table(spec);
  } catch (const InputError& e) {
    return e.problem();
  }
  return "";
}

TEST(Beziers, CurvesThatBoundNoRegionAreNamed) {
  const auto mentions = [](const std::string& text, const char* word) {
    EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  // A loop within one piece; two pieces that cross; a cusp within a piece; one at a joint.
  mentions(fault_of(path_spec(at(0, 0), {bezier({at(6, 4), at(-4, 4), at(2, 0)}), line(at(0, 0))})),
           "crosses itself");
  mentions(fault_of(path_spec(at(0, 0), {bezier({at(1, 2), at(2, -2), at(3, 0)}), line(at(1.5, 3)),
                                         line(at(1, -2)), line(at(0, 0))})),
           "cross");
  mentions(fault_of(path_spec(at(0, 0), {bezier({at(2, 2), at(0, 2), at(2, 0)}), line(at(1, -1)),
                                         line(at(0, 0))})),
           "cusp");
  mentions(fault_of(path_spec(at(0, 0),
                              {bezier({at(1, 0), at(2, 1)}), bezier({at(1.5, 0.5), at(0, 0)})})),
           "cusp");
  // On two sides of the tangent.
  EXPECT_EQ(fault_of(path_spec(at(0, 0), {line(at(1, -1)), bezier({at(1.5, 0.5), at(2, 1)}),
                                          bezier({at(1, 0), at(0, 0)})})),
            "");
  EXPECT_EQ(fault_of(path_spec(at(0, 0), {bezier({at(4, 4), at(-4, 4), at(0, 0)})})), "");
}

TEST(Beziers, CurvesOfEquationsAreWhatTheyAre) {
  // Of two circles the first on the right; the same curve from elsewhere, and by its angle.
  const char* circles = "(x^2 + y^2 - 1)*(x^2 + y^2 - 4)";
  EXPECT_NEAR(measure(build_table(implicit_spec(circles))).area, M_PI, 1e-12);
  EXPECT_NEAR(measure(build_table(implicit_spec(circles, at(1.5, 0)))).area, 4 * M_PI, 1e-12);
  const Table wavy = build_table(
                  implicit_spec("sqrt(x^2 + y^2) - 1 - 0.3*cos(3*atan2(y, x))", at(0.1, 0.1))),
              same = polar("1 + 0.3*cos(3*phi)");
  EXPECT_NEAR(measure(wavy).area, measure(same).area, 1e-12);
  EXPECT_NEAR(measure(wavy).perimeter, measure(same).perimeter, 1e-12);
  // Far from the origin, and small: 1e-14 of its size.
  const Table small = build_table(implicit_spec("x^2 + y^2 - 1e-10"));
  EXPECT_LT(small.curve_errors.distance, 1e-19);
  const auto mentions = [](const TableSpec& spec, const char* word) {
    EXPECT_NE(fault_of(spec).find(word), std::string::npos) << fault_of(spec);
  };
  mentions(implicit_spec("x^2 + y^2"), "fulfilled");
  mentions(implicit_spec("x^2 + y^2 + 1"), "no wall");
  mentions(implicit_spec("x*y - 1", at(0, 0.5)), "does not close");
  mentions(implicit_spec(circles, at(-1.5, 0)), "does not go around");
  mentions(implicit_spec("abs(x) + abs(y) - 1", at(0.1, 0.2)), "corner");
  mentions(implicit_spec("(x^2 + y^2)^2 - 2*(x^2 - y^2)", at(1, 0)), "crosses itself");
  mentions(implicit_spec("(x^2 + y^2 - 1)^2"), "touches");
  mentions(implicit_spec("log(x)"), "no value");
}

TEST(Beziers, WildFormulasAreNamed) {
  const auto fault = [](const char* radius) {
    TableSpec spec;
    spec.shape = "polar";
    spec.formulas["radius"] = {radius, {}};
    return fault_of(spec);
  };
  EXPECT_NE(fault("cos(phi)"), "");           // vanishes
  EXPECT_NE(fault("1 + 0.1*phi"), "");        // does not close
  EXPECT_NE(fault("1 + abs(sin(phi))"), "");  // has a corner
  EXPECT_NE(fault("1/(phi - 1)"), "");
  EXPECT_NE(fault("2 + sqrt(phi)"), "");
  EXPECT_EQ(fault("2 + sin(phi)"), "");
}

}  // namespace
}  // namespace carom::tests
