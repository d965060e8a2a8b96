// Quasi-random starts: the sequence, where its points lie, and the errors of what they estimate.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/escape/decay.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/base/error.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"
#include "starts/cover.hpp"
#include "starts/sobol.hpp"

namespace carom {
namespace {

using geometry::Vector;
using starts::Cover;
using starts::Sobol;

// How many points of a block each dyadic box has whose sides are 2^-digits: one number at least for
// each box.
std::map<std::array<int, 3>, int> count(const Sobol& sequence, std::uint64_t first,
                                        std::uint64_t last, std::array<int, 3> digits) {
  std::map<std::array<int, 3>, int> boxes;
  for (std::uint64_t i = first; i < last; ++i) {
    const Sobol::Point point = sequence.point(i);
    std::array<int, 3> box{};
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_TRUE(point[d] >= 0.0 && point[d] < 1.0);
      box[d] = static_cast<int>(std::ldexp(point[d], digits[d]));
    }
    ++boxes[box];
  }
  return boxes;
}

TEST(Sobol, EveryElementaryBoxHasItsShareOfABlock) {
  for (const std::uint64_t seed : {1u, 2u})
    for (const std::uint64_t block : {std::uint64_t{0}, std::uint64_t{5}, std::uint64_t{1} << 40}) {
      const Sobol sequence(seed, 3 + seed);
      constexpr int m = 7;
      const std::uint64_t size = 1 << m, first = block * size;
      for (int a = 0; a < m; ++a)
        for (int b = 0; a + b < m; ++b) {
          const auto boxes = count(sequence, first, first + size, {a, b, m - 1 - a - b});
          EXPECT_EQ(boxes.size(), size / 2);
          for (const auto& [box, points] : boxes) EXPECT_EQ(points, 2) << a << ' ' << b;
        }
      // Of the first two dimensions alone each has one.
      for (int a = 0; a <= m; ++a)
        EXPECT_EQ(count(sequence, first, first + size, {a, m - a, 0}).size(), size) << a;
    }
}

TEST(Sobol, EachPointIsUniformOverSeedsAndReplicates) {
  constexpr int seeds = 4000, bins = 8;
  std::array<std::array<int, bins>, 3> counts{};
  for (int seed = 0; seed < seeds; ++seed) {
    const Sobol::Point point =
        Sobol(static_cast<std::uint64_t>(seed / 16), static_cast<std::uint64_t>(seed % 16))
            .point(12345);
    for (std::size_t d = 0; d < 3; ++d) ++counts[d][static_cast<std::size_t>(point[d] * bins)];
  }
  for (const auto& of_dimension : counts)
    for (const int n : of_dimension)
      EXPECT_NEAR(n, seeds / bins, 4.0 * std::sqrt(double{seeds} / bins));
}

System with(const std::string& text, std::uint64_t trajectories = 1 << 15) {
  System system = make_system(text + "[initial]\nkind = \"sobol\"\n");
  system.run.trajectories = trajectories;
  return system;
}

const char* const mushroom =
    "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1\nstem_height = 1\n";
const char* const circle = "[table]\nshape = \"circle\"\nradius = 1\n";
const char* const lorentz =
    "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1\n";
// All of the right side is open: of the starts, uniform in the square and in direction, a share
// t/pi has left by t <= 1 (the mean of max(0, t cos)).
const char* const open_side =
    "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[[table.hole]]\nwall = "
    "\"right\"\ncenter = 0.5\nwidth = 1\n[run]\nt_max = 0.5\ntimes = [0.5]\n";
constexpr double left_by_half = 0.5 / 3.141592653589793;

// Starts of which something is true, by replicate.
template <class Is>
std::vector<Portion> portions(const System& system, Is is) {
  const Sampler sampler(system);
  const World world(*system.table);
  std::vector<Portion> parts(replicates);
  for (std::uint64_t i = 0; i < system.run.trajectories; ++i) {
    const State start = sampler.draw(world, i, 0);
    EXPECT_TRUE(world.contains(start.position));
    EXPECT_EQ(start.cell, geometry::Cell{});
    Portion& part = parts[i % replicates];
    ++part.trials;
    part.successes += is(start);
  }
  return parts;
}

// Also beside walls, where the cells of the cover end: within a thousandth of the radius.
TEST(QuasiRandom, StartsAreUniformUpToTheWalls) {
  const auto expect_share = [](const System& system, double share, auto is) {
    const Interval found = replicate_interval(portions(system, is));
    EXPECT_LE(found.low, share);
    EXPECT_GE(found.high, share);
    EXPECT_LT(found.high - found.low, 0.25 * share);
  };
  const auto beyond = [](double r) {
    return [r](const State& s) { return dot(s.position, s.position) > r * r; };
  };
  expect_share(with(circle, 1 << 18), 1.0 - 0.999 * 0.999, beyond(0.999));
  expect_share(with(circle), 1.0 - 0.81, beyond(0.9));
  const double half_pi = 1.5707963267948966, cell = 2.2 * 2.2 * std::sqrt(0.75);
  expect_share(with(mushroom), 1.0 / (1.0 + half_pi),
               [](const State& s) { return s.position.y < 0; });
  expect_share(with(lorentz, 1 << 18), 0.002001 * 2 * half_pi / (cell - 2 * half_pi),
               [](const State& s) { return dot(s.position, s.position) < 1.001 * 1.001; });
  expect_share(with(mushroom), 0.1, [half_pi](const State& s) {
    return std::fabs(s.velocity.y) < std::sin(0.1 * half_pi);
  });
}

TEST(QuasiRandom, FewStartsMissTheTable) {
  const System system = with(mushroom);
  std::vector<geometry::CurveFrame> edges;
  for (const Wall& wall : system.table->walls) edges.push_back(geometry::frame_of(wall.curve));
  const World world(*system.table);
  const Cover cover({{-1, -1}, {1, 1}}, edges, [&](Vector x) { return world.contains(x); });
  int missed = 0;
  constexpr int across = 300;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j)
      missed += !world.contains(cover.point((i + 0.5) / across, (j + 0.5) / across));
  EXPECT_LT(missed, 0.01 * across * across);
}

