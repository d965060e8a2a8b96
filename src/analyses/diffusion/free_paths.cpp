#include "carom/analyses/diffusion/free_paths.hpp"

#include <limits>

#include "carom/base/error.hpp"
#include "results/distribution.hpp"
#include "results/numbers.hpp"

namespace carom {

namespace {

using results::distribution_of;
using results::GroupedCounts;
using results::jackknife;
using results::nan;

constexpr std::size_t groups = FreePathSums::groups;

}  // namespace

void FreePathSums::Sum::operator+=(const Sum& other) {
  between += other.between;
  at_start += other.at_start;
  hits += other.hits;
  path.merge(other.path);
}

void FreePathSums::add(std::uint64_t trajectory, const FlightsOfParticle& flights) {
  Sum& sum = sums_[static_cast<std::size_t>(trajectory % groups)];
  for (const double length : flights.between) sum.between.add(length, limit_);
  for (const double length : flights.at_start) sum.at_start.add(length, limit_);
  sum.hits += flights.hits;
  sum.path.add(flights.path);
}

void FreePathSums::merge(const FreePathSums& other) {
  if (other.limit_ != limit_ || other.sums_.size() != sums_.size())
    throw InternalError("merged ensembles differ in their free paths");
  for (std::size_t g = 0; g < sums_.size(); ++g) merge(g, other.of(g));
}

FreePaths free_paths_of(const FreePathSums& sums) {
  FreePaths paths;
  paths.limit = sums.limit();
  const std::vector<double> hits = results::without_each(
      groups, [&](std::size_t g) { return static_cast<double>(sums.of(g).hits); });
  const std::vector<double> path =
      results::without_each(groups, [&](std::size_t g) { return sums.of(g).path.value(); });
  std::vector<double> mean;
  for (std::size_t g = 0; g <= groups; ++g) mean.push_back(hits[g] > 0 ? path[g] / hits[g] : nan);
  const bool known = hits.back() > 0;
  // Flights of less than a sixtieth of the mean are of one kind.
  const double least = known ? mean.back() / 64 : 0.0;
  std::vector<BinnedCounts> flights, first;
  std::vector<bool> filled;
  for (std::size_t g = 0; g < groups; ++g) {
    flights.push_back(sums.of(g).between);
    first.push_back(sums.of(g).at_start);
    filled.push_back(sums.of(g).hits > 0 || first.back().bins.total() + first.back().longer > 0);
  }
  const GroupedCounts between(flights, sums.limit(), least), at_start(first, sums.limit(), least);
  paths.mean = jackknife(filled, [&](std::size_t g) { return mean[g]; });
  // Of a tail c/l^a (1 + O(mean/l)) the correction is then small.
  const double shortest = known ? 16 * mean.back() : std::numeric_limits<double>::infinity();
  paths.between = distribution_of(between, filled, mean, shortest);
  paths.at_start = distribution_of(at_start, filled, {}, shortest);
  return paths;
}

}  // namespace carom
