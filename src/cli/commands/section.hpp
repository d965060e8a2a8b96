// What the options of carom section make of a system.
#pragma once

#include <functional>

#include "carom/io/system_file.hpp"
#include "cli/options.hpp"

namespace carom::cli {

/// Reads the system with what is overridden.
using Load = std::function<LoadedSystem(const SystemOverrides&)>;
LoadedSystem load_section(const Options&, const Load&);

}  // namespace carom::cli
