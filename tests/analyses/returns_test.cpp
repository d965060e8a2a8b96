// Return times to a wall: Kac's lemma, a closed case, parts that add up, archives.
#include "carom/analyses/returns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "carom/base/error.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/files/system_file.hpp"
#include "scratch_folder.hpp"

namespace carom {
namespace {

LoadedSystem loaded(const std::string& name, const std::string& wall, double t_max,
                    std::uint64_t trajectories) {
  SystemOverrides overrides;
  overrides.set = {{"table.hole", "[]"}, {"section.on", "wall:" + wall}};
  overrides.t_max = std::to_string(t_max);
  overrides.trajectories = std::to_string(trajectories);
  return load_system(name, overrides);
}

TEST(Returns, MeansAreThoseOfKacsLemma) {
  for (const auto& [name, wall] :
       {std::pair("stadium", "bottom"), std::pair("stadium", "right"),
        std::pair("magnetic-square", "left"), std::pair("mushroom", "cap")}) {
    const System system = loaded(name, wall, 200, 2000).system;
    const Returns returns = returns_of(run_returns(system).sums, 100);
    const auto expected = expected_returns(system);
    ASSERT_TRUE(expected) << name;
    EXPECT_LT(std::fabs(returns.mean_time.value - expected->time), 4 * returns.mean_time.error)
        << name << ' ' << wall;
    EXPECT_LT(std::fabs(returns.mean_hits.value - expected->hits), 4 * returns.mean_hits.error)
        << name << ' ' << wall;
  }
}

// The centre of a disc meets other curves than the walls.
TEST(Returns, NothingIsExpectedOfDiscs) {
  SystemOverrides overrides;
  overrides.set = {{"table.hole", "[]"},
                   {"section.on", "wall:bottom"},
                   {"interaction", "{kind=\"hard-discs\", radius=0.1}"}};
  EXPECT_FALSE(expected_returns(load_system("stadium", overrides).system));
}

// In a circle every flight of an orbit has the same length 2 cos(a): times to the whole wall are
// chords, with the density d/2 / sqrt(4 - d^2) of the cosine law.
TEST(Returns, ChordsOfACircleHaveTheirLaw) {
  const System system = loaded("circle", "circle", 400, 4000).system;
  const Returns returns = returns_of(run_returns(system).sums, 200);
  for (const DistributionBin& bin : returns.times.bins) {
    const double expected = std::sqrt(1 - bin.from * bin.from / 4);
    EXPECT_LT(std::fabs(bin.longer.value - expected), 4.5 * bin.longer.error + 1e-12) << bin.from;
  }
  EXPECT_EQ(returns.mean_hits.value, 1.0);
}

TEST(Returns, PartsAddUpAndArchivesReadBack) {
  const LoadedSystem whole = loaded("stadium", "top", 50, 500);
  EnsembleOptions<ReturnsResult> first, second;
  first.part = {0, 123};
  second.part = {123, 500};
  const ReturnsResult all = run_returns(whole.system);
  ReturnsResult sum = run_returns(whole.system, first);
  ASSERT_TRUE(sum.add(run_returns(whole.system, second)));
  EXPECT_EQ(sum.digest, all.digest);
  const ScratchFolder folder;
  const std::string file = folder.file("returns.h5");
  EnsembleArchive<ReturnsResult>(file, whole, {}, {}).finish(sum, "completed");
  const Stored<ReturnsResult> stored = read_ensemble<ReturnsResult>(file);
  check_stored(stored, whole.system);
  const Returns a = returns_of(all.sums, 25), b = returns_of(stored.result.sums, 25);
  EXPECT_EQ(a.excursions, b.excursions);
  EXPECT_EQ(a.mean_hits.value, b.mean_hits.value);
  ASSERT_EQ(a.hits.bins.size(), b.hits.bins.size());
  for (std::size_t i = 0; i < a.hits.bins.size(); ++i)
    EXPECT_EQ(a.hits.bins[i].count, b.hits.bins[i].count);
}

// A wall that nobody comes to: nothing is estimated, and nothing is invented.
TEST(Returns, WithoutExcursionsThereAreNoNumbers) {
  const System system = loaded("stadium", "top", 1e-3, 10).system;
  const Returns returns = returns_of(run_returns(system).sums, 5e-4);
  EXPECT_EQ(returns.excursions, 0u);
  EXPECT_TRUE(std::isnan(returns.mean_time.value) && std::isnan(returns.mean_time.error));
  EXPECT_TRUE(returns.times.bins.empty() && returns.hits.bins.empty());
}

// Shares of bins add up to all that was seen, and each begins where the one before ends.
TEST(Returns, BinsAreComplete) {
  const System system = loaded("mushroom", "stem_bottom", 100, 400).system;
  const Returns returns = returns_of(run_returns(system).sums, 50);
  for (const Distribution* d : {&returns.times, &returns.hits}) {
    double share = 0.0;
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < d->bins.size(); ++i) {
      const DistributionBin& bin = d->bins[i];
      if (i > 0) {
        EXPECT_EQ(bin.from, d->bins[i - 1].to);
      }
      share += bin.density.value * (bin.to - bin.from);
      count += bin.count;
    }
    EXPECT_EQ(count + d->longer, returns.excursions);
    EXPECT_NEAR(share, static_cast<double>(count) / static_cast<double>(returns.excursions), 1e-12);
  }
}

TEST(Returns, WhatCannotReturnIsRefused) {
  System open = loaded("stadium", "top", 50, 10).system;
  open.section.wall = -1;
  EXPECT_THROW(run_returns(open), InputError);
  SystemOverrides overrides;
  overrides.set = {{"section.on", "wall:top"}};
  EXPECT_THROW(run_returns(load_system("stadium", overrides).system), InputError);
}

}  // namespace
}  // namespace carom
