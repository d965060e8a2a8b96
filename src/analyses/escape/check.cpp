// Does what an archive holds fit together?
#include <fmt/format.h>

#include <cstdint>

#include "analyses/checks.hpp"
#include "carom/table/hole_names.hpp"
#include "files/checkpoint/check_ensemble.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::analyses {

using namespace files;

void check(const StoredEnsemble& stored, const EscapeResult& result, const System& system) {
  const SurvivalCounts& counts = result.counts;
  check_common(stored, result, counts.trajectories, "/fates/trajectories", system);
  check_times(stored, counts.times, "/survival/t", system);
  if (counts.hole_escapes.size() != hole_names(*system.table).size())
    damaged(stored.file, "'/fates/holes' are not the holes of '/system'");
  if (sum_of(counts.hole_escapes) != counts.escaped - counts.unbounded)
    damaged(stored.file, "'/fates/holes' and '/fates/unbounded' do not add up to '/fates/escaped'");
  const auto at_most_escaped = [&](std::uint64_t gone, const char* where) {
    if (gone > counts.escaped)
      damaged(stored.file, fmt::format("'/{}/gone' has more than '/fates'", where));
  };
  at_most_escaped(sum_of(counts.gone_in), "survival");
  at_most_escaped(sum_of(counts.gone_in_hits), "survival_hits");
  at_most_escaped(counts.gone_at.total(), "escape_times");
  at_most_escaped(counts.gone_after.total(), "escape_hits");
  const std::uint64_t mean = counts.trajectories == 0 ? 0 : counts.collisions / counts.trajectories;
  if (counts.most_hits > counts.collisions || mean > counts.most_hits)
    damaged(stored.file, "'/fates/collisions' and '/fates/most_hits' contradict each other");
  if (counts.parts.empty() == system.quasi_random())
    damaged(stored.file, "'/replicates' and '/system' contradict each other");
  if (!counts.parts.empty()) {
    Replicate all = counts.parts.front();
    for (std::size_t r = 1; r < replicates; ++r) {
      all.merge(counts.parts[r]);
      all.followed += counts.parts[r].followed;
    }
    if (all.followed != counts.followed() || all.gone_in != counts.gone_in ||
        all.gone_in_hits != counts.gone_in_hits || all.hole_escapes != counts.hole_escapes)
      damaged(stored.file, "'/replicates' do not add up to '/survival' and '/fates'");
  }
  check_rows(stored, counts.trajectories);
}

}  // namespace carom::analyses
