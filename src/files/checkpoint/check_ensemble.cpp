// Refuses archives of ensembles that were changed or damaged, and names the dataset.
#include "files/checkpoint/check_ensemble.hpp"

#include <fmt/format.h>

#include "carom/base/error.hpp"
#include "files/checkpoint/ensemble_columns.hpp"
#include "files/hdf5/archive_file.hpp"

namespace carom::files {

// `trajectories`: those that are counted, each particle once.
void check_common(const StoredEnsemble& stored, const EnsembleResult& result,
                  std::uint64_t trajectories, const char* where, const System& system) {
  const TrajectoryRange part = stored.shard.range(system.run.trajectories);
  const std::vector<TrajectoryRange>& done = result.done.ranges();
  if (!done.empty() && (done.front().first < part.first || done.back().last > part.last))
    damaged(stored.file, fmt::format("'/done' counts others than the trajectories {} to {}",
                                     part.first, part.last - 1));
  if (result.complete && !result.done.missing_from(part).empty())
    damaged(stored.file, "it says that it is complete, and '/done' has gaps");
  // Trajectories with injections may differ in their number of particles.
  if (system.injections.empty() && trajectories != result.done.size() * system.particles.size())
    damaged(stored.file,
            fmt::format("'{}' is not the number of particles that '/done' counts", where));
}

// A finished ensemble has a record of each particle that it counts; one that is under way keeps
// them elsewhere.
void check_rows(const StoredEnsemble& stored, std::uint64_t particles) {
  const hdf5::Handle file = open_finished(stored.file);
  if (!file || !hdf5::has(file.get(), "trajectories")) return;
  if (RecordReader(stored.file).rows() != particles)
    damaged(stored.file, "'/trajectories' has not one row a particle of '/fates'");
}

void check_times(const StoredEnsemble& stored, const std::vector<double>& times, const char* where,
                 const System& system) {
  if (times != system.run.times)
    damaged(stored.file, fmt::format("'{}' are not the report times of '/system'", where));
}

void damaged(const std::string& name, const std::string& problem) {
  throw InputError(Place{name, 0, 0, ""}, problem, "an archive as carom wrote it");
}

}  // namespace carom::files
