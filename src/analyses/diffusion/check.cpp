// Does what an archive holds fit together?
#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "analyses/checks.hpp"
#include "files/checkpoint/check_ensemble.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::analyses {

using namespace files;

namespace {

// Sampled particles are in the table, and a particle that has left does not come back.
void check_samples(const StoredEnsemble& stored, const DiffusionResult& result) {
  const std::size_t times = result.sums.times().size();
  std::vector<std::uint64_t> there(times, 0);
  bool descends = true;
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < times; ++k) {
      there[k] += result.sums.of(group, k).count;
      descends = descends &&
                 (k == 0 || result.sums.of(group, k).count <= result.sums.of(group, k - 1).count);
    }
  if (times == 0) return;
  if (!descends || there.front() > result.trajectories || there.back() < result.until_last_time())
    damaged(stored.file, "'/msd_groups/count' and '/fates' contradict each other");
}

// Every flight between hits began at one, and every flight from a start is a particle's.
void check_free_paths(const StoredEnsemble& stored, const DiffusionResult& result,
                      const System& system) {
  const FreePathSums& sums = result.free_paths;
  if (sums.counted() != system.run.free_paths)
    damaged(stored.file, "'/free_path_groups' and '/system' contradict each other");
  if (!sums.counted()) return;
  FreePathSums::Sum all;
  for (std::size_t g = 0; g < FreePathSums::groups; ++g) all += sums.of(g);
  if (all.hits != result.collisions || all.between.bins.total() + all.between.longer > all.hits ||
      all.at_start.bins.total() + all.at_start.longer > result.trajectories)
    damaged(stored.file, "'/free_path_groups' and '/fates' contradict each other");
}

}  // namespace

void check(const StoredEnsemble& stored, const DiffusionResult& result, const System& system) {
  check_common(stored, result, result.trajectories, "/fates/trajectories", system);
  check_times(stored, result.sums.times(), "/msd/t", system);
  check_samples(stored, result);
  check_free_paths(stored, result, system);
}

}  // namespace carom::analyses
