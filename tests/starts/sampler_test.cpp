#include "carom/starts/sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "analyses/systems.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"

namespace carom {
namespace {

using geometry::Vector;

constexpr int many = 20000;

struct Drawn {
  explicit Drawn(const std::string& toml)
      : system(make_system(toml)), world(*system.table), sampler(system) {}
  State operator()(std::uint64_t trajectory, int particle = 0) const {
    return sampler.draw(world, trajectory, particle);
  }
  System system;
  World world;
  Sampler sampler;
};

// Pearson's statistic of `value` in [0, 1) over equal bins; its mean is bins - 1.
double chi_squared(const std::function<double(std::uint64_t)>& value, int bins = 20) {
  std::vector<double> counts(static_cast<std::size_t>(bins), 0.0);
  for (int i = 0; i < many; ++i) {
    const double x = value(static_cast<std::uint64_t>(i));
    EXPECT_GE(x, 0.0);
    EXPECT_LE(x, 1.0);
    const auto bin = static_cast<std::size_t>(x * bins);
    counts[std::min(bin, counts.size() - 1)] += 1.0;
  }
  const double expected = static_cast<double>(many) / bins;
  double sum = 0.0;
  for (const double n : counts) sum += (n - expected) * (n - expected) / expected;
  return sum;
}
constexpr double rare = 45.0;  // 19 degrees of freedom: p = 7e-4

double angle_share(Vector v) { return std::atan2(v.y, v.x) / 6.283185307179586 + 0.5; }

const char* mushroom = R"(
[table]
shape = "mushroom"
cap_radius = 1
stem_width = 1
stem_height = 1
[particles]
speed = 2.5
[initial]
)";

/// A table alone is a system, for `carom table`; what flies needs starts.
TEST(Sampler, OfTheOpenPlaneNeedsAKindOfStart) {
  const std::string discs = "[table]\nshape = \"discs\"\ncenters = [[0, 0]]\nradius = 1\n";
  const System system = make_system(discs);
  EXPECT_THROW(Sampler{system}, InputError);
  EXPECT_THROW(make_system(discs + "[initial]\nkind = \"uniform\"\n"), InputError);
}

TEST(Sampler, UniformFillsTheTableByArea) {
  const Drawn draw(std::string(mushroom) + "kind = \"uniform\"");
  int stem = 0;
  for (int i = 0; i < many; ++i) {
    const State s = draw(static_cast<std::uint64_t>(i));
    EXPECT_TRUE(draw.world.contains(s.position));
    EXPECT_EQ(s.wall, -1);
    EXPECT_NEAR(std::sqrt(dot(s.velocity, s.velocity)), 2.5, 1e-15);
    stem += s.position.y < 0;
  }
  const double share = 1.0 / (1.0 + 1.5707963267948966);
  EXPECT_NEAR(stem / double{many}, share, 4 * std::sqrt(share * (1 - share) / many));
  EXPECT_LT(chi_squared([&](std::uint64_t i) { return angle_share(draw(i).velocity); }), rare);
}

TEST(Sampler, UniformInALatticeStaysInItsCell) {
  const Drawn draw(R"(
[table]
shape = "lorentz"
lattice = "triangular"
spacing = 2.2
radius = 1
[initial]
kind = "uniform"
)");
  // By the symmetry of the cell each sixth of it is as likely; none lies in the disc.
  EXPECT_LT(chi_squared(
                [&](std::uint64_t i) {
                  const State s = draw(i);
                  EXPECT_GT(dot(s.position, s.position), 1.0);
                  EXPECT_EQ(s.cell, geometry::Cell{});
                  return angle_share(s.position);
                },
                6),
            25.0);
}

TEST(Sampler, IsAFunctionOfSeedTrajectoryAndParticle) {
  const Drawn draw(std::string(mushroom) + "kind = \"uniform\"\n[run]\nseed = 4");
  const Drawn same(std::string(mushroom) + "kind = \"uniform\"\n[run]\nseed = 4");
  const Drawn other(std::string(mushroom) + "kind = \"uniform\"\n[run]\nseed = 5");
  const State late = draw(1'000'000'000'000);
  draw(7);
  EXPECT_EQ(late.position, same(1'000'000'000'000).position);
  EXPECT_EQ(late.velocity, same(1'000'000'000'000).velocity);
  EXPECT_NE(late.position, other(1'000'000'000'000).position);
  EXPECT_NE(late.position, draw(1'000'000'000'001).position);
}

class Boundary : public testing::TestWithParam<const char*> {};

TEST(Sampler, ManyAtOnceAreThoseOneByOne) {
  const char* const systems[] = {
      R"toml(table = { shape = "rectangle", width = 1, height = 1 })toml",
      R"toml(table = { shape = "stadium", radius = 1, half_length = 1 }
particles = { speed = 3 })toml",
      R"toml(table = { shape = "lorentz", lattice = "triangular", spacing = 2.2, radius = 1 })toml",
      R"toml(table = { shape = "mushroom", cap_radius = 1, stem_width = 0.5, stem_height = 1 }
initial = { kind = "rectangle", min = [-2, -2], max = [0.5, 2] })toml",
      R"toml(table = { shape = "circle", radius = 1 }
initial = { kind = "boundary" })toml",
      R"toml(table = { shape = "circle", radius = 1 }
