// Archives of periodic orbits (docs/guide/archive.md has the schema).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/analyses/orbits.hpp"
#include "carom/certify/certified_periodic_orbit.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/system_file.hpp"

namespace carom {

/// The proof of an orbit in decimals; "" is no number.
struct ProofOfOrbit {
  bool proven = false;
  std::string reason;  ///< why it is not
  std::string period, length, trace, multiplier;
  std::vector<std::string> x, y;  ///< of each hit
};
/// Proofs of orbits, in their order; fewer after an interrupt, none if they were not asked for.
struct ProofsOfOrbits {
  int digits = 20;  ///< decimals that are guaranteed
  std::vector<ProofOfOrbit> orbits;
};
ProofOfOrbit proof_of(const CertifiedPeriodicOrbit&, int digits);

/// What a search found, as its archive holds it; `status` is "completed" or "interrupted".
struct StoredOrbits {
  std::string system_name, system_toml, status;
  std::uint64_t most_hits = 0;
  OrbitSearchResult result;
  ProofsOfOrbits proofs;
};

/// Writes the archive, aside, and gives it its name when it is whole. Throws InputError where the
/// file exists and `force` is not set.
void write_orbits(const std::string& file, const LoadedSystem&, const Provenance&,
                  const OrbitSearchResult&, const ProofsOfOrbits&, std::uint64_t most_hits,
                  bool force, ArchiveLock = nullptr);
/// Throws InputError for anything but such an archive. Times and threads are not among it.
StoredOrbits read_orbits(const std::string& file);

}  // namespace carom
