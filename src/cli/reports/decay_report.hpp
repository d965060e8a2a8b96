// The decay of a survival probability for machines and for people.
#pragma once

#include <string>

#include "carom/ensemble/escape.hpp"
#include "carom/ensemble/splitting_fit.hpp"
#include "io/json.hpp"

namespace carom::cli {

io::Json decay_json(const DecayFit&);
/// `variable`: "t", or "n" of hits.
std::string decay_text(const DecayFit&, const char* variable = "t");
/// Its likeliest law by number of hits n in three lines; nothing where there is none.
std::string decay_by_hits_text(const DecayFit&);

/// The same of populations that were split; `variable`: "t" or "n".
io::Json split_fit_json(const SplitFit&);
std::string split_fit_text(const SplitFit&, const char* variable);

}  // namespace carom::cli