particles = { energy = 1 }
[[potential]]
kind = "harmonic"
omega = 1)toml"};
  for (const char* const toml : systems) {
    SCOPED_TRACE(toml);
    const Drawn drawn(toml);
    std::vector<State> states(300);
    drawn.sampler.draw_several(drawn.world, 7, states);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const State one = drawn(7 + i);
      EXPECT_EQ(states[i].wall, one.wall);
      EXPECT_EQ(states[i].u, one.u);
      EXPECT_EQ(states[i].position, one.position);
      EXPECT_EQ(states[i].velocity, one.velocity);
      EXPECT_EQ(states[i].cell, one.cell);
      EXPECT_EQ(states[i].time, one.time);
    }
  }
}

TEST_P(Boundary, FollowsTheCosineLaw) {
  const Drawn draw(std::string(GetParam()) + "[initial]\nkind = \"boundary\"\n");
  const Table& table = *draw.system.table;
  std::vector<double> before{0.0};
  for (const Wall& wall : table.walls)
    before.push_back(before.back() + geometry::length(wall.curve));
  EXPECT_LT(chi_squared([&](std::uint64_t i) {
              const State s = draw(i);
              const auto wall = static_cast<std::size_t>(s.wall);
              const geometry::Curve& curve = table.walls[wall].curve;
              EXPECT_EQ(s.position, geometry::point_at(curve, s.u));
              EXPECT_GT(dot(s.velocity, geometry::normal_at(curve, s.u)), 0.0);
              return (before[wall] + geometry::arc_length_at(curve, s.u)) / before.back();
            }),
            rare);
  EXPECT_LT(chi_squared([&](std::uint64_t i) {
              const State s = draw(i);
              const geometry::Curve& curve = table.walls[static_cast<std::size_t>(s.wall)].curve;
              return (dot(s.velocity, geometry::tangent_at(curve, s.u)) + 1.0) / 2.0;
            }),
            rare);
}
INSTANTIATE_TEST_SUITE_P(
    Tables, Boundary,
    testing::Values("[table]\nshape = \"stadium\"\nhalf_length = 0.7\nradius = 1\n",
                    "[table]\nshape = \"ellipse\"\na = 3\nb = 1\n",
                    "[table]\nshape = \"lemon\"\nradius = 1\nseparation = 1.2\n",
                    "[table]\nshape = \"sinai\"\nside = 1\nradius = 0.3\ntorus = false\n"));

TEST(Sampler, HoleStartsInItsOpening) {
  const Drawn draw(R"(
[table]
shape = "ellipse"
a = 2
b = 1
[[table.hole]]
wall = "ellipse"
center = 3
width = 0.5
[initial]
kind = "hole"
hole = "hole_1"
)");
  const geometry::Curve& curve = draw.system.table->walls[0].curve;
  EXPECT_LT(chi_squared([&](std::uint64_t i) {
              return (geometry::arc_length_at(curve, draw(i).u) - 2.75 + 1e-13) / (0.5 + 2e-13);
            }),
            rare);
}

