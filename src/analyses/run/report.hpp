// The end of a run for machines and for people.
#pragma once

#include <string>

#include "carom/analyses/run.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// completed, escaped, singular, unbounded, pinned, interrupted, unresolved or lost; of several
/// particles, lost or unresolved if one is, else completed.
std::string run_status(const SingleRunResult&);
files::Json run_json(const System&, const SingleRunResult&, const std::string& status,
                     const std::string& output);
/// `verbose`: with the decisions, and all of many particles.
std::string run_text(const System&, const SingleRunResult&, const std::string& status,
                     const std::string& output, bool verbose = false);

}  // namespace carom::cli
