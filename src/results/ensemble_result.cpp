#include "carom/results/ensemble_result.hpp"

#include <algorithm>

namespace carom {

bool EnsembleResult::add_common(const EnsembleResult& other) {
  if (!done.add(other.done)) return false;
  digest += other.digest;
  decisions += other.decisions;
  steps += other.steps;
  energy_error += other.energy_error;
  seconds += other.seconds;
  cpu_seconds += other.cpu_seconds;
  if (other.reports.empty()) return true;
  reports.insert(reports.end(), other.reports.begin(), other.reports.end());
  std::sort(reports.begin(), reports.end());
  if (reports.size() > most_reports) reports.resize(most_reports);
  return true;
}

}  // namespace carom
