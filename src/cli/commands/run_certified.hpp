// carom run --precision certified.
#pragma once

#include "cli/common.hpp"

namespace carom::cli {

/// The system's options with those that belong to a run.
SystemOverrides run_overrides(const Options&);

/// Throws InputError for a system whose motion only doubles follow.
void check_form(const System&, const char* option);
/// A start that was drawn: its doubles, taken exactly.
ExactStart exact_start(const State&);

int run_certified(const Options&);

}  // namespace carom::cli
