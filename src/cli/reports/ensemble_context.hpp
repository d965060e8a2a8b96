// What the report of an ensemble says besides the numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "carom/analyses/kinds.hpp"
#include "carom/engines/engine.hpp"
#include "carom/files/archive.hpp"
#include "carom/files/ensembles.hpp"
#include "carom/lanes/lane_effort.hpp"
#include "carom/results/ensemble_result.hpp"
#include "carom/results/estimate.hpp"
#include "carom/results/fate_counts.hpp"
#include "carom/system/system.hpp"
#include "cli/reports/doubts.hpp"
#include "files/json.hpp"

namespace carom::cli {

struct EnsembleContext {
  std::string status;  ///< "completed", "interrupted", "incomplete"
  std::string output;  ///< archive, or ""
  Shard shard;
  bool verbose = false;   ///< the text says of decisions, lanes and digest, too
  std::size_t rows = 12;  ///< most rows of a table of the text
};

/// The first lines of the text: title, number of trajectories, last time, seed.
std::string head_text(const System&, const EnsembleResult&, double until, const EnsembleContext&);
/// What is said below a table of 12 of 31 times; "" where all are in it.
std::string rows_text(std::size_t all, const EnsembleContext&);
/// The last lines of the text: what the energy did, "1 000 collisions in 0.1 s on 2 threads …",
/// what only --verbose prints (decisions, lanes, digest), what was checked, and the archive. `how`:
/// what the engine was asked for.
std::string closing_text(const System&, const EnsembleResult&, const EndCounts&,
                         const EnsembleContext&, const EngineOptions& how = {},
                         const LaneEffort& = {});
/// Why quasi-random starts give no errors, as a phrase: so many of their replicates lack what is
/// counted ("have no trajectory"). "" where none does.
std::string no_errors(std::ptrdiff_t empty, const char* lack);
/// {value, stderr}, and "value +- error".
files::Json estimate_json(const Estimate&);
std::string with_error(const Estimate&);
/// The keys with which the report of every ensemble begins.
files::Json ensemble_json(const System&, const EnsembleResult&, const EnsembleContext&);

/// Whether they are stationary for the flow, and why not.
files::Json starts_json(const System&);
/// What is drawn in place of starts of the map (starts_of_the_map).
std::string drawn_in_place(const System&);
/// Why correlations are not those of the flow, as a phrase; "" where they are.
std::string correlation_note(const System&);

// The report of each kind is in its folder of analyses/.
#define CAROM_DECLARE(Result)                                                    \
  files::Json result_json(const System&, const Result&, const EnsembleContext&); \
  std::string result_text(const System&, const Result&, const EnsembleContext&); \
  Doubts doubts_of(const System&, const Result&);
CAROM_FOR_ENSEMBLES(CAROM_DECLARE)
#undef CAROM_DECLARE

}  // namespace carom::cli