// The share of phase space that is regular (Bunimovich 2001): lines of the cap that keep farther
// from its centre than half the stem's width.
TEST(QuasiRandom, ErrorsFallFasterThanThoseOfRandomStarts) {
  const auto regular = [](const State& s) {
    return s.position.y > 0 && std::fabs(cross(s.position, s.velocity)) > 0.5;
  };
  double squares = 0.0;
  constexpr int seeds = 25;
  constexpr double share = 0.2389084047, n = 1 << 13;
  for (int seed = 1; seed <= seeds; ++seed) {
    System system = with(mushroom, 1 << 13);
    system.run.seed = static_cast<std::uint64_t>(seed);
    double found = 0.0;
    for (const Portion& part : portions(system, regular))
      found += static_cast<double>(part.successes);
    squares += (found / n - share) * (found / n - share);
  }
  // Measured: 0.4 times the binomial error.
  EXPECT_LT(std::sqrt(squares / seeds), 0.5 * std::sqrt(share * (1.0 - share) / n));
}

TEST(QuasiRandom, IntervalsOfAnEnsembleHoldTheTruth) {
  int held = 0, exits_held = 0;
  constexpr int seeds = 100;
  EscapeOptions how;
  how.threads = 1;
  double width = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    System system = with(open_side, 4096);
    system.run.seed = static_cast<std::uint64_t>(seed);
    const SurvivalCounts counts = run_escape(system, how).counts;
    const SurvivalPoint p = survival(counts).back();
    const ExitPoint exit = exits(counts).front();
    held += p.low <= 1.0 - left_by_half && 1.0 - left_by_half <= p.high;
    exits_held += exit.low <= left_by_half && left_by_half <= exit.high;
    width += (p.high - p.low) / seeds;
  }
  // 95 are to be expected, and 88 or fewer with a probability of 0.4 %.
  EXPECT_GT(held, 88);
  EXPECT_EQ(exits_held, held);
  const Interval random = wilson_interval(652, 4096);
  EXPECT_LT(width, 0.4 * (random.high - random.low));
}

TEST(QuasiRandom, TheChaoticShareHasItsErrorFromReplicates) {
  System system = with(mushroom, 4096);
  system.run.t_max = 1500;
  const LyapunovResult result = run_lyapunov(system);
  const LyapunovEstimate e = estimate_of(result.growth);
  EXPECT_NEAR(e.chaotic_share.value, 1.0 - 0.2389084047, 4.0 * e.chaotic_share.error);
  // Most of it is what is not known of orbits that stick.
  EXPECT_LT(e.chaotic_share.error, 0.65 * std::sqrt(0.24 * 0.76 / 4096));
  EXPECT_LE(e.share_interval.low, 1.0 - 0.2389084047);
  EXPECT_GE(e.share_interval.high, 1.0 - 0.2389084047);
  EXPECT_GT(e.per_time.error, 0.0);
  EXPECT_TRUE(e.block_errors.empty());
}

TEST(QuasiRandom, WhatTakesIndependentStartsIsRefused) {
  System system = with(open_side, 4096);
  EXPECT_THROW(run_diffusion(system), InputError);
  const EscapeResult result = run_escape(system);
  EXPECT_NE(decay_of(system, result).why_none, "");
  EXPECT_NE(fit_decay_by_hits(result.counts).why_none, "");
  system.particles.push_back(system.particles.front());
  EXPECT_THROW(run_escape(system), InputError);
}

}  // namespace
}  // namespace carom
