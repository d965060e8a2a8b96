// What `carom compare` was asked for.
#pragma once

#include "carom/analyses/compare.hpp"
#include "cli/options.hpp"

namespace carom::cli {

/// Throws InputError for steps, tolerances and errors that are none.
ComparePlan compare_plan(const Options&);

}  // namespace carom::cli