TEST(Sampler, HoleAcrossTheStartOfAClosedWallIsOneOpening) {
  const std::string table = R"(
[table]
shape = "circle"
radius = 1
[[table.hole]]
wall = "circle"
center = 0.1
width = 0.5
name = "gap"
[[table.hole]]
wall = "circle"
center = 3
width = 0.5
)";
  // By either kind of start, the arc lengths fill [-0.15, 0.35) evenly.
  for (const char* initial : {"[initial]\nkind = \"hole\"\nhole = \"gap\"\n",
                              "[initial]\nkind = \"boundary\"\nhole = \"gap\"\n"}) {
    const Drawn draw(table + initial);
    const geometry::Curve& curve = draw.system.table->walls[0].curve;
    EXPECT_LT(chi_squared([&](std::uint64_t i) {
                const double s = geometry::arc_length_at(curve, draw(i).u);
                return ((s > 3.2 ? s - geometry::length(curve) : s) + 0.15 + 1e-13) / (0.5 + 2e-13);
              }),
              rare);
  }
}

TEST(Sampler, BirkhoffStartsWhereItIsTold) {
  const Drawn draw(R"(
[table]
shape = "circle"
radius = 2
[particles]
speed = 3
[initial]
kind = "birkhoff"
wall = "circle"
s = [1, 2, 7.5]
v_parallel = [0, -1.5, 2.9]
)");
  const geometry::Curve& curve = draw.system.table->walls[0].curve;
  const double s[] = {1, 2, 7.5}, v[] = {0, -1.5, 2.9};
  for (std::uint64_t i = 0; i < 6; ++i) {
    const State state = draw(i);
    EXPECT_NEAR(geometry::arc_length_at(curve, state.u), s[i % 3], 1e-14);
    EXPECT_NEAR(dot(state.velocity, geometry::tangent_at(curve, state.u)), v[i % 3], 2e-15);
    EXPECT_NEAR(dot(state.velocity, state.velocity), 9.0, 4e-15);
  }
}

TEST(Sampler, BirkhoffStartsRunOnOverWallsThatAreNumbered) {
  const Drawn draw(R"(
[table]
shape = "regular"
sides = 4
radius = 1
[initial]
kind = "birkhoff"
wall = "side"
s = ["sqrt(2)/2", "sqrt(2)*5/2"]
v_parallel = 0
)");
  EXPECT_NEAR(length(draw(0).position - Vector{0.5, 0.5}), 0.0, 1e-15);
  EXPECT_NEAR(length(draw(1).position - Vector{-0.5, -0.5}), 0.0, 1e-15);
  const Drawn some(R"(
[table]
shape = "rectangle"
width = 1
height = 1
[[table.obstacle]]
shape = "polygon"
name = "wedge"
points = [[0.2, 0.2], [0.4, 0.2], [0.3, 0.4]]
[initial]
kind = "boundary"
wall = "wedge_side"
)");
  for (std::uint64_t i = 0; i < 100; ++i)
    EXPECT_TRUE(some.system.table->wall(some(i).wall).name.starts_with("wedge_side_"));
}

TEST(Sampler, PointIsTakenDigitForDigit) {
  const Drawn draw(R"(
[table]
shape = "lorentz"
lattice = "square"
spacing = 1
radius = "1/3"
[initial]
kind = "point"
position = ["1/2", "1/10"]
velocity = [1, 0]
)");
  const State s = draw(3);
  EXPECT_EQ(s.position, (Vector{0.5, 0.1}));
  EXPECT_EQ(s.velocity, (Vector{1.0, 0.0}));
  EXPECT_EQ(s.cell, geometry::Cell{});
}

