// Refuses archives of ensembles that were changed or damaged, and names the dataset.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/ensemble/start_measure.hpp"
#include "carom/table/hole_names.hpp"
#include "io/archive/ensemble_columns.hpp"

namespace carom::io {

namespace {

template <class Numbers>
std::uint64_t sum_of(const Numbers& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), std::uint64_t{0});
}

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

// A finished ensemble has a record of each particle that it counts; one that is under way keeps
// them elsewhere.
void check_rows(const StoredEnsemble& stored, std::uint64_t particles) {
  const hdf5::Handle file(H5Fopen(stored.file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file || !hdf5::has(file.get(), "trajectories")) return;
  if (RecordReader(stored.file).rows() != particles)
    damaged(stored.file, "'/trajectories' has not one row a particle of '/fates'");
}

void check_times(const StoredEnsemble& stored, const std::vector<double>& times, const char* where,
                 const System& system) {
  if (times != system.run.times)
    damaged(stored.file, fmt::format("'{}' are not the report times of '/system'", where));
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

void check_stored(const StoredEnsemble& stored, const DiffusionResult& result,
                  const System& system) {
  check_common(stored, result, result.trajectories, "/fates/trajectories", system);
  check_times(stored, result.sums.times(), "/msd/t", system);
  check_samples(stored, result);
  check_free_paths(stored, result, system);
}

void check_stored(const StoredEnsemble& stored, const LyapunovResult& result,
                  const System& system) {
  check_common(stored, result, result.trajectories, "/fates/trajectories", system);
  const GrowthSums& sums = result.growth;
  const GrowthSums::Totals& totals = sums.totals();
  const TimeWindow window = growth_window(system);
  if (sums.window().from != window.from || sums.window().to != window.to)
    damaged(stored.file, "'/lyapunov/from' and 'to' are not the window of '/system'");
  const bool together = interacts(system);
  const std::uint64_t stayed =
      result.until_last_time() - (starts_of_the_map(system) ? result.pinned : 0);
  if ((together ? totals.orbits * system.particles.size() > stayed : totals.orbits != stayed) ||
      totals.chaotic > totals.orbits || totals.linear > totals.orbits - totals.chaotic)
    damaged(stored.file, "'/lyapunov_sums/orbits' and '/fates' contradict each other");
  const SpectrumSums& spectrum = result.spectrum;
  const bool fits = spectrum.exponents() == (system.run.spectrum ? 4 * system.particles.size() : 0);
  if (!fits || (spectrum.counted() && spectrum.zeros() != vanishing_exponents(system).count))
    damaged(stored.file, "'/lyapunov_sums/spectrum_totals' and '/system' contradict each other");
  std::uint64_t orbits = 0, chaotic = 0;
  for (const GrowthSums::Totals& part : sums.parts())
    orbits += part.orbits, chaotic += part.chaotic;
  if (sums.parts().empty() == system.quasi_random() ||
      (system.quasi_random() && (orbits != totals.orbits || chaotic != totals.chaotic)))
    damaged(stored.file, "'/lyapunov_sums/replicate_counts' do not add up to its orbits");
  const auto& bins = totals.distribution.counts();
  if (sum_of(bins) != totals.orbits || sum_of(totals.chaotic_at) != totals.chaotic)
    damaged(stored.file, "the bins of '/lyapunov_sums' do not add up to its orbits");
}

}  // namespace carom::io
