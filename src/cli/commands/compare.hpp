// What `carom compare` was asked for.
#pragma once

#include <functional>

#include "carom/ensemble/compare.hpp"
#include "carom/io/system_file.hpp"
#include "cli/options.hpp"

namespace carom::cli {

/// Reads the system; free particles are to be integrated, too.
LoadedSystem load_compared(const Options&,
                           const std::function<LoadedSystem(const SystemOverrides&)>& load);
/// Throws InputError for steps, tolerances and errors that are none.
ComparePlan compare_plan(const Options&);

}  // namespace carom::cli
