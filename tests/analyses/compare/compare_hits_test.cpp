// The orbit in 34 digits among walls, against closed forms, the way back, and the walls themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "analyses/compare/precise_orbit.hpp"
#include "analyses/compare/precise_path.hpp"
#include "analyses/compare/setting.hpp"
#include "analyses/systems.hpp"
#include "carom/analyses/compare.hpp"
#include "carom/base/error.hpp"

namespace carom::analyses {
namespace {

double size(const Quad& a) { return absolute(a).to_double(); }
double apart(const QuadVector& a, const QuadVector& b) {
  return std::max(size(a.x - b.x), size(a.y - b.y));
}

/// A hit in closed form.
struct Expected {
  Quad t;
  std::string wall;
  QuadVector place;
};

/// One coordinate that flies to and fro between two walls, or falls on one again and again: hits at
/// first + k * period of each wall in turn.
struct Bounces {
  Quad first, between;
  std::vector<std::string> walls;  ///< in turn
};

std::vector<Expected> hits_until(double t, const std::vector<Bounces>& coordinates) {
  std::vector<Expected> hits;
  for (const Bounces& c : coordinates)
    for (int k = 0;; ++k) {
      const Quad now = c.first + Quad(k) * c.between;
      if (!(now < Quad(t))) break;
      hits.push_back({now, c.walls[static_cast<std::size_t>(k) % c.walls.size()], {}});
    }
  std::sort(hits.begin(), hits.end(),
            [](const Expected& a, const Expected& b) { return a.t < b.t; });
  return hits;
}

/// As the search expects them: particles and walls.
std::vector<ComparedHit> order_of(const System& system, const std::vector<Expected>& hits) {
  std::vector<ComparedHit> order;
  for (const Expected& hit : hits) order.push_back({0, system.table->wall_index(hit.wall), 0, {}});
  return order;
}

std::vector<ComparedHit> hits_in_doubles(const Runs& runs, double t) {
  return runs.fly(runs.by("mclachlan-ss17", 0.005, 0.0), t, Runs::Part::orbit).hits;
}

/// A ball in a box 2 wide and 4 high, with gravity 1, that does not come to the top.
const char* const ball = R"(
[table]
shape = "rectangle"
width = 2
height = 4
[initial]
kind = "point"
position = [0.5, 0.75]
velocity = [0.625, 0.25]
[[potential]]
kind = "linear"
force = [0, -1]
[integrator]
step = 0.01
)";
/// y falls as t^2/2: it comes to the floor with v, then each 2 v.
std::vector<Expected> hits_of_the_ball(double t) {
  const Quad v = root(Quad(0.0625) + Quad(1.5));
  std::vector<Expected> hits =
      hits_until(t, {{Quad(0.25) + v, v + v, {"bottom"}},
                     {Quad(1.5) / Quad(0.625), Quad(2.0) / Quad(0.625), {"right", "left"}}});
  int turns = 0;
  for (Expected& hit : hits) {
    if (hit.wall == "bottom") {
      const Quad way = Quad(0.5) + Quad(0.625) * hit.t - Quad(2 * turns);
      hit.place = {turns % 2 == 0 ? way : Quad(2.0) - way, 0.0};
    } else {
      Quad since = hit.t + (v - Quad(0.25));  // the last time on the floor would have been
      while (v + v < since) since = since - (v + v);
      hit.place = {hit.wall == "right" ? 2.0 : 0.0, since * (v - since / Quad(2.0))};
      ++turns;
    }
  }
  return hits;
}

TEST(HitsIn34Digits, ABallFallsOnTheFloorInClosedForm) {
  const System system = make_system(ball);
  const double t = 40.0;
  const std::vector<Expected> closed = hits_of_the_ball(t);
  const Runs runs(system, 0, {});
  PreciseMotion motion(runs, find_scheme("mclachlan-ss17"));
  const auto path = motion.follow(motion.start(), t, 8, order_of(system, closed));
  ASSERT_TRUE(path);
  ASSERT_GT(closed.size(), 25u);
  for (std::size_t k = 0; k < closed.size(); ++k) {
    EXPECT_LT(size(path->hits[k].t - closed[k].t), 1e-30) << k;
    EXPECT_LT(apart(path->hits[k].place, closed[k].place), 1e-30) << k;
  }
  // They are what schemes are compared with. No halving changes anything but rounding: no order is
  // seen, nor needed.
  const Setting setting = setting_of(runs, t);
  EXPECT_TRUE(setting.in_34_digits);
  ASSERT_EQ(setting.reference.hits.size(), closed.size());
  for (std::size_t k = 0; k < closed.size(); ++k) {
    const ComparedHit& hit = setting.reference.hits[k];
    EXPECT_EQ(hit.t, closed[k].t.to_double());
    EXPECT_LT(apart({hit.place.x, hit.place.y}, closed[k].place), 3e-16);
  }
}

/// A well with frequencies 1 and 3/2 whose centre is at (1, 0.75), in a box 1.75 by 1.25.
const char* const well = R"(
[table]
shape = "rectangle"
width = 1.75
height = 1.25
[initial]
kind = "point"
position = [1, 0.75]
velocity = [1.25, 1.5]
[[potential]]
kind = "harmonic"
omega_x = 1
omega_y = 1.5
centers = [[1, 0.75]]
[integrator]
step = 0.01
)";
/// a sin(w t) from the middle comes to `right` at asin(right/a)/w, and from there to `left` in the
/// angle between both.
Bounces bounces(const Quad& a, const Quad& w, double left, double right,
                std::vector<std::string> walls) {
  const auto to = [&](double x) { return angle(Quad(x), root(a * a - Quad(x) * Quad(x))) / w; };
  return {to(right), to(right) + to(left), std::move(walls)};
}
std::vector<Expected> hits_in_the_well(double t) {
  return hits_until(t, {bounces(1.25, 1.0, 1.0, 0.75, {"right", "left"}),
                        bounces(1.0, 1.5, 0.75, 0.5, {"top", "bottom"})});
}

