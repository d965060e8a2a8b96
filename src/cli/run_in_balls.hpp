// carom run with another precision than double.
#pragma once

#include "cli/options.hpp"

namespace carom::cli {

/// The system's options with those that belong to a run.
SystemOverrides run_overrides(const Options&);

/// --precision certified, or a number of bits.
int run_in_balls(const Options&);

}  // namespace carom::cli
