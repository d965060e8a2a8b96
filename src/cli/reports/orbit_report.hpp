// What carom orbit prints.
#pragma once

#include <string>
#include <vector>

#include "carom/certify/certified_periodic_orbit.hpp"
#include "carom/ensemble/orbit_search.hpp"
#include "carom/ensemble/system.hpp"
#include "io/json.hpp"

namespace carom::cli {

struct OrbitContext {
  std::uint64_t most_hits = 0;
  std::string status, output;
  bool verbose = false;
  /// One an orbit, in their order; fewer after an interrupt, none if it was not asked for.
  std::vector<CertifiedPeriodicOrbit> certified = {};
  int digits = 20;  ///< of these
};

io::Json orbit_json(const System&, const OrbitSearchResult&, const OrbitContext&);
std::string orbit_text(const System&, const OrbitSearchResult&, const OrbitContext&);

}  // namespace carom::cli
