// How distributions are estimated from counts by group.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "carom/results/distribution.hpp"
#include "results/numbers.hpp"

namespace carom::results {

/// A statistic of sums over groups, and its error by leaving out one filled group after the other:
/// statistic(g) leaves out group g, statistic(filled.size()) none.
Estimate jackknife(const std::vector<bool>& filled, auto statistic) {
  const std::size_t groups = filled.size();
  const double whole = statistic(groups);
  double sum = 0, n = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    if (!filled[g]) continue;
    const double off = statistic(g) - whole;
    sum += off * off;
    ++n;
  }
  return {whole, n < 2 ? nan : std::sqrt(sum * (n - 1) / n)};
}

/// The sum over all groups but one of the number that `of` gives; the last: over all.
std::vector<double> without_each(std::size_t groups, auto of) {
  double all = 0;
  for (std::size_t g = 0; g < groups; ++g) all += of(g);
  std::vector<double> left;
  for (std::size_t g = 0; g < groups; ++g) left.push_back(all - of(g));
  left.push_back(all);
  return left;
}

/// Counts of each group at common edges, one more than bins. What is less than `least` is in the
/// first bin.
struct GroupedCounts {
  GroupedCounts(const std::vector<BinnedCounts>& groups, double limit, double least);

  std::vector<double> edges;
  // By group: numbers in each bin, and those at least as large as each edge.
  std::vector<std::vector<double>> in, longer;
};

/// `mean`: the mean number without each group, for the amplitude of a tail; may be empty. A tail
/// has no number less than `shortest`.
Distribution distribution_of(const GroupedCounts&, const std::vector<bool>& filled,
                             const std::vector<double>& mean, double shortest);

}  // namespace carom::results
