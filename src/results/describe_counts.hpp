// Numbers in bins, by group of trajectories, as columns of a group of an archive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "carom/base/fields.hpp"
#include "carom/results/distribution.hpp"

namespace carom::results {

struct CountLabels {
  const char *unit, *counted, *longer;
};

/// Of each group the bins that are not empty, a row each; at(g) is a reference to its BinnedCounts.
/// Columns are called PREFIXgroup, PREFIXfrom, PREFIXcount and PREFIXlonger.
template <class V, class At>
void describe_counts(V& v, const std::string& prefix, const CountLabels& labels, std::size_t groups,
                     At at) {
  std::vector<std::uint64_t> group_of, counts;
  std::vector<double> from;
  if constexpr (!V::reads)
    for (std::size_t g = 0; g < groups; ++g)
      for (const auto& bin : at(g).bins.bins())
        if (bin.count > 0) {
          group_of.push_back(g);
          from.push_back(bin.from);
          counts.push_back(bin.count);
        }
  const std::string group = prefix + "group", start = prefix + "from", count = prefix + "count",
                    longer = prefix + "longer";
  v.kept_all({group.c_str(), "1", "Group of trajectories (index modulo 128)"}, group_of);
  v.kept_all({start.c_str(), labels.unit, "Start of a bin, eight to a factor of two"}, from);
  v.kept_all({count.c_str(), "1", labels.counted}, counts);
  v.kept_each(
      {longer.c_str(), "1", labels.longer},
      groups, [&](std::size_t g) -> auto& { return at(g).longer; });
  if constexpr (V::reads) {
    v.expect(group_of.size() == counts.size() && group_of.size() == from.size(),
             "has columns of different lengths");
    for (std::size_t i = 0; i < group_of.size(); ++i) {
      v.expect(
          group_of[i] < groups && from[i] > 0.0 && BinaryBins<3>::bin_of(from[i]).from == from[i],
          "has rows that are no bins");
      at(group_of[i]).bins.add(from[i], counts[i]);
    }
  }
}

}  // namespace carom::results
