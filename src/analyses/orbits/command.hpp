// What the options of carom orbit ask for.
#pragma once

#include <atomic>

#include "carom/analyses/orbits.hpp"
#include "carom/analyses/orbits/archive.hpp"
#include "carom/files/system_file.hpp"
#include "cli/options.hpp"

namespace carom::cli {

/// Throws InputError naming the option.
OrbitSearchOptions orbit_search_options(const Options&);

/// With --certify: each orbit proven, or why not, to --digits; else none. Fewer where interrupted:
/// then the search is not complete.
ProofsOfOrbits proofs_of_orbits(const Options&, const LoadedSystem&, OrbitSearchResult&,
                                const std::atomic<bool>& interrupted);
/// --digits, or its default. Throws InputError, also where it goes without --certify.
int digits_of_orbits(const Options&, const Table&);

}  // namespace carom::cli
