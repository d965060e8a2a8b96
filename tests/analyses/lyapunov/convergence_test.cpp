// The exponent at growing times.
#include <gtest/gtest.h>

#include <cmath>

#include "analyses/systems.hpp"
#include "carom/analyses/lyapunov.hpp"

namespace carom {
namespace {

std::vector<ExponentAt> exponents(double t_max, int orbits, const std::string& more = "") {
  return convergence_of(run_lyapunov(make_system(
      "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n" + more +
      "[run]\nt_max = " + std::to_string(t_max) + "\ntrajectories = " + std::to_string(orbits) +
      "\nwindow = [0, " + std::to_string(t_max) + "]\n")));
}

// What was true at a time does not depend on how long the run went on.
TEST(Convergence, OfALongerRunHoldsThatOfAShorterOne) {
  for (const int orbits : {3, 100}) {
    const auto brief = exponents(50, orbits), more = exponents(200, orbits);
    std::size_t shared = 0, wanted = 0;
    for (const ExponentAt& one : brief) {
      wanted += one.t >= more.front().t;
      for (const ExponentAt& other : more)
        if (one.t == other.t) {
          EXPECT_EQ(one.lambda, other.lambda);
          ++shared;
        }
    }
    EXPECT_EQ(shared, wanted);
    EXPECT_GE(shared, 6u);
  }
}

TEST(Convergence, EndsWithTheGrowthOfTheWholeRun) {
  for (const int orbits : {3, 100}) {
    const System system = make_system(
        "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n"
        "[run]\nt_max = 300\nwindow = [0, 300]\ntrajectories = " +
        std::to_string(orbits) + "\n");
    const LyapunovResult result = run_lyapunov(system);
    const auto all = convergence_of(result);
    const Estimate whole = mean_growth_of(result.growth).per_time;
    EXPECT_EQ(all.back().t, 300.0);
    EXPECT_NEAR(all.back().lambda, whole.value, 1e-12);
    if (orbits < 16)
      EXPECT_TRUE(std::isnan(all.back().error));
    else
      EXPECT_NEAR(all.back().error, whole.error, 1e-12);
  }
}

TEST(Convergence, OfQuasiRandomStartsHasNoErrors) {
  const auto all = exponents(50, 128, "[initial]\nkind = \"sobol\"\n");
  ASSERT_FALSE(all.empty());
  for (const ExponentAt& one : all) EXPECT_TRUE(std::isnan(one.error));
}

}  // namespace
}  // namespace carom
