#include "carom/results/ensemble_result.hpp"

#include <algorithm>
#include <utility>

namespace carom {

void keep_first(Reports& reports, std::uint64_t index, const std::string& report) {
  if (reports.size() == most_reports && index > reports.back().first) return;
  std::pair<std::uint64_t, std::string> one(index, report);
  reports.insert(std::lower_bound(reports.begin(), reports.end(), one), std::move(one));
  if (reports.size() > most_reports) reports.pop_back();
}

bool EnsembleResult::add_common(const EnsembleResult& other) {
  if (!done.add(other.done)) return false;
  digest += other.digest;
  decisions += other.decisions;
  steps += other.steps;
  energy_error += other.energy_error;
  seconds += other.seconds;
  cpu_seconds += other.cpu_seconds;
  for (const auto& [index, report] : other.reports) keep_first(reports, index, report);
  return true;
}

}  // namespace carom
