// Does what an archive holds fit together?
#include <cstdint>

#include "analyses/checks.hpp"
#include "files/checkpoint/check_ensemble.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::analyses {

using namespace files;

void check(const StoredEnsemble& stored, const ReturnsResult& result, const System& system) {
  check_common(stored, result, result.trajectories, "/fates/trajectories", system);
  std::uint64_t particles = 0, hits = 0;
  for (std::size_t g = 0; g < ReturnSums::groups; ++g) {
    const ReturnSums::Sum& sum = result.sums.of(g);
    particles += sum.particles;
    hits += sum.hits_in_half;
    if (sum.hits.bins.total() + sum.hits.longer != sum.excursions() ||
        sum.excursions() > sum.hits_in_half)
      damaged(stored.file, "the columns of '/return_groups' contradict each other");
  }
  if (particles != result.survived || hits > result.collisions)
    damaged(stored.file, "'/return_groups' and '/fates' contradict each other");
}

}  // namespace carom::analyses
