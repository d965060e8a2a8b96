// What carom orbit prints.
#pragma once

#include <atomic>
#include <string>

#include "carom/analyses/orbits.hpp"
#include "carom/files/system_file.hpp"
#include "carom/system/system.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"
#include "files/json.hpp"

namespace carom::cli {

struct OrbitContext {
  std::uint64_t most_hits = 0;
  std::string status, output;
  bool verbose = false;
  ProofsOfOrbits proofs = {};
};

files::Json orbit_json(const System&, const OrbitSearchResult&, const OrbitContext&);
std::string orbit_text(const System&, const OrbitSearchResult&, const OrbitContext&);

struct OrbitsOutcome final : Outcome {
  using Outcome::Outcome;
  files::Json json() const override { return orbit_json(system(), result, context()); }
  std::string text() const override { return orbit_text(system(), result, context()); }
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;
  OrbitContext context() const;

  std::uint64_t most_hits = 0;
  OrbitSearchResult result;
  ProofsOfOrbits proofs;
};

/// Throws InputError naming the option.
OrbitSearchOptions orbit_search_options(const Options&);

/// With --certify: each orbit proven, or why not, to --digits; else none. Fewer where interrupted:
/// then the search is not complete.
ProofsOfOrbits proofs_of_orbits(const Options&, const LoadedSystem&, OrbitSearchResult&,
                                const std::atomic<bool>& interrupted);
/// --digits, or its default. Throws InputError, also where it goes without --certify.
int digits_of_orbits(const Options&, const Table&);

}  // namespace carom::cli
