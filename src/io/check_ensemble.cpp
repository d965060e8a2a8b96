// Archives of ensembles that were changed or damaged are refused, and told of by their dataset.
#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/table/hole_names.hpp"
#include "io/ensemble_columns.hpp"

namespace carom {

namespace {

// `trajectories`: those that are counted, each particle once.
void check_common(const StoredEnsemble& stored, const EnsembleResult& result, std::uint64_t trajectories, const char* where,
                  const System& system) {
  const TrajectoryRange part = stored.shard.range(system.run.trajectories);
  const std::vector<TrajectoryRange>& done = result.done.ranges();
  if (!done.empty() && (done.front().first < part.first || done.back().last > part.last))
    damaged(stored.file, fmt::format("'/done' counts others than the trajectories {} to {}", part.first, part.last - 1));
  if (result.complete && !result.done.missing_from(part).empty())
    damaged(stored.file, "it says that it is complete, and '/done' has gaps");
  // Of those that are injected, each trajectory may have another number.
  if (system.injections.empty() && trajectories != result.done.size() * system.particles.size())
    damaged(stored.file, fmt::format("'{}' is not the number of particles that '/done' counts", where));
}

void check_times(const StoredEnsemble& stored, const std::vector<double>& times, const char* where, const System& system) {
  if (times != system.run.times) damaged(stored.file, fmt::format("'{}' are not the report times of '/system'", where));
}

}  // namespace

void damaged(const std::string& name, const std::string& problem) {
  throw InputError(Place{name, 0, 0, ""}, problem, "an archive as carom wrote it");
}

void check_stored(const StoredEnsemble& stored, const EscapeResult& result, const System& system) {
  const SurvivalCounts& counts = result.counts;
  check_common(stored, result, counts.trajectories, "/fates/trajectories", system);
  check_times(stored, counts.times, "/survival/t", system);
  if (counts.hole_escapes.size() != hole_names(*system.table).size())
    damaged(stored.file, "'/fates/holes' are not the holes of '/system'");
}

void check_stored(const StoredEnsemble& stored, const DiffusionResult& result, const System& system) {
  check_common(stored, result, result.trajectories, "/fates/trajectories", system);
  check_times(stored, result.sums.times(), "/msd/t", system);
}

}  // namespace carom
