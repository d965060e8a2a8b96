// What runs in balls and in plain numbers of many bits share.
#pragma once

#include <string>

#include "cli/common.hpp"

namespace carom::cli {

/// The system of a run that starts from exact numbers. Throws InputError for what only doubles follow.
LoadedSystem load_exact_run(const Options&);
/// Throws InputError for a system whose motion only doubles follow.
void check_form(const System&, const char* option);
/// A start that was drawn: its doubles, taken exactly.
ExactStart exact_start(const State&);

/// "" before the first hit.
std::string wall_of(const System&, int wall);

/// Was a velocity that somebody wrote taken as a direction?
bool says_rescaled(const System&, bool rescaled);

/// carom run --precision BITS.
int run_in_plain_numbers(const Options&);

}  // namespace carom::cli
