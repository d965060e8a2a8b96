// Reports of the particles that were lost or unresolved: the first few are kept.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "carom/results/ensemble_result.hpp"

namespace carom::engines {

/// Keeps the reports of the lowest indices, sorted. Their order of arrival does not matter.
inline void keep_first(std::vector<std::pair<std::uint64_t, std::string>>& reports,
                       std::uint64_t index, const std::string& report) {
  constexpr std::size_t most = EnsembleResult::most_reports;
  if (reports.size() == most && index > reports.back().first) return;
  std::pair<std::uint64_t, std::string> one(index, report);
  reports.insert(std::lower_bound(reports.begin(), reports.end(), one), std::move(one));
  if (reports.size() > most) reports.pop_back();
}

}  // namespace carom::engines
