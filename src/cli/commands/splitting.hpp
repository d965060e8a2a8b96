// carom escape --splitting: survival by splitting populations.
#pragma once

#include <string>
#include <vector>

#include "carom/ensemble/splitting.hpp"
#include "cli/options.hpp"
#include "io/json.hpp"

namespace carom::cli {

/// What the options ask for. Throws InputError.
SplittingPlan plan_of(const Options&);
/// What a reader has to know before the result, a line each.
std::vector<std::string> warnings_of(const SplittingResult&);
Json splitting_json(const System&, const SplittingResult&);
std::string splitting_text(const System&, const SplittingResult&);

}  // namespace carom::cli
