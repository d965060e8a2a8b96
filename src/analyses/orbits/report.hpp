// What carom orbit prints.
#pragma once

#include <string>
#include <vector>

#include "carom/analyses/orbits.hpp"
#include "carom/analyses/orbits/archive.hpp"
#include "carom/system/system.hpp"
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

}  // namespace carom::cli
