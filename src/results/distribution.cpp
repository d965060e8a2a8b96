#include "results/distribution.hpp"

#include <algorithm>

#include "carom/base/elementary.hpp"

namespace carom::results {

namespace {

std::optional<DistributionTail> tail_of(const GroupedCounts& counts,
                                        const std::vector<bool>& filled,
                                        const std::vector<double>& all,
                                        const std::vector<double>& mean, double shortest) {
  constexpr double least = 100, span = 4;
  const auto beyond = [&](std::size_t edge) {
    return without_each(filled.size(), [&](std::size_t g) { return counts.longer[g][edge]; });
  };
  std::size_t last = counts.edges.size() - 1;
  while (last > 0 && beyond(last).back() < least) --last;
  const double wanted = counts.edges[last] / span;
  const auto found = std::lower_bound(counts.edges.begin(), counts.edges.end(), wanted);
  if (last == 0 || !(*found >= shortest)) return std::nullopt;
  const auto first = static_cast<std::size_t>(found - counts.edges.begin());
  DistributionTail tail;
  tail.from = counts.edges[first];
  tail.to = counts.edges[last];
  const std::vector<double> near = beyond(first), far = beyond(last);
  const double ratio = elementary::log(tail.to / tail.from);
  tail.exponent =
      jackknife(filled, [&](std::size_t g) { return elementary::log(near[g] / far[g]) / ratio; });
  tail.amplitude = jackknife(filled, [&](std::size_t g) {
    const double share = tail.to * far[g] / all[g];
    return mean.empty() ? share : tail.to * share / mean[g];
  });
  return tail;
}

}  // namespace

GroupedCounts::GroupedCounts(const std::vector<BinnedCounts>& groups, double limit, double least) {
  BinnedCounts all;
  for (const BinnedCounts& group : groups) all += group;
  edges.push_back(0.0);
  for (const auto& bin : all.bins.bins())
    if (bin.to > least) edges.push_back(std::min(bin.to, limit));
  // All may be of one kind: there is always a bin for those that were counted.
  if (const auto& bins = all.bins.bins(); edges.size() == 1 && !bins.empty())
    edges.push_back(std::min(bins.back().to, limit));
  const std::size_t n = edges.size() - 1;
  for (const BinnedCounts& group : groups) {
    std::vector<double> here(n, 0.0), beyond(n + 1, static_cast<double>(group.longer));
    for (const auto& bin : group.bins.bins()) {
      if (bin.count == 0) continue;
      // The bin whose end is the first beyond the start of this one.
      const auto end = std::upper_bound(edges.begin() + 1, edges.end(), bin.from);
      here[static_cast<std::size_t>(end - edges.begin()) - 1] += static_cast<double>(bin.count);
    }
    for (std::size_t i = n; i-- > 0;) beyond[i] = beyond[i + 1] + here[i];
    in.push_back(std::move(here));
    longer.push_back(std::move(beyond));
  }
}

Distribution distribution_of(const GroupedCounts& counts, const std::vector<bool>& filled,
                             const std::vector<double>& mean, double shortest) {
  Distribution d;
  const std::vector<double> all =
      without_each(filled.size(), [&](std::size_t g) { return counts.longer[g].front(); });
  d.all = static_cast<std::uint64_t>(all.back());
  if (d.all == 0) return d;
  const std::size_t n = counts.edges.size() - 1;
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<double> in =
        without_each(filled.size(), [&](std::size_t g) { return counts.in[g][i]; });
    const std::vector<double> longer =
        without_each(filled.size(), [&](std::size_t g) { return counts.longer[g][i]; });
    DistributionBin bin;
    bin.from = counts.edges[i];
    bin.to = counts.edges[i + 1];
    bin.count = static_cast<std::uint64_t>(in.back());
    bin.density =
        jackknife(filled, [&](std::size_t g) { return in[g] / (all[g] * (bin.to - bin.from)); });
    bin.longer = jackknife(filled, [&](std::size_t g) { return longer[g] / all[g]; });
    d.bins.push_back(bin);
  }
  for (std::size_t g = 0; g < filled.size(); ++g)
    d.longer += static_cast<std::uint64_t>(counts.longer[g].back());
  d.tail = tail_of(counts, filled, all, mean, shortest);
  return d;
}

}  // namespace carom::results
