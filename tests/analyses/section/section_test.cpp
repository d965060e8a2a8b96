#include "carom/analyses/section.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "analyses/systems.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {
namespace {

constexpr const char* ellipse = "[table]\nshape = \"ellipse\"\na = 1\nb = 0.75\n";
constexpr const char* circle = "[table]\nshape = \"circle\"\nradius = 1\n";

System with_section(const std::string& toml, const std::string& section, double t_max = 100,
                    std::uint64_t trajectories = 20) {
  System system = make_system(toml + "[section]\n" + section + "\n");
  system.run.t_max = t_max;
  system.run.trajectories = trajectories;
  return system;
}

std::vector<SectionPoint> points_of(const System& system, int threads = 2) {
  std::vector<SectionPoint> points;
  SectionOptions options;
  options.threads = threads;
  options.points = [&](const std::vector<SectionPoint>& more) {
    points.insert(points.end(), more.begin(), more.end());
  };
  const SectionResult result = run_section(system, options);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.points, points.size());
  EXPECT_EQ(result.lost, 0u);
  return points;
}

TEST(Section, IsTheSameOnAnyNumberOfThreads) {
  for (const char* on : {"on = \"boundary\"", "on = \"circle:0.1,0.2,0.5\"", "on = \"vy=0.25\""}) {
    const System system = with_section(std::string(ellipse) + "[field]\nB = 0.5\n", on);
    SectionOptions options;
    options.threads = 1;
    const SectionResult one = run_section(system, options);
    EXPECT_GT(one.points, 200u);
    options.threads = 4;
    const SectionResult four = run_section(system, options);
    EXPECT_EQ(one.digest, four.digest);
    EXPECT_EQ(one.points, four.points);
    const auto points = points_of(system, 3);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const bool next = points[i].orbit == points[i - 1].orbit &&
                        points[i].index == points[i - 1].index + 1 &&
                        points[i].t >= points[i - 1].t;
      const bool first = points[i].orbit > points[i - 1].orbit && points[i].index == 0;
      EXPECT_TRUE(next || first);
    }
  }
}

class Hits : public Observer {
 public:
  void hit(const HitEvent& event) override { events.push_back(event); }
  std::vector<HitEvent> events;
};

TEST(Section, BoundarySectionIsTheStartAndEveryHit) {
  System system = with_section(std::string(ellipse) +
                                   "[initial]\nkind = \"birkhoff\"\nwall = \"ellipse\"\ns = [0.5, "
                                   "1, 2]\nv_parallel = [0.1, -0.3, 0.9]\n",
                               "points = 50", 1e300);
  const auto points = points_of(system);
  ASSERT_EQ(points.size(), 150u) << "three listed starts";
  EXPECT_NEAR(points[50].s, 1.0, 1e-12);
  EXPECT_NEAR(points[50].v_parallel, -0.3, 1e-12);
  EXPECT_EQ(points[50].t, 0.0);
  World world(*system.table);
  Hits hits;
  add_start(world, Sampler(system), 1, 0);
  world.limit_hits(49);
  world.run_until(1e300, hits);
  ASSERT_EQ(hits.events.size(), 49u);
  for (std::size_t k = 0; k < 49; ++k) {
    EXPECT_EQ(points[51 + k].t, hits.events[k].time.value());
    EXPECT_EQ(points[51 + k].vx, hits.events[k].after.x);
  }
}

TEST(Section, TakesAListOfStarts) {
  const System system = with_section(std::string(ellipse) +
                                         "[particles]\nspeed = 1\n[initial]\nkind = \"list\"\n"
                                         "starts = [[0.1, 0.2, 1, -1], [0, \"1/4\", 0, -3]]\n",
                                     "on = \"y=0\"", 10);
  const auto points = points_of(system);
  ASSERT_GT(points.size(), 8u);
  EXPECT_EQ(points.front().orbit, 0u);
  EXPECT_NEAR(points.front().x, 0.3, 1e-15);
  EXPECT_EQ(points.back().orbit, 1u);
  for (const SectionPoint& p : points) {
    if (p.orbit == 0) continue;
    EXPECT_EQ(p.x, 0.0);
    EXPECT_NEAR(std::abs(p.vy), 1.0, 1e-15) << "the speed is that of [particles]";
    if (p.index == 0) {
      EXPECT_EQ(p.t, 0.25);
    }
  }
}

