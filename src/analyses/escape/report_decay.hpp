// The decay of a survival probability for machines and for people (report.cpp).
#pragma once

#include <string>

#include "carom/analyses/escape/decay.hpp"
#include "files/json.hpp"

namespace carom::cli {

files::Json decay_json(const DecayFit&);
std::string decay_text(const DecayFit&);
/// Its likeliest law by number of hits n in three lines; nothing where there is none.
std::string decay_by_hits_text(const DecayFit&);

/// "P(t) = A exp(-kappa t) + P_infinity".
std::string formula_of(DecayLaw, bool with_plateau, const char* variable);
/// The name of a rate, and whether it is one of the window alone.
std::string rate_name(DecayLaw, bool local);
/// A p-value below it says that the law is not that of the data.
inline constexpr double hardly = 1e-3;
inline constexpr const char* not_told_apart = "The data cannot distinguish these two laws.\n";

}  // namespace carom::cli
