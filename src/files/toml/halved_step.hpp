// The same system with half the step.
#pragma once

#include "carom/files/system_file.hpp"

namespace carom::files {

/// Halves the step of a system that has one, in its resolved TOML, too.
void halve_step(LoadedSystem&);

}  // namespace carom::files
