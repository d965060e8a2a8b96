// The velocity autocorrelation and its integral, summed beside the displacements.
#include <gtest/gtest.h>

#include <cmath>

#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"

namespace carom {
namespace {

std::vector<MomentPoint> points_of(const System& system, const DiffusionOptions& how = {}) {
  return DisplacementMoments(run_diffusion(system, how).sums).points();
}

// Among discs that no circle meets, all velocities turn alike: C(t) = v^2 cos(wt), and its integral
// is v^2 sin(wt)/w, whatever the cell that the particle is in.
TEST(VelocityCorrelation, TurnsWithTheFieldWhereNothingIsHit) {
  System system = make_system(
      "[table]\nshape = \"lorentz\"\nlattice = \"square\"\nspacing = 1\nradius = 0.1\n"
      "[field]\nB = 5\n[particles]\nspeed = 0.75\n"
      "[initial]\nkind = \"rectangle\"\nmin = [0.4, 0.4]\nmax = [0.6, 0.6]\n"
      "[run]\nt_max = 40\ntimes = [0, 0.1, 0.7, 3, 40]\ntrajectories = 300\n");
  for (const bool lanes : {false, true}) {
    DiffusionOptions how;
    if (!lanes) how.lanes.reset();
    for (const MomentPoint& p : points_of(system, how)) {
      EXPECT_NEAR(p.correlation.value, 0.5625 * std::cos(5 * p.t), 1e-12) << p.t;
      EXPECT_NEAR(p.green_kubo.value, 0.5625 * std::sin(5 * p.t) / 10, 1e-12) << p.t;
      EXPECT_LT(p.correlation.error, 1e-12);
    }
  }
}

// Uniform starts are stationary: <v(0).(r(t) - r(0))> is half the slope of the MSD. Error bars are
// the scatter over the groups, as the differences of one group are correlated.
TEST(VelocityCorrelation, IntegratesToAQuarterOfTheSlope) {
  struct Case {
    const char* toml;
    double h;  // of the central difference
  };
  const Case cases[] = {
      {"[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1\n", 0.02},
      {"[table]\nshape = \"lorentz\"\nlattice = \"square\"\nspacing = 1\nradius = 0.4\n"
       "[field]\nB = 0.7\n[particles]\nspeed = 2\n",
       0.005},
      {"[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n", 0.02}};
  for (const Case& one : cases) {
    System system = make_system(one.toml);
    system.run.trajectories = 40'000;
    const double times[] = {0.3, 1, 4};
    system.run.times.clear();
    for (const double t : times)
      system.run.times.insert(system.run.times.end(), {t - one.h, t, t + one.h});
    system.run.t_max = system.run.times.back();
    const DisplacementSums sums = run_diffusion(system).sums;
    for (std::size_t i = 0; i < std::size(times); ++i) {
      double mean = 0, square = 0, size = 0;
      for (std::size_t g = 0; g < DisplacementSums::groups; ++g) {
        const auto& before = sums.of(g, 3 * i);
        const auto& at = sums.of(g, 3 * i + 1);
        const auto& after = sums.of(g, 3 * i + 2);
        const auto n = static_cast<double>(at.count);
        const double slope = (after.square.value() - before.square.value()) / (2 * one.h * n);
        const double off = slope - 2 * at.along.value() / n;
        mean += off, square += off * off, size += slope;
      }
      constexpr double m = DisplacementSums::groups;
      mean /= m;
      const double error = std::sqrt((square / m - mean * mean) / (m - 1));
      EXPECT_LT(error, 0.03 * std::abs(size / m) + 0.02);
      EXPECT_NEAR(mean, 0.0, 4 * error) << one.toml << times[i];
    }
  }
}

// At t = 0 it is v^2; until the first hits of a short time it falls by what these turn.
TEST(VelocityCorrelation, BeginsAtTheSquareOfTheSpeed) {
  System system = make_system(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[particles]\nspeed = 3\n"
      "[run]\nt_max = 1\ntimes = [0, 0.01]\ntrajectories = 40000\n");
  const auto points = points_of(system);
  EXPECT_NEAR(points[0].correlation.value, 9, 1e-12);
  EXPECT_EQ(points[0].green_kubo.value, 0.0);
  // A hit on a straight wall turns v . v(0) by 2 v_n^2. Hits come at the rate (L/A) v/pi, and those
  // have <v_n^2> = 2 v^2/3.
  const double rate = 4 * 3 / 3.141592653589793;
  EXPECT_NEAR(points[1].correlation.value, 9 - 0.01 * rate * 2 * 6,
              4 * points[1].correlation.error);
}

}  // namespace
}  // namespace carom
