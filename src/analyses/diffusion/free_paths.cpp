#include "carom/analyses/diffusion/free_paths.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "results/numbers.hpp"

namespace carom {

namespace {

using results::nan;

constexpr std::size_t groups = FreePathSums::groups;

void add(FreePathSums::Flights& flights, double length, double limit) {
  if (length < limit)
    flights.bins.add(length);
  else
    ++flights.longer;
}

// Numbers of one kind of flights at each group and edge of bins.
struct Counts {
  std::vector<double> edges;  // one more than bins
  // By group: flights in each bin, and those at least as long as each edge.
  std::vector<std::vector<double>> in, longer;
  std::vector<bool> filled;  // groups with any trajectory

  Counts(const FreePathSums& sums, FreePathSums::Flights FreePathSums::Sum::*what, double least) {
    FreePathSums::Flights all;
    for (std::size_t g = 0; g < groups; ++g) all += sums.of(g).*what;
    edges.push_back(0.0);
    for (const auto& bin : all.bins.bins())
      if (bin.to > least) edges.push_back(std::min(bin.to, sums.limit()));
    // All flights may be of one kind: there is always a bin for those that were counted.
    if (const auto& bins = all.bins.bins(); edges.size() == 1 && !bins.empty())
      edges.push_back(std::min(bins.back().to, sums.limit()));
    const std::size_t n = edges.size() - 1;
    for (std::size_t g = 0; g < groups; ++g) {
      const FreePathSums::Flights& flights = sums.of(g).*what;
      std::vector<double> here(n, 0.0), beyond(n + 1, static_cast<double>(flights.longer));
      for (const auto& bin : flights.bins.bins()) {
        if (bin.count == 0) continue;
        // The bin whose end is the first beyond the start of this one.
        const auto end = std::upper_bound(edges.begin() + 1, edges.end(), bin.from);
        here[static_cast<std::size_t>(end - edges.begin()) - 1] += static_cast<double>(bin.count);
      }
      for (std::size_t i = n; i-- > 0;) beyond[i] = beyond[i + 1] + here[i];
      filled.push_back(sums.of(g).hits > 0 || beyond.front() > 0);
      in.push_back(std::move(here));
      longer.push_back(std::move(beyond));
    }
  }
};

// A statistic of sums over groups, and its error by leaving out one group after the other.
template <class Statistic>
Estimate jackknife(const std::vector<bool>& filled, Statistic statistic) {
  const double whole = statistic(groups);  // leaves out none
  double sum = 0, n = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    if (!filled[g]) continue;
    const double off = statistic(g) - whole;
    sum += off * off;
    ++n;
  }
  return {whole, n < 2 ? nan : std::sqrt(sum * (n - 1) / n)};
}

// The sum over all groups but one of the value that `of` gives.
template <class Of>
std::vector<double> without_each(Of of) {
  double all = 0;
  for (std::size_t g = 0; g < groups; ++g) all += of(g);
  std::vector<double> left;
  for (std::size_t g = 0; g < groups; ++g) left.push_back(all - of(g));
  left.push_back(all);
  return left;
}

std::optional<FreePathTail> tail_of(const Counts& counts, const std::vector<double>& all,
                                    const std::vector<double>& mean, double shortest) {
  constexpr double least = 100, span = 4;
  const auto beyond = [&](std::size_t edge) {
    return without_each([&](std::size_t g) { return counts.longer[g][edge]; });
  };
  std::size_t last = counts.edges.size() - 1;
  while (last > 0 && beyond(last).back() < least) --last;
  const double wanted = counts.edges[last] / span;
  const auto found = std::lower_bound(counts.edges.begin(), counts.edges.end(), wanted);
  if (last == 0 || !(*found >= shortest)) return std::nullopt;
  const auto first = static_cast<std::size_t>(found - counts.edges.begin());
  FreePathTail tail;
  tail.from = counts.edges[first];
  tail.to = counts.edges[last];
  const std::vector<double> near = beyond(first), far = beyond(last);
  const double ratio = elementary::log(tail.to / tail.from);
  tail.exponent = jackknife(
      counts.filled, [&](std::size_t g) { return elementary::log(near[g] / far[g]) / ratio; });
  tail.amplitude = jackknife(counts.filled, [&](std::size_t g) {
    const double share = tail.to * far[g] / all[g];
    return mean.empty() ? share : tail.to * share / mean[g];
  });
  return tail;
}

// `mean`: the mean length without each group, for flights between hits. A tail has no length less
// than `shortest`.
FreePathDistribution distribution_of(const Counts& counts, const std::vector<double>& mean,
                                     double shortest) {
  FreePathDistribution d;
  const std::vector<double> all =
      without_each([&](std::size_t g) { return counts.longer[g].front(); });
  d.flights = static_cast<std::uint64_t>(all.back());
  if (d.flights == 0) return d;
  const std::size_t n = counts.edges.size() - 1;
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<double> in = without_each([&](std::size_t g) { return counts.in[g][i]; });
    const std::vector<double> longer =
        without_each([&](std::size_t g) { return counts.longer[g][i]; });
    FreePathBin bin;
    bin.from = counts.edges[i];
    bin.to = counts.edges[i + 1];
    bin.count = static_cast<std::uint64_t>(in.back());
    bin.density = jackknife(counts.filled,
                            [&](std::size_t g) { return in[g] / (all[g] * (bin.to - bin.from)); });
    bin.longer = jackknife(counts.filled, [&](std::size_t g) { return longer[g] / all[g]; });
    d.bins.push_back(bin);
  }
  for (std::size_t g = 0; g < groups; ++g)
    d.longer += static_cast<std::uint64_t>(counts.longer[g].back());
  d.tail = tail_of(counts, all, mean, shortest);
  return d;
}

}  // namespace

void FreePathSums::Flights::operator+=(const Flights& other) {
  bins.merge(other.bins);
  longer += other.longer;
}

void FreePathSums::Sum::operator+=(const Sum& other) {
  between += other.between;
  at_start += other.at_start;
  hits += other.hits;
  path.merge(other.path);
}

void FreePathSums::add(std::uint64_t trajectory, const FlightsOfParticle& flights) {
  Sum& sum = sums_[static_cast<std::size_t>(trajectory % groups)];
  for (const double length : flights.between) carom::add(sum.between, length, limit_);
  for (const double length : flights.at_start) carom::add(sum.at_start, length, limit_);
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
  const std::vector<double> hits =
      without_each([&](std::size_t g) { return static_cast<double>(sums.of(g).hits); });
  const std::vector<double> path =
      without_each([&](std::size_t g) { return sums.of(g).path.value(); });
  std::vector<double> mean;
  for (std::size_t g = 0; g <= groups; ++g) mean.push_back(hits[g] > 0 ? path[g] / hits[g] : nan);
  const bool known = hits.back() > 0;
  // Flights of less than a sixtieth of the mean are of one kind.
  const double least = known ? mean.back() / 64 : 0.0;
  const Counts between(sums, &FreePathSums::Sum::between, least),
      at_start(sums, &FreePathSums::Sum::at_start, least);
  paths.mean = jackknife(at_start.filled, [&](std::size_t g) { return mean[g]; });
  // Of a tail c/l^a (1 + O(mean/l)) the correction is then small.
  const double shortest = known ? 16 * mean.back() : std::numeric_limits<double>::infinity();
  paths.between = distribution_of(between, mean, shortest);
  paths.at_start = distribution_of(at_start, {}, shortest);
  return paths;
}

}  // namespace carom