TEST(HitsIn34Digits, AWellInABoxKeepsItsClosedFormAndTheOrderOfTheScheme) {
  const System system = make_system(well);
  const double t = 20.0;
  const std::vector<Expected> closed = hits_in_the_well(t);
  const Runs runs(system, 0, {});
  PreciseMotion motion(runs, find_scheme("mclachlan-ss17"));
  double before = 0.0;
  for (const int steps : {32, 64, 128, 256}) {
    const auto path = motion.follow(motion.start(), t, steps, order_of(system, closed));
    ASSERT_TRUE(path);
    double error = 0.0;
    for (std::size_t k = 0; k < closed.size(); ++k)
      error = std::max(error, size(path->hits[k].t - closed[k].t));
    if (before > 0.0) {
      EXPECT_NEAR(before / error, 256.0, 40.0) << steps;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-22);
  const Setting setting = setting_of(runs, t);
  EXPECT_TRUE(setting.in_34_digits);
  EXPECT_LT(setting.reference_error, 4e-16);
  ASSERT_EQ(setting.reference.hits.size(), closed.size());
  EXPECT_GT(closed.size(), 25u);
  for (std::size_t k = 0; k < closed.size(); ++k) {
    EXPECT_EQ(setting.reference.hits[k].t, closed[k].t.to_double()) << k;
    EXPECT_EQ(setting.reference.hits[k].wall, system.table->wall_index(closed[k].wall));
  }
}

TEST(HitsIn34Digits, ErrorsOfHitsAreThoseAgainstTheClosedForm) {
  const System system = make_system(well);
  const double t = 20.0;
  const std::vector<Expected> closed = hits_in_the_well(t);
  const Comparison result = compare(
      system, {.schemes = {"mclachlan-2", "mclachlan-ss17"}, .steps = {0.125, 0.0625}, .t_max = t});
  EXPECT_EQ(result.reference, "mclachlan-ss17 in 34 digits");
  const Runs runs(system, 0, {});
  for (const ComparedScheme& scheme : result.schemes)
    for (const ComparedRun& run : scheme.runs) {
      EXPECT_TRUE(run.same_hits);
      ASSERT_EQ(run.hits, closed.size());
      const Orbit orbit = runs.fly(runs.by(scheme.name, run.step, 0.0), t, Runs::Part::orbit);
      double error = 0.0;
      for (std::size_t k = 0; k < closed.size(); ++k)
        error = std::max(error, size(Quad(orbit.hits[k].t) - closed[k].t));
      EXPECT_NEAR(run.error_hit_time, error, 4e-15);
    }
  EXPECT_NEAR(result.schemes[0].runs[0].error_hit_time / result.schemes[0].runs[1].error_hit_time,
              4.0, 0.5);
}

std::string in(const std::string& table, const std::string& more) {
  return table + R"(
[particles]
energy = 2
)" + more +
         R"(
[integrator]
step = 0.01
)";
}
const char* const point = R"(
[initial]
kind = "point"
position = [0.2, 0.15]
velocity = [0.3, 1]
)";

