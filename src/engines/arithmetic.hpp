// Which digits this build of the library computes.
#pragma once

#include <string>

namespace carom::engines {

/// A hash of the states to which some short orbits of fixed systems come, and of what they add to a
/// digest, 16 hexadecimal digits: builds whose digits differ, or their digests, do not go on with
/// each other's ensembles. It depends on neither threads nor instruction sets. Computed when it is
/// asked for first, in some milliseconds.
const std::string& arithmetic_fingerprint();

}  // namespace carom::engines
