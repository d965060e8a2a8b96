// What carom orbit prints.
#pragma once

#include <string>
#include <vector>

#include "carom/analyses/orbits.hpp"
#include "carom/analyses/orbits/archive.hpp"
#include "carom/system/system.hpp"
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

}  // namespace carom::cli
