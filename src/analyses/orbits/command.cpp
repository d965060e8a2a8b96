// carom orbit: the periodic orbits of a free particle.

#include <optional>
#include <utility>

#include "analyses/orbits/report.hpp"
#include "carom/analyses/orbits.hpp"
#include "carom/base/error.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

OrbitSearchOptions orbit_search_options(const Options& options) {
  OrbitSearchOptions how;
  how.threads = threads_of(options);
  if (!options.hits.empty()) how.most_hits = whole_number(options.hits, "--hits", 1);
  if (!options.starts.empty()) how.starts = whole_number(options.starts, "--starts", 1);
  if (!options.tries.empty()) how.tries = whole_number(options.tries, "--tries", 1);
  how.expand_cycles = options.zeta;
  return how;
}

int digits_of_orbits(const Options& options, const Table& table) {
  if (options.digits.empty()) return 20;
  if (!options.certify)
    throw InputError(Place{"command line", 0, 0, "--digits"}, "there are no digits to guarantee",
                     "--certify as well");
  const std::uint64_t digits = whole_number(options.digits, "--digits", 1);
  check_digits(digits, table, Place{"command line", 0, 0, "--digits"});
  return static_cast<int>(digits);
}

ProofsOfOrbits proofs_of_orbits(const Options& options, const LoadedSystem& loaded,
                                OrbitSearchResult& result, const std::atomic<bool>& interrupted) {
  ProofsOfOrbits all;
  if (!options.certify) return all;
  all.digits = digits_of_orbits(options, *loaded.system.table);
  for (const PeriodicOrbit& orbit : result.orbits) {
    if (interrupted.load(std::memory_order_relaxed)) {
      result.complete = false;
      break;
    }
    if (orbit.family) {
      all.orbits.emplace_back();
      all.orbits.back().reason = "its neighbours are periodic, too";
      continue;
    }
    std::vector<NearHit> hits;
    for (std::size_t i = 0; i < orbit.hits.size(); ++i) {
      const OrbitHit& hit = orbit.hits[i];
      hits.push_back({hit.wall, hit.position, hit.u, orbit.half_turns[i], hit.step});
    }
    all.orbits.push_back(proof_of(certify_orbit(loaded.exact, hits, all.digits), all.digits));
  }
  return all;
}

int orbit(const Options& options) {
  OrbitSearchOptions how = orbit_search_options(options);
  std::optional<files::Progress> preparing(std::in_place, !options.quiet);
  const LoadedSystem loaded = load_typed(options);
  preparing.reset();
  const System& system = loaded.system;
  digits_of_orbits(options, *system.table);  // refused before anything is computed
  ArchiveLock lock = claim_output(options);
  how.interrupted = &catch_interrupts();
  OrbitSearchResult result;
  {
    files::Progress progress(!options.quiet);
    if (progress.enabled())
      how.progress = [&](std::uint64_t tried, std::uint64_t all) {
        progress.count(tried, all, "starts");
      };
    result = find_orbits(system, how);
  }
  const ProofsOfOrbits proofs = proofs_of_orbits(options, loaded, result, *how.interrupted);
  if (!options.output.empty())
    write_orbits(options.output, loaded, provenance_of(options, system, result.threads), result,
                 proofs, how.most_hits, options.force, std::move(lock));
  const OrbitContext context{how.most_hits, result.complete ? "completed" : "interrupted",
                             named_archive(options, options.output), options.verbose, proofs};
  print_report(
      options, [&] { return orbit_json(system, result, context); },
      [&] { return orbit_text(system, result, context); });
  return result.complete ? done : stopped;
}

}  // namespace carom::cli
