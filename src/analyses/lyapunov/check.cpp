// Does what an archive holds fit together?
#include <fmt/format.h>

#include <cstdint>

#include "analyses/checks.hpp"
#include "carom/starts/start_measure.hpp"
#include "files/checkpoint/check_ensemble.hpp"
#include "files/hdf5/fields.hpp"

namespace carom::analyses {

using namespace files;

void check(const StoredEnsemble& stored, const LyapunovResult& result, const System& system) {
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

}  // namespace carom::analyses
