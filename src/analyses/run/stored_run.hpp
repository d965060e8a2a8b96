// What the state of a stored run must be to go on.
#pragma once

#include <string>

#include "carom/analyses/run/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/system/system.hpp"

namespace carom::analyses {

/// Throws InputError with `file` where the states cannot be those that this system gave: another
/// number of particles, walls and holes that it does not have, numbers that are none. Checksums
/// find what was damaged; this finds what was put there.
void check_stored(const StoredRun&, const System&, const std::string& file);

}  // namespace carom::analyses
