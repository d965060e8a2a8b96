// Joints: a ray aimed at one is never lost, and ends only where the exact hit is the joint and its
// reflection has no limit.
#include <gtest/gtest.h>

#include <cstdio>

#include "carom/events/world.hpp"
#include "events/flight/next_hit.hpp"
#include "random_tables.hpp"

namespace carom::tests {

using namespace events;

namespace {

struct Recorder : Observer {
  std::vector<HitEvent> hits;
  double ended = 0.0;
  void hit(const HitEvent& h) override { hits.push_back(h); }
  void end(const EndEvent& e) override { ended = e.time.value(); }
};

struct Course {
  Fate fate = Fate::survived;
  double end = 0.0;
  std::vector<HitEvent> hits;
};
Course follow(World& world, Vector at, Vector velocity, double omega, std::uint64_t hits,
              double t = 1e9) {
  world.clear();
  world.limit_hits(hits);
  Particle p;
  p.speed = std::sqrt(dot(velocity, velocity));
  p.omega = omega;
  State s;
  s.position = at;
  s.velocity = velocity;
  world.add(p, s);
  Recorder r;
  world.run_until(t, r);
  return {world.fate(0), r.ended, r.hits};
}

Ahead::Kind first_kind(HitFinder& finder, Vector at, Vector velocity, double omega) {
  Flight f;
  f.start = at;
  f.velocity = velocity;
  f.omega = omega;
  f.square_speed = dot(velocity, velocity);
  finder.pieces().begin(f);
  DecisionCounts counts;
  return finder.next(f, counts).kind;
}

struct Shares {
  long rays = 0, at_joint = 0, reflected_there = 0, singular = 0, lost = 0, unexplained = 0;
};

/// Where the corner at a wall's start has an angle without a limit, a hit of it is the end.
Shares aim(const char* name, const Table& table, bool smooth, long rays, std::uint64_t seed) {
  Dice dice(seed);
  World world(table);
  HitFinder integers(table, {1e300});  // exact arithmetic alone
  std::vector<Vector> joints;
  geometry::Box box{{1e9, 1e9}, {-1e9, -1e9}};
  for (const Wall& w : table.walls) {
    joints.push_back(geometry::start_point(w.curve));
    const geometry::Box b = geometry::bounding_box(w.curve);
    box = {{std::fmin(box.low.x, b.low.x), std::fmin(box.low.y, b.low.y)},
           {std::fmax(box.high.x, b.high.x), std::fmax(box.high.y, b.high.y)}};
  }
  constexpr std::uint64_t more = 50;
  Shares share;
  while (share.rays < rays) {
    // Every third start and direction on a grid, so that the flight meets the joint exactly.
    const bool exact = dice.whole(0, 2) == 0;
    Vector at{dice.between(box.low.x, box.high.x), dice.between(box.low.y, box.high.y)};
    if (exact) at = {std::nearbyint(64 * at.x) / 64, std::nearbyint(64 * at.y) / 64};
    if (!world.contains(at)) continue;
    const Vector d =
        joints[static_cast<std::size_t>(dice.whole(0, static_cast<int>(joints.size()) - 1))] - at;
    const double l = std::sqrt(dot(d, d));
    if (!(l > 0.01)) continue;
    const double omega = exact || dice.coin() ? 0.0 : dice.between(-1.0, 1.0);
    const double sine = 0.5 * omega * l, cosine = std::sqrt(1.0 - sine * sine);
    if (!(sine * sine < 0.9)) continue;
    const Vector v = exact ? d : (1.0 / l) * (cosine * d + sine * left(d));
    ++share.rays;
    const Course c = follow(world, at, v, omega, more + 4);
    share.lost += c.fate == Fate::lost;
    const bool meets_joint = first_kind(integers, at, v, omega) == Ahead::Kind::joint;
    share.at_joint += meets_joint;
    share.reflected_there += meets_joint && !c.hits.empty();
    if (c.fate == Fate::capped) continue;
    ++share.singular;
    // Straight on from the start: the joint itself. Later: only orbits on the grid come back to
    // one.
    const bool explained =
        c.fate == Fate::singular && !smooth && (c.hits.empty() ? meets_joint : exact);
    if (!explained && share.unexplained++ < 3)
      ADD_FAILURE() << name << ": " << name_of(c.fate) << " after " << c.hits.size() << " hits; "
                    << world.report(0);
  }
  std::printf(
      "%-18s %7ld rays, %7.3f %% meet the joint exactly, %7.3f %% reflect there, %7.3f %% "
      "singular, lost "
      "%ld\n",
      name, share.rays, 100.0 * double(share.at_joint) / double(rays),
      100.0 * double(share.reflected_there) / double(rays),
      100.0 * double(share.singular) / double(rays), share.lost);
  EXPECT_EQ(share.lost, 0) << name;
  EXPECT_EQ(share.unexplained, 0) << name;
  return share;
}

TEST(Joints, NoRayIsLost) {
  const long rays = cases(6000, 200000);
  const Shares square = aim("square", rectangle(1, 1), false, rays, 1);
  EXPECT_EQ(square.singular, 0);  // every corner has a limit
  EXPECT_EQ(square.reflected_there, square.at_joint);
  EXPECT_GT(square.at_joint, rays / 5);
  const Shares star = aim("star",
                          polygon({{1, 0},
                                   {0.25, 0.25},
                                   {0, 1},
                                   {-0.25, 0.25},
                                   {-1, 0},
                                   {-0.25, -0.25},
                                   {0, -1},
                                   {0.25, -0.25}}),
                          false, rays, 2);
  EXPECT_GT(star.singular, 0);
  aim("triangle", polygon({{0, 0}, {1, 0}, {0.375, 0.75}}), false, rays, 3);
  const Shares smooth = aim("stadium", stadium(0.5, 1.0), true, rays, 4);
  EXPECT_EQ(smooth.singular, 0);  // smooth joints reflect
  EXPECT_GT(smooth.at_joint, rays / 5);
  EXPECT_EQ(smooth.reflected_there, smooth.at_joint);
  aim("mushroom", mushroom(1.0, 0.5, 1.0), false, rays, 5);
}

TEST(Joints, ARightAngleTurnsBack) {
  const Table table = rectangle(1, 1);
  World world(table);
  const Course c = follow(world, {0.5, 0.25}, {-0.5, -0.25}, 0.0, 2);
  ASSERT_EQ(c.hits.size(), 1u);
  EXPECT_EQ(c.hits[0].reflections, 2);
  EXPECT_DOUBLE_EQ(c.hits[0].after.x, 0.5);
  EXPECT_DOUBLE_EQ(c.hits[0].after.y, 0.25);
  EXPECT_EQ(c.fate, Fate::capped);  // two hits are counted
}

/// Velocity after `hits` reflections of rays that pass a corner closely on either side.
void expect_limit(const Table& table, Vector at, Vector v, int reflections) {
  World world(table);
  const Course c = follow(world, at, v, 0.0, static_cast<std::uint64_t>(reflections));
  ASSERT_EQ(c.hits.size(), 1u);
  EXPECT_EQ(c.hits[0].reflections, reflections);
  for (const double off : {1e-7, -1e-7}) {
    const Course beside = follow(world, at, {v.x - off * v.y, v.y + off * v.x}, 0.0,
                                 static_cast<std::uint64_t>(reflections));
    ASSERT_EQ(beside.hits.size(), static_cast<std::size_t>(reflections));
    EXPECT_NEAR(beside.hits.back().after.x, c.hits[0].after.x, 1e-6);
    EXPECT_NEAR(beside.hits.back().after.y, c.hits[0].after.y, 1e-6);
  }
}

TEST(Joints, AnglesThatDivideAHalfTurnReflectByTheirLimit) {
  const Table half = polygon({{0, 0}, {1, 0}, {1, 1}});  // 45, 90, 45 degrees
  expect_limit(half, {0.5, 0.25}, {-0.5, -0.25}, 4);
  expect_limit(half, {0.75, 0.25}, {0.25, 0.75}, 4);
  expect_limit(half, {0.5, 0.25}, {0.5, -0.25}, 2);
  Table equilateral = polygon({{0, 0}, {1, 0}, {0.5, std::sqrt(3.0) / 2}});
  World undeclared(equilateral);
  const Vector top = geometry::start_point(equilateral.walls[2].curve);
  EXPECT_EQ(follow(undeclared, {0.5, top.y - 0.5}, {0, 0.5}, 0.0, 9).fate, Fate::singular);
  for (Wall& w : equilateral.walls) w.corner = 3;
  expect_limit(equilateral, {0.5, top.y - 0.5}, {0, 0.5}, 3);
  expect_limit(equilateral, {0.25, 0.25}, {-0.25, -0.25}, 3);
}

TEST(Joints, ReflexCornersAreSingular) {
  const Table table = mushroom(1.0, 0.5, 1.0);
  World world(table);
  EXPECT_EQ(follow(world, {0.25, 0.5}, {0.25, -0.5}, 0.0, 9).fate, Fate::singular);
}

TEST(Joints, AnExactTangencyIsNoHit) {
  const Table table = with_disc(rectangle(1, 1), {0.5, 0.5}, 0.25);
  World world(table);
  for (const double y : {0.25, 0.75}) {
    const Course c = follow(world, {0.125, y}, {1, 0}, 0.0, 1);
    ASSERT_EQ(c.hits.size(), 1u);
    EXPECT_EQ(c.hits[0].wall, 1);
  }
  // One digit further in it is one.
  const Course c = follow(world, {0.125, std::nextafter(0.75, 0.0)}, {1, 0}, 0.0, 1);
  ASSERT_EQ(c.hits.size(), 1u);
  EXPECT_EQ(c.hits[0].wall, 4);
}

TEST(Joints, AFlightAlongATangentIntoAJointEndsThere) {
  // Beside a side that bulges inwards, along its tangent at the corner.
  const Table bulge = loop({Segment{{0, 0}, {4, 0}}, CircularArc{{4, 0}, {4, 4}, -0.5, false},
                            Segment{{4, 4}, {0, 4}}, Segment{{0, 4}, {0, 0}}});
  World world(bulge);
  const Course c = follow(world, {2, 2}, {1, 1}, 0.0, 9);
  EXPECT_EQ(c.fate, Fate::singular);
  EXPECT_EQ(c.end, 2.0);
  // A Larmor circle that meets a stadium's straight side where the narrower cap begins.
  const Table wide = stadium(5, 10);
  World smooth(wide);
  const Course d = follow(smooth, {-7, -6}, {16, -12}, -1.0, 9);
  EXPECT_EQ(d.fate, Fate::singular);
  EXPECT_TRUE(d.hits.empty());
}

TEST(Joints, ACuspIsSingular) {
  Table discs;
  discs.extent = Extent::open_plane;
  add_loop(discs, {Circle{{-1, 0}, 1.0, false}});
  add_loop(discs, {Circle{{1, 0}, 1.0, false}});
  World world(discs);
  const Course c = follow(world, {0, -3}, {0, 1}, 0.0, 9);
  EXPECT_EQ(c.fate, Fate::singular);
  EXPECT_TRUE(c.hits.empty());
  EXPECT_EQ(c.end, 3.0);
  EXPECT_NE(follow(world, {0x1p-40, -3}, {0, 1}, 0.0, 9).fate, Fate::singular);
  // A disc on a wall, and a Larmor circle about both that touches them where they touch each other.
  const Table disc_on_wall = with_disc(rectangle(8, 8), {4, 1}, 1.0);
  World larmor(disc_on_wall);
  EXPECT_EQ(follow(larmor, {4, 4}, {2, 0}, 1.0, 9, 6.0).fate, Fate::singular);
  // Of one wall a tangency is none: beside the disc the circle runs on.
  EXPECT_EQ(follow(larmor, {6, 4}, {2, 0}, 1.0, 9, 1.0).fate, Fate::survived);
}

TEST(Joints, ACuspOfEllipsesInAFieldIsSingular) {
  // A circle of radius 8 about (32, 8) that rolls between an ellipse and the wall, another ellipse
  // or a disc below.
  const Ellipse above{{32, 1}, {2, 0}, 0.5, false};
  Table on_wall = rectangle(64, 64);
  add_loop(on_wall, {above});
  Table two = loop({Segment{{0, -8}, {64, -8}}, Segment{{64, -8}, {64, 64}},
                    Segment{{64, 64}, {0, 64}}, Segment{{0, 64}, {0, -8}}});
  Table mixed = two;
  add_loop(two, {above});
  add_loop(two, {Ellipse{{32, -3}, {4, 0}, 0.75, false}});
  add_loop(mixed, {above});
  add_loop(mixed, {Circle{{32, -1}, 1.0, false}});
  for (const Table& table : {on_wall, two, mixed}) {
    World world(table);
    const Course c = follow(world, {24, 8}, {0, -8}, -1.0, 9, 6.0);
    EXPECT_EQ(c.fate, Fate::singular);
    EXPECT_DOUBLE_EQ(c.end, std::acos(0.0));  // a quarter turn
    EXPECT_TRUE(c.hits.empty());
    EXPECT_EQ(follow(world, {40, 8}, {0, -8}, 1.0, 9, 6.0).fate,
              Fate::singular);  // the other way round
    // One digit off it is a hit, or none.
    const Course beside = follow(world, {24, std::nextafter(8.0, 9.0)}, {0, -8}, -1.0, 9, 6.0);
    EXPECT_NE(beside.fate, Fate::singular);
    EXPECT_NE(beside.fate, Fate::lost);
  }
  // Of the ellipse alone a tangency is none: it never hits.
  Table alone = loop({Segment{{0, -8}, {64, -8}}, Segment{{64, -8}, {64, 64}},
                      Segment{{64, 64}, {0, 64}}, Segment{{0, 64}, {0, -8}}});
  add_loop(alone, {above});
  World once(alone);
  EXPECT_EQ(follow(once, {24, 8}, {0, -8}, -1.0, 9, 6.0).fate, Fate::pinned);
}

}  // namespace
}  // namespace carom::tests
