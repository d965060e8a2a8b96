// The front door: from a table made in code to results.
#include "carom/analyses/all.hpp"

#include <gtest/gtest.h>

#include "carom/engines/trajectories.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

constexpr const char* text =
    "[table]\nshape = \"polygon\"\npoints = [[0, 0], [2, 0], [2, 1], [0, 1]]\n"
    "[[table.hole]]\nwall = \"side_1\"\ncenter = 1\nwidth = 0.2\n"
    "[[table.obstacle]]\nshape = \"circle\"\ncenter = [1, 0.5]\nradius = 0.2\n"
    "[run]\nt_max = 50\ntrajectories = 300\nseed = 7\n";

MadeTable table() {
  return polygon({{0, 0}, {2, 0}, {2, 1}, {0, 1}})
      .hole("side_1", {.center = 1, .width = "0.2"_exact})
      .obstacle(disc({1, 0.5}, "0.2"_exact));
}

TEST(Analyses, ATableMadeInCodeGivesTheResultsOfItsFile) {
  const System made = make_system(table(), {.t_max = 50, .trajectories = 300, .seed = 7});
  const System read = read_system(text, "test.toml").system;
  EXPECT_EQ(made.run.times, read.run.times);
  const EscapeResult escaped = escape(made), expected = escape(read);
  EXPECT_EQ(escaped.digest, expected.digest);
  EXPECT_GT(escaped.counts.escaped, 100u);
  EXPECT_EQ(diffusion(made).digest, diffusion(read).digest);
  EXPECT_EQ(run(made).collisions, run(read).collisions);
}

// Particles between an obstacle and walls fly in lanes as they do one by one.
TEST(Analyses, ObstaclesFlyTheSameOnBothEngines) {
  System system = make_system(table()
                                  .obstacle(elliptic_disc({0.4, 0.5}, 0.2, 0.1, "pi/5"_exact))
                                  .obstacle(block({{1.5, 0.5}, {1.75, 0.5}, {1.75, 0.75}})),
                              {.t_max = 50, .trajectories = 300});
  for (const double omega : {0.0, 1.5}) {
    system.particles[0].omega = omega;
    EscapeOptions one_by_one;
    one_by_one.lanes.reset();
    EXPECT_EQ(escape(system).digest, escape(system, one_by_one).digest);
  }
}

TEST(Analyses, ASectionHasItsPoints) {
  System system = make_system(stadium(1, 1));
  system.section.points = 20;
  system.section.orbits = 3;
  std::size_t given = 0;
  SectionOptions options;
  options.points = [&](const std::vector<SectionPoint>& points) { given += points.size(); };
  const SectionWithPoints result = section(system, options);
  EXPECT_EQ(result.points, 60u);
  EXPECT_EQ(result.list.size(), 60u);
  EXPECT_EQ(given, 60u);
  EXPECT_EQ(result.list.back().orbit, 2u);
}

TEST(Analyses, ImpossibleRunsAreRefused) {
  EXPECT_THROW(make_system(circle(1), {.t_max = 0}), InputError);
}

}  // namespace
}  // namespace carom
