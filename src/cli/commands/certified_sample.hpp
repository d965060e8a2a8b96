// carom escape --certify-sample: does rounding bias survival?
#pragma once

#include "cli/options.hpp"

namespace carom::cli {

/// Flies the first trajectories of an ensemble with the engine and in balls, and compares.
int certified_sample(const Options&);

}  // namespace carom::cli
