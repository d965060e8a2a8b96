// What carom orbit prints.
#pragma once

#include <string>
#include <vector>

#include "carom/ensemble/orbit_search.hpp"
#include "carom/ensemble/system.hpp"
#include "carom/io/orbit_archive.hpp"
#include "io/json.hpp"

namespace carom::cli {

struct OrbitContext {
  std::uint64_t most_hits = 0;
  std::string status, output;
  bool verbose = false;
  ProofsOfOrbits proofs = {};
};

io::Json orbit_json(const System&, const OrbitSearchResult&, const OrbitContext&);
std::string orbit_text(const System&, const OrbitSearchResult&, const OrbitContext&);

}  // namespace carom::cli
