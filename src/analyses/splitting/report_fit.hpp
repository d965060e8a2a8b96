// The decay of populations that were split, for machines and for people.
#pragma once

#include <string>

#include "carom/analyses/splitting/fit.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// `variable`: "t", or "n" of hits.
files::Json split_fit_json(const SplitFit&);
std::string split_fit_text(const SplitFit&, const char* variable);

}  // namespace carom::cli