TEST(Sampler, PointFarOutIsFoldedIntoItsCell) {
  const Drawn draw(R"(
[table]
shape = "lorentz"
lattice = "square"
spacing = 1
radius = 0.25
[initial]
kind = "point"
position = [7.375, -3.4375]
velocity = [0, 2]
)");
  const State s = draw(0);
  EXPECT_EQ(s.position + draw.system.table->lattice->translation(s.cell), (Vector{7.375, -3.4375}));
  EXPECT_LE(std::abs(s.position.x), 0.5);
  EXPECT_LE(std::abs(s.position.y), 0.5);
}

TEST(Sampler, RectangleAndLineKeepToTheTable) {
  const Drawn box(std::string(mushroom) + "kind = \"rectangle\"\nmin = [-2, -0.5]\nmax = [0, 2]");
  const Drawn line(std::string(mushroom) +
                   "kind = \"line\"\nfrom = [-2, 0.5]\nto = [2, 0.5]\nangle = \"pi/2\"");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const State a = box(i), b = line(i);
    EXPECT_TRUE(box.world.contains(a.position));
    EXPECT_TRUE(a.position.x <= 0 && a.position.y >= -0.5);
    EXPECT_TRUE(line.world.contains(b.position));
    EXPECT_EQ(b.position.y, 0.5);
    EXPECT_EQ(b.velocity, (Vector{0.0, 2.5}));
  }
}

TEST(Sampler, RefusesWhatCannotStart) {
  for (const char* position : {"[0.9, -0.5]", "[0, -1]"}) {  // outside; on a wall
    const Drawn draw(std::string(mushroom) +
                     "kind = \"point\"\nvelocity = [1, 0]\nposition = " + position);
    try {
      draw(0);
      ADD_FAILURE() << position;
    } catch (const InputError& error) {
      EXPECT_EQ(error.place().key, "initial.position");
      EXPECT_EQ(error.place().file, "test");
      EXPECT_GT(error.place().line, 0);
    }
  }
}

TEST(Sampler, ListedPairsGoToOneParticleAfterTheOther) {
  const Drawn draw(R"(
[table]
shape = "circle"
radius = 1
[particles]
count = 2
[initial]
kind = "birkhoff"
wall = "circle"
s = [1, 2, 3, 4, 5]
v_parallel = [0.1, 0.2, 0.3, 0.4, 0.5]
)");
  EXPECT_EQ(listed_trajectories(draw.system), 3u);
  EXPECT_EQ(draw.system.run.trajectories, 3u);
  const geometry::Curve& curve = draw.system.table->walls[0].curve;
  for (std::uint64_t i = 0; i < 6; ++i) {
    const State state = draw(i / 2, static_cast<int>(i % 2));
    EXPECT_NEAR(geometry::arc_length_at(curve, state.u), static_cast<double>(i % 5 + 1), 1e-14);
  }
}

TEST(Sampler, RefusesRegionsBesideTheTable) {
  const char* regions[] = {"kind = \"rectangle\"\nmin = [-2, 1.5]\nmax = [2, 3]",
                           "kind = \"rectangle\"\nmin = [1.5, -3]\nmax = [4, 3]",
                           "kind = \"line\"\nfrom = [-1, -1]\nto = [1, -1]\nangle = 1",
                           "kind = \"line\"\nfrom = [2, 0]\nto = [5, 4]\nangle = 1"};
  for (const char* region : regions)
    EXPECT_THROW(Drawn(std::string(mushroom) + region), InputError) << region;
  // On a wall inside the box, and at a single point: after few tries.
  const Drawn brim(std::string(mushroom) +
                   "kind = \"line\"\nfrom = [0.5, 0]\nto = [1, 0]\nangle = 1");
  EXPECT_THROW(brim(0), InputError);
  const Drawn point(std::string(mushroom) +
                    "kind = \"rectangle\"\nmin = [0.75, -0.5]\nmax = [0.75, -0.5]");
  EXPECT_THROW(point(0), InputError);
  const Drawn inside(std::string(mushroom) +
                     "kind = \"rectangle\"\nmin = [0.25, -0.5]\nmax = [0.25, -0.5]");
  EXPECT_EQ(inside(5).position, (Vector{0.25, -0.5}));
}

}  // namespace
}  // namespace carom
