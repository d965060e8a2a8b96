// Lengths of free flights, between hits and from the start.
#include "carom/analyses/diffusion/free_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analyses/systems.hpp"
#include "carom/analyses/diffusion.hpp"
#include "carom/base/error.hpp"

namespace carom {
namespace {

constexpr double pi = 3.141592653589793;

System counting(const std::string& toml, double t_max, std::uint64_t trajectories) {
  System system = make_system(toml);
  system.run.trajectories = trajectories;
  system.run.t_max = t_max;
  system.run.times = {t_max};
  system.run.free_paths = true;
  return system;
}

const char* triangular =
    "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = 1\n";
const char* square =
    "[table]\nshape = \"lorentz\"\nlattice = \"square\"\nspacing = 1\nradius = 0.4\n";
const char* circle = "[table]\nshape = \"circle\"\nradius = 1\n";

void expect_equal(const FreePathSums& a, const FreePathSums& b) {
  for (std::size_t g = 0; g < FreePathSums::groups; ++g) {
    EXPECT_EQ(a.of(g).between.bins.bins(), b.of(g).between.bins.bins());
    EXPECT_EQ(a.of(g).at_start.bins.bins(), b.of(g).at_start.bins.bins());
    EXPECT_EQ(a.of(g).between.longer, b.of(g).between.longer);
    EXPECT_EQ(a.of(g).at_start.longer, b.of(g).at_start.longer);
    EXPECT_EQ(a.of(g).hits, b.of(g).hits);
    EXPECT_EQ(a.of(g).path.state(), b.of(g).path.state());
  }
}

TEST(FreePaths, AreTheSameInLanesInPartsAndOnThreads) {
  for (const std::string field : {"", "[field]\nB = 0.7\n"}) {
    const System system = counting(square + field, 40, 700);
    DiffusionOptions how;
    how.threads = 1;
    const FreePathSums whole = run_diffusion(system, how).free_paths;
    how.threads = 3;
    how.block = 5;
    expect_equal(run_diffusion(system, how).free_paths, whole);
    how.lanes.reset();
    expect_equal(run_diffusion(system, how).free_paths, whole);
    how.part = {0, 333};
    DiffusionResult part = run_diffusion(system, how);
    how.part = {333, 700};
    ASSERT_TRUE(part.add(run_diffusion(system, how)));
    expect_equal(part.free_paths, whole);
  }
}

// Santalo: pi times area over perimeter, with and without a field.
TEST(FreePaths, HaveTheMeanOfSantalo) {
  const std::string stadium = "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n";
  for (const std::string& toml : {std::string(triangular), stadium, std::string(circle),
                                  stadium + "[field]\nB = 0.2\n[particles]\nspeed = 3\n"}) {
    const System system = counting(toml, 30, 20'000);
    const FreePaths paths = free_paths_of(run_diffusion(system).free_paths);
    EXPECT_LT(paths.mean.error, 0.01 * paths.mean.value);
    EXPECT_NEAR(paths.mean.value, measure(*system.table).mean_flight, 4 * paths.mean.error) << toml;
  }
}

// In a circle all flights of an orbit are equally long. From hit to hit P(l or longer) =
// sqrt(1 - l^2/4), as chords of the cosine law; a flight from a uniform start has the density
// P(l or longer)/mean.
TEST(FreePaths, OfACircleAreItsChords) {
  const System system = counting(circle, 20, 100'000);
  const FreePaths paths = free_paths_of(run_diffusion(system).free_paths);
  const auto longer = [](double l) { return l < 2 ? std::sqrt(1 - l * l / 4) : 0.0; };
  // Its integral from l to 2.
  const auto rest = [](double l) {
    return l < 2 ? pi / 2 - l / 2 * std::sqrt(1 - l * l / 4) - std::asin(l / 2) : 0.0;
  };
  int bins = 0, far = 0;
  for (const FreePathBin& bin : paths.between.bins) {
    EXPECT_NEAR(bin.longer.value, longer(bin.from), 5 * bin.longer.error + 1e-15) << bin.from;
    far += std::abs(bin.longer.value - longer(bin.from)) > 2 * bin.longer.error + 1e-15;
    ++bins;
  }
  for (const FreePathBin& bin : paths.at_start.bins) {
    const double expected = rest(bin.from) / (pi / 2);
    EXPECT_NEAR(bin.longer.value, expected, 5 * bin.longer.error + 1e-15) << bin.from;
    const double density = (rest(bin.from) - rest(std::min(bin.to, 2.0))) / (pi / 2);
    EXPECT_NEAR(bin.density.value * (bin.to - bin.from), density,
                5 * bin.density.error * (bin.to - bin.from));
    far += std::abs(bin.longer.value - expected) > 2 * bin.longer.error + 1e-15;
    ++bins;
  }
  EXPECT_GT(bins, 60);
  EXPECT_LE(far, bins / 6) << "of " << bins;
  EXPECT_EQ(paths.between.longer, 0u);
}

// Flights drawn from power laws: exponents and amplitudes scatter about the true ones as their
// errors say.
TEST(FreePaths, HaveExponentsWithHonestErrors) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double exponent = 0, amplitude = 0, far = 0;
  constexpr int ensembles = 60;
  for (int e = 0; e < ensembles; ++e) {
    FreePathSums sums(200);
    for (std::uint64_t i = 0; i < 12'800; ++i) {
      FlightsOfParticle flights;
      for (int k = 0; k < 3; ++k) flights.between.push_back(1 / std::sqrt(1 - uniform(random)));
      flights.at_start.push_back(1 / (1 - uniform(random)));
      flights.hits = 48;  // as if most were short: a tail begins at 16 mean lengths
      flights.path = 6;
      sums.add(i, flights);
    }
    const FreePaths paths = free_paths_of(sums);
    ASSERT_TRUE(paths.between.tail && paths.at_start.tail);
    EXPECT_EQ(paths.mean.value, 0.125);
    const auto z = [](const Estimate& found, double expected) {
      return std::pow((found.value - expected) / found.error, 2);
    };
    exponent += z(paths.between.tail->exponent, 2);
    amplitude += z(paths.between.tail->amplitude, 8);
    far += z(paths.at_start.tail->exponent, 1);
  }
  EXPECT_NEAR(exponent / ensembles, 1, 0.6);
  EXPECT_NEAR(amplitude / ensembles, 1, 0.6);
  EXPECT_NEAR(far / ensembles, 1, 0.6);
}

// The corridors say how many flights are long: l P(l or longer) from the start, and from hit to hit
// l^2 P(l or longer) over the mean, tend to the same limit as 1/l.
TEST(FreePaths, AreLongInCorridors) {
  const System system = counting(square, 100, 100'000);
  const FreePaths paths = free_paths_of(run_diffusion(system).free_paths);
  const double limit = horizon_of(system).flight_tail;
  ASSERT_TRUE(paths.between.tail && paths.at_start.tail);
  const FreePathTail &hits = *paths.between.tail, &starts = *paths.at_start.tail;
  EXPECT_GE(hits.to, 16);
  // Corrections of order 1/l show in the exponents of these lengths.
  EXPECT_NEAR(hits.exponent.value, 2, 4 * hits.exponent.error + 0.25);
  EXPECT_NEAR(starts.exponent.value, 1, 4 * starts.exponent.error + 0.4);
  EXPECT_NEAR(hits.amplitude.value, limit, 4 * hits.amplitude.error + limit / hits.to);
  EXPECT_NEAR(starts.amplitude.value, limit, 4 * starts.amplitude.error + limit / starts.to);
  // Flights are seen up to a length of 50 in both halves of the run.
  EXPECT_EQ(paths.limit, 50);
  EXPECT_NEAR(static_cast<double>(paths.at_start.longer), 100'000 * limit / 50,
              5 * std::sqrt(100'000 * limit / 50));
}

TEST(FreePaths, EndInHoles) {
  System system =
      counting(std::string(circle) + "[[table.hole]]\nwall = \"circle\"\ncenter = 1\nwidth = 6.2\n",
               20, 5000);
  const DiffusionResult result = run_diffusion(system);
  const FreePaths paths = free_paths_of(result.free_paths);
  EXPECT_EQ(paths.at_start.all, 5000u);
  EXPECT_EQ(paths.at_start.longer, 0u);
  EXPECT_EQ(paths.between.all, result.collisions);
}

TEST(FreePaths, NeedFreeParticles) {
  System system = counting(
      std::string(circle) + "[[potential]]\nkind = \"linear\"\nforce = [0.1, 0]\n", 10, 10);
  EXPECT_THROW(run_diffusion(system), InputError);
  const auto discs = [](const char* count) {
    return counting(
        std::string(circle) +
            "[interaction]\nkind = \"hard-discs\"\nradius = 0.1\n[particles]\ncount = " + count,
        10, 10);
  };
  EXPECT_NO_THROW(run_diffusion(discs("1\n")));
  EXPECT_THROW(run_diffusion(discs("2\n")), InputError);  // speeds change where they meet
}

// No mean where there are no hits, and a bin where all flights are short against it.
TEST(FreePaths, OfFewFlightsAreCounted) {
  FreePathSums none(100.0), few(100.0);
  none.add(0, {{}, {}, 0, 100.0});
  const FreePaths without = free_paths_of(none);
  EXPECT_TRUE(std::isnan(without.mean.value));
  EXPECT_EQ(without.at_start.all, 0u);
  few.add(0, {{}, {0.5}, 1, 100.0});
  const FreePaths short_ones = free_paths_of(few);
  EXPECT_EQ(short_ones.mean.value, 100.0);
  ASSERT_EQ(short_ones.at_start.bins.size(), 1u);
  EXPECT_EQ(short_ones.at_start.bins[0].count, 1u);
  EXPECT_GT(short_ones.at_start.bins[0].to, 0.5);
}

}  // namespace
}  // namespace carom