struct Around {
  const char* name;
  std::string table, more;
  double t;
  friend void PrintTo(const Around& a, std::ostream* out) { *out << a.name; }
};

class WallsIn34Digits : public testing::TestWithParam<Around> {
 protected:
  System system_ = make_system(in(GetParam().table, GetParam().more));
  Runs runs_{system_, 0, {}};
};

// Velocities and field turned, the same walls are hit in the opposite order. Steps end at the same
// times, so that each is cut at a hit as it was on the way there: the scheme being symmetric, what
// is left is rounding.
TEST_P(WallsIn34Digits, TheWayBackLeadsToTheStart) {
  System back = system_;
  for (Particle& p : back.particles) p.omega = -p.omega;
  const Runs returning(back, 0, {});
  PreciseMotion there(runs_, find_scheme("mclachlan-ss17")),
      again(returning, find_scheme("mclachlan-ss17"));
  const double t = GetParam().t;
  const std::vector<ComparedHit> hits = hits_in_doubles(runs_, t);
  ASSERT_GT(hits.size(), 1u);
  std::vector<ComparedHit> backwards(hits.rbegin(), hits.rend());
  const PrecisePlace start = there.start();
  auto path = there.follow(start, t, 32, hits);
  ASSERT_TRUE(path);
  for (QuadVector& v : path->end.phase.velocity) v = -v;
  const auto returned = again.follow(path->end, t, 32, backwards);
  ASSERT_TRUE(returned);
  for (std::size_t i = 0; i < start.cells.size(); ++i) {
    EXPECT_EQ(returned->end.cells[i], start.cells[i]);
    EXPECT_LT(apart(returned->end.phase.position[i], start.phase.position[i]), 1e-27);
    EXPECT_LT(apart(returned->end.phase.velocity[i], -start.phase.velocity[i]), 1e-27);
  }
}

TEST_P(WallsIn34Digits, AReferenceIsFound) {
  const Setting setting = setting_of(runs_, GetParam().t);
  EXPECT_TRUE(setting.in_34_digits);
  EXPECT_LT(setting.reference_error, 4e-16);
}

const std::string bump = R"([[potential]]
kind = "gaussian"
height = 0.3
width = 0.1
centers = [[0.4, 0.35]]
lattice = true
[initial]
kind = "point"
position = [0.4, 0.35]
velocity = [0.3, 1]
)";
const std::string quartic = std::string(point) + R"([[potential]]
kind = "quartic"
strength = 0.5
)";

INSTANTIATE_TEST_SUITE_P(
    Tables, WallsIn34Digits,
    testing::Values(
        Around{"circle", "[table]\nshape = \"circle\"\nradius = 1\n", quartic, 6.0},
        Around{"lemon",
               "[field]\nB = 0.7\n[table]\nshape = \"lemon\"\nradius = 1\nseparation = 0.8\n",
               quartic, 6.0},
        Around{"ellipse", "[table]\nshape = \"ellipse\"\na = 1.5\nb = 1\n", quartic, 8.0},
        Around{
            "mushroom",
            "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 0.6\nstem_height = 0.5\n",
            quartic, 6.0},
        Around{"lattice",
               "[field]\nB = 1.5\n[table]\nshape = \"lorentz\"\nspacing = 1\nradius = 0.3\n", bump,
               1.5},
        Around{"charges", "[table]\nshape = \"circle\"\nradius = 1\n",
               "count = 3\n[initial]\nkind = \"uniform\"\n[interaction]\nkind = \"coulomb\"\n"
               "strength = 0.1\n",
               1.0}),
    [](const auto& around) { return around.param.name; });

// On a lattice: each hit is a radius from a lattice point, in the plane.
TEST(HitsIn34Digits, OnALatticeTheyAreInThePlane) {
  const System system = make_system(
      in("[table]\nshape = \"lorentz\"\nspacing = 1\nradius = 0.2\nlattice = \"square\"\n", bump));
  const Runs runs(system, 0, {});
  const double t = 3.0;
  PreciseMotion motion(runs, find_scheme("mclachlan-ss17"));
  const auto path = motion.follow(motion.start(), t, 32, hits_in_doubles(runs, t));
  ASSERT_TRUE(path);
  ASSERT_GT(path->hits.size(), 1u);
  double farthest = 0.0;
  for (const PreciseHit& hit : path->hits) {
    const double x = std::nearbyint(hit.place.x.to_double()),
                 y = std::nearbyint(hit.place.y.to_double());
    const QuadVector d = hit.place - QuadVector{x, y};
    EXPECT_LT(size(root(dot(d, d)) - Quad(0.2)), 1e-32);
    farthest = std::max(farthest, std::fabs(x) + std::fabs(y));
  }
  EXPECT_GT(farthest, 0.0);
}

