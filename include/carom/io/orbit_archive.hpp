// Archives of periodic orbits (docs/guide/archive.md has the schema).
#pragma once

#include <cstdint>
#include <string>

#include "carom/ensemble/orbit_search.hpp"
#include "carom/io/archive.hpp"
#include "carom/io/system_file.hpp"

namespace carom {

/// What a search found, as its archive holds it; `status` is "completed" or "interrupted".
struct StoredOrbits {
  std::string system_name, system_toml, status;
  std::uint64_t most_hits = 0;
  OrbitSearchResult result;
};

/// Writes the archive, aside, and gives it its name when it is whole. Throws InputError where the
/// file exists and `force` is not set.
void write_orbits(const std::string& file, const LoadedSystem&, const Provenance&,
                  const OrbitSearchResult&, std::uint64_t most_hits, bool force,
                  ArchiveLock = nullptr);
/// Throws InputError for anything but such an archive. Times and threads are not among it.
StoredOrbits read_orbits(const std::string& file);

}  // namespace carom