TEST(Section, SectionOfOneWallSkipsTheOthers) {
  const char* square = "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n";
  const auto all = points_of(with_section(square, "points = 200"));
  const auto top = points_of(with_section(square, "on = \"wall:top\"\npoints = 200"));
  std::size_t expected = 0;
  for (const SectionPoint& p : all) expected += p.wall == 2;
  EXPECT_EQ(top.size(), expected) << "both until t = 100";
  for (const SectionPoint& p : top) EXPECT_EQ(p.wall, 2);
}

// Angular momenta about the foci: their product is a constant of the ellipse; in the circle with a
// field the tangential velocity at the wall is one.
TEST(Section, KeepsTheInvariantsOfIntegrableTables) {
  const double focus = std::sqrt(1 - 0.5625);
  for (const char* on : {"on = \"boundary\"", "on = \"y=0\"", "on = \"line:-1,0.3:1,-0.2\"",
                         "on = \"circle:0,0,0.4\""}) {
    double first = 0;
    for (const SectionPoint& p : points_of(with_section(ellipse, on))) {
      const double left = (p.x + focus) * p.vy - p.y * p.vx,
                   right = (p.x - focus) * p.vy - p.y * p.vx;
      if (p.index == 0) first = left * right;
      EXPECT_NEAR(left * right, first, 1e-12);
    }
  }
  double first = 0;
  for (const SectionPoint& p :
       points_of(with_section(std::string(circle) + "[field]\nB = 0.8\n", "points = 100"))) {
    if (p.index == 0) first = p.v_parallel;
    EXPECT_NEAR(p.v_parallel, first, 1e-12);
  }
}

// Samples so dense that no pair of crossings fits between two of them, or nearly none.
class Samples : public Observer {
 public:
  explicit Samples(const Surface& surface) : surface_(surface) {}
  void sample(int, Time, const State& state) override {
    const bool now = surface_function(surface_, state.position, state.velocity) > 0;
    if (seen_ && now != side_) ++changes[now ? 1 : 0];
    side_ = now;
    seen_ = true;
  }
  int changes[2] = {0, 0};

 private:
  const Surface& surface_;
  bool side_ = false, seen_ = false;
};

TEST(Section, CrossingsAreThoseOfDenseSamples) {
  for (const char* field : {"", "[field]\nlarmor_radius = 0.3\n", "[field]\nB = -1\n"}) {
    for (const char* on :
         {"on = \"x=1/5\"", "on = \"circle:0.1,0,0.3\"", "on = \"line:-1,-1:1,0.5\""}) {
      const System system = with_section(std::string(ellipse) + field, on, 40, 10);
      std::vector<int> up(10), down(10);
      for (const SectionPoint& p : points_of(system)) ++(p.direction > 0 ? up : down)[p.orbit];
      const Sampler sampler(system);
      int differ = 0, all = 0;
      for (std::uint64_t orbit = 0; orbit < 10; ++orbit) {
        World world(*system.table);
        Samples samples(system.section.surface);
        add_start(world, sampler, orbit, 0);
        world.sample_every(1e-3);
        world.run_until(40, samples);
        const std::size_t i = orbit;
        differ += std::abs(samples.changes[1] - up[i]) + std::abs(samples.changes[0] - down[i]);
        all += up[i] + down[i];
        EXPECT_LE(std::abs(up[i] - down[i]), 1) << "they alternate, over reflections too";
      }
      EXPECT_GT(all, 50);
      EXPECT_LE(differ, all / 50) << on << field;
    }
  }
}

TEST(Section, DirectionsAreParts) {
  const auto both = points_of(with_section(ellipse, "on = \"x=0\""));
  const auto positive = points_of(with_section(ellipse, "on = \"x=0\"\ndirection = \"positive\""));
  const auto negative = points_of(with_section(ellipse, "on = \"x=0\"\ndirection = \"negative\""));
  EXPECT_EQ(both.size(), positive.size() + negative.size());
  EXPECT_GT(negative.size(), 100u);
  for (const SectionPoint& p : positive) EXPECT_GT(p.vx, 0);
  for (const SectionPoint& p : negative) EXPECT_LT(p.vx, 0);
}