// A path beyond the floor that rises nearly to it has no crossing: that the particle is outside is
// told by its place.
TEST(HitsIn34Digits, AParticleOutsideIsRefused) {
  const System system = make_system(ball);
  const Runs runs(system, 0, {});
  PreciseMotion motion(runs, find_scheme("mclachlan-ss17"));
  PrecisePlace place = motion.start();
  const double v = 0.25, highest = v * v / 2.0, step = 2.0 * v;
  place.phase.velocity[0] = {0.0, v};
  place.phase.position[0] = {1.0, -highest - 1e-4};
  EXPECT_FALSE(motion.follow(place, step * parts, 1, {}));
  place.phase.position[0] = {1.0, 3.0};
  EXPECT_TRUE(motion.follow(place, step * parts / 16.0, 1, {}));
}

// From between the bumps of a lattice no formula is evaluated for a while; what is looked for
// costs, too, and an orbit that costs more than it may ends.
TEST(HitsIn34Digits, AnOrbitThatCostsTooMuchEnds) {
  const System system = make_system(R"(
[lattice]
vectors = [[1, 0], [0, 1]]
[[potential]]
kind = "fermi"
height = 200
radius = 0.08
softness = 0.001
lattice = true
[initial]
kind = "point"
position = [0.5, 0.5]
velocity = [0.6, 0.8]
[integrator]
step = 0.0002
)");
  const Runs runs(system, 0, {});
  PreciseMotion motion(runs, find_scheme("mclachlan-ss17"));
  EXPECT_FALSE(motion.follow(motion.start(), 1.0, 1000, {}, 200.0));
  EXPECT_GT(motion.terms(), 200.0);
  EXPECT_LT(motion.terms(), 300.0);
}

// Other hits than those of the reference in doubles are no orbit of the same system.
TEST(HitsIn34Digits, OtherHitsThanExpectedAreRefused) {
  const System system = make_system(ball);
  const Runs runs(system, 0, {});
  std::vector<ComparedHit> order = order_of(system, hits_of_the_ball(8.0));
  PreciseMotion motion(runs, find_scheme("mclachlan-ss17"));
  EXPECT_TRUE(motion.follow(motion.start(), 8.0, 4, order));
  std::swap(order[0], order[1]);
  EXPECT_FALSE(motion.follow(motion.start(), 8.0, 4, order));
  std::swap(order[0], order[1]);
  order.push_back(order.back());
  EXPECT_FALSE(motion.follow(motion.start(), 8.0, 4, order));
  order.resize(order.size() - 2);
  EXPECT_FALSE(motion.follow(motion.start(), 8.0, 4, order));
}

// With the velocity 1 across the wall, of 2 in all.
TEST(HitsIn34Digits, AHitIsWithinTheErrorOfItsState) {
  const ComparedHit hit{0, 1, 3.0, {1.0, 2.0}};
  const std::vector<PreciselyHit> precise{{hit, 2.0, 1.0}};
  const double error = 1e-9;
  const auto same = [&](double late, double beside) {
    ComparedHit other = hit;
    other.t += late;
    other.place.y += beside;
    return same_hits({other}, precise, error);
  };
  EXPECT_TRUE(same(0.9e-9, 0.0));
  EXPECT_FALSE(same(1.1e-9, 0.0));
  EXPECT_TRUE(same(0.0, 2.9e-9));
  EXPECT_FALSE(same(0.0, -3.1e-9));
  EXPECT_FALSE(same_hits({}, precise, error));
}

// Straight into a corner, where both walls are hit at once: they have no order, and the reference
// stays in doubles.
TEST(HitsIn34Digits, ACornerLeavesTheReferenceInDoubles) {
  const System system = make_system(R"(
[table]
shape = "rectangle"
width = 2
height = 1
[initial]
kind = "point"
position = [1, 0.5]
velocity = [2, 1]
[[potential]]
kind = "harmonic"
omega = 1
centers = [[1, 0.5]]
[integrator]
step = 0.01
)");
  const Comparison result = compare(system, {.schemes = {"velocity-verlet"}, .t_max = 4.0});
  EXPECT_EQ(result.reference, "mclachlan-ss17");
  EXPECT_GT(result.hits, 3u);
}

}  // namespace
}  // namespace carom::analyses
