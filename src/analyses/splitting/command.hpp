// carom escape --splitting: survival by splitting populations.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "carom/analyses/splitting.hpp"
#include "carom/analyses/splitting/fit.hpp"
#include "cli/options.hpp"
#include "cli/outcome.hpp"
#include "cli/reports/doubts.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// What the options ask for. Throws InputError.
SplittingPlan plan_of(const Options&);
/// Trajectories that failed, and why the first of them did.
Doubts doubts_of(const SplittingResult&);
/// What else a reader has to know before the result, a line each.
std::vector<std::string> notes_of(const SplittingResult&);
files::Json splitting_json(const System&, const SplittingResult&);
/// `verbose`: with the digest; `rows`: at most this many times in a table.
std::string splitting_text(const System&, const SplittingResult&, bool verbose = false,
                           std::size_t rows = 12);

struct SplittingOutcome final : Outcome {
  using Outcome::Outcome;
  files::Json json() const override { return splitting_json(system(), result); }
  std::string text() const override { return splitting_text(system(), result); }
  std::vector<std::string> doubts() const override;

  SplittingResult result;
};

/// `variable`: "t", or "n" of hits.
files::Json split_fit_json(const SplitFit&);
std::string split_fit_text(const SplitFit&, const char* variable);

}  // namespace carom::cli