// Backwards in time, with the field turned round, an orbit meets the section at the same points.
TEST(Section, IsReversible) {
  const char* start =
      "[initial]\nkind = \"point\"\nposition = [0.1, 0.2]\nvelocity = [0.8, 0.6]\n[section]\non = "
      "\"x=0\"\n";
  System there = make_system(std::string(ellipse) + "[field]\nB = 0.7\n" + start);
  there.run.t_max = 40;
  System back = make_system(std::string(ellipse) + "[field]\nB = -0.7\n" + start);
  back.run.t_max = 40;
  World world(*there.table);
  Observer nothing;
  add_start(world, Sampler(there), 0, 0);
  world.run_until(40, nothing);
  const State end = world.state_at(0, Time(40));
  back.initial.position = end.position;
  back.initial.velocity = -end.velocity;
  const auto a = points_of(there), b = points_of(back);
  ASSERT_GT(a.size(), 10u);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const SectionPoint& p = b[b.size() - 1 - k];
    EXPECT_NEAR(a[k].t, 40 - p.t, 1e-9);
    EXPECT_NEAR(a[k].y, p.y, 1e-9);
    EXPECT_EQ(a[k].direction, -p.direction);
  }
}

TEST(Section, CountsEveryTurnOfAPinnedOrbit) {
  System system = with_section(std::string(circle) +
                                   "[field]\nlarmor_radius = 0.25\n[initial]\nkind = \"point\"\n"
                                   "position = [0, 0.25]\nvelocity = [1, 0]\n",
                               "on = \"y=0.1\"\npoints = 100000", 3.14159265358979 * 0.5 * 1000);
  const SectionResult result = run_section(system);
  EXPECT_EQ(result.pinned, 1u);
  EXPECT_EQ(result.points, 2000u) << "two a turn, a thousand turns";
  system.section.points = 7;
  EXPECT_EQ(run_section(system).points, 7u);
}

TEST(Section, GoesOnBehindTheLastWall) {
  const System system = with_section(
      "[table]\nshape = \"discs\"\ncenters = [[0, 0]]\nradius = 1\n[initial]\n"
      "kind = \"point\"\nposition = [-3, 0]\nvelocity = [1, 0]\n",
      "on = \"x=-5\"", 100);
  const auto points = points_of(system);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].t, 6.0, 1e-12);
}

// The same orbits flown and integrated: a splitting scheme with the exact drift is exact but for
// rounding.
TEST(Section, IntegratedMotionHasTheSectionOfFlights) {
  for (const char* field : {"", "[field]\nB = 1.2\n"}) {
    for (const char* on : {"on = \"x=0.1\"", "on = \"circle:0.1,0,0.3\"",
                           "on = \"segment:-0.5,-0.2:0.5,0.4\"", "on = \"vy=0.1\""}) {
      System system = with_section(std::string(ellipse) + field, on, 8, 10);
      const auto flown = points_of(system);
      system.dynamics.everywhere = true;
      system.dynamics.integrator.step = 0.05;
      const auto integrated = points_of(system);
      if (std::string(on) != "on = \"vy=0.1\"" || *field) {
        EXPECT_GT(flown.size(), 10u);
      }
      ASSERT_EQ(flown.size(), integrated.size()) << on << field;
      for (std::size_t k = 0; k < flown.size(); ++k) {
        EXPECT_EQ(flown[k].direction, integrated[k].direction);
        EXPECT_NEAR(flown[k].t, integrated[k].t, 1e-9);
        EXPECT_NEAR(flown[k].s, integrated[k].s, 1e-9);
        EXPECT_NEAR(flown[k].v_parallel, integrated[k].v_parallel, 1e-9);
      }
    }
  }
}

