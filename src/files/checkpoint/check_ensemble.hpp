// What every stored ensemble must satisfy. Each throws InputError where it does not.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "carom/files/ensembles.hpp"
#include "carom/system/system.hpp"

namespace carom::files {

/// Its trajectories are those of /done, and lie in its shard. `trajectories`: the number that the
/// dataset `where` states.
void check_common(const StoredEnsemble&, const EnsembleResult&, std::uint64_t trajectories,
                  const char* where, const System&);
/// A finished ensemble has a record of each particle that it counts; one that is under way keeps
/// them elsewhere.
void check_rows(const StoredEnsemble&, std::uint64_t particles);
/// The times of the dataset `where` are the report times of the system.
void check_times(const StoredEnsemble&, const std::vector<double>& times, const char* where,
                 const System&);
std::uint64_t sum_of(const auto& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), std::uint64_t{0});
}

}  // namespace carom::files
