// carom escape: which of its options go together.
#pragma once

#include "cli/options.hpp"

namespace carom::cli {

/// Throws InputError for options that another one gives a meaning, or takes it away.
void check_escape_options(const Options&);

}  // namespace carom::cli