TEST(Section, ALatticeHasItsSectionInThePlane) {
  System system = with_section("[table]\nshape = \"lorentz\"\nspacing = 2.2\nradius = 1\n",
                               "on = \"x=1.5\"", 8);
  system.section.orbits = 300;
  const auto flown = points_of(system);
  EXPECT_GT(flown.size(), 40u);
  double farthest = 0;
  for (const SectionPoint& p : flown) {
    EXPECT_NEAR(p.x, 1.5, 1e-14);
    farthest = std::max(farthest, std::abs(p.y));
  }
  EXPECT_GT(farthest, 1.5) << "beyond the first cell";
  system.dynamics.everywhere = true;
  system.dynamics.integrator.step = 0.05;
  const auto integrated = points_of(system);
  ASSERT_EQ(flown.size(), integrated.size());
  for (std::size_t k = 0; k < flown.size(); ++k) EXPECT_NEAR(flown[k].s, integrated[k].s, 1e-4);
}

// Henon and Heiles: every point of the section lies on it, and on the energy shell of its orbit.
TEST(Section, ASoftSystemKeepsItsEnergy) {
  const System system = with_section(R"(
[table]
shape = "plane"
[[potential]]
kind = "henon-heiles"
[particles]
energy = "1/8"
[initial]
kind = "list"
starts = [[0, 0, 1, 0.2], [0, 0.1, 1, 0], [0, -0.2, 1, 0.1]]
[integrator]
step = 0.05
)",
                                     "on = \"x=0\"", 600);
  double first = 0;
  const auto points = points_of(system);
  EXPECT_GT(points.size(), 500u);
  for (const SectionPoint& p : points) {
    const double energy = 0.5 * (p.vx * p.vx + p.vy * p.vy) + 0.5 * p.y * p.y - p.y * p.y * p.y / 3;
    if (p.index == 0) first = energy;
    EXPECT_NEAR(energy, first, 1e-12);
    EXPECT_NEAR(p.x, 0.0, 1e-15);
    EXPECT_EQ(p.direction, p.vx > 0 ? 1 : -1);
  }
}

TEST(Section, WatchingChangesNoBit) {
  for (const bool everywhere : {false, true}) {
    System system =
        with_section("[table]\nshape = \"lorentz\"\nspacing = 2.2\nradius = 1\n[field]\nB = 0.3\n",
                     "on = \"circle:1.1,0.6,0.5\"", 30);
    system.dynamics.everywhere = everywhere;
    system.dynamics.integrator.step = 0.05;
    const Sampler sampler(system);
    Observer nothing;
    State ends[2];
    for (const bool watched : {false, true}) {
      World world(*system.table, system.dynamics);
      add_start(world, sampler, 3, 0);
      if (watched) world.watch(&system.section.surface);
      world.run_until(30, nothing);
      ends[watched] = world.state_at(0, Time(30));
    }
    EXPECT_EQ(ends[0].position, ends[1].position);
    EXPECT_EQ(ends[0].velocity, ends[1].velocity);
    EXPECT_EQ(ends[0].cell, ends[1].cell);
  }
}

// Whichever block it is at which the disk is full: every thread ends, and nothing more is written.
TEST(Section, ErrorsLeaveTheThreads) {
  const System system = with_section(ellipse, "on = \"x=0\"\npoints = 2", 1000, 96);
  for (const int threads : {1, 2, 3, 8})
    for (int k = 0; k < 7; ++k) {
      int calls = 0;
      SectionOptions options;
      options.threads = threads;
      options.points = [&](const std::vector<SectionPoint>&) {
        if (++calls > k) throw InputError("the disk is full");
      };
      EXPECT_THROW(run_section(system, options), InputError);
      EXPECT_EQ(calls, k + 1);
    }
}

// Nothing that happens after the last point belongs to the section.
TEST(Section, EndsWithTheLastPoint) {
  for (const char* on : {"on = \"boundary\"", "on = \"x=0.1\""}) {
    System system = with_section(
        "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n"
        "[[table.hole]]\nwall = \"bottom\"\ncenter = 0.5\nwidth = 0.5\n",
        std::string(on) + "\npoints = 1", 1000, 100);
    const SectionResult result = run_section(system, {});
    EXPECT_EQ(result.points + result.incomplete, 50u);
    // The flight with the last point may end in the hole.
    EXPECT_LE(result.incomplete, result.escaped);
    EXPECT_LE(result.escaped, result.incomplete + 3);
    EXPECT_GT(result.points, 10u);
    if (system.section.boundary) {
      EXPECT_EQ(result.collisions, result.points);
    }
    EXPECT_LT(result.collisions, 250u);
  }
}

}  // namespace
}  // namespace carom
