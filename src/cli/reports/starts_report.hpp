// By which measure the starts of an ensemble are distributed, and what that does to its averages.
#pragma once

#include <string>
#include <vector>

#include "carom/ensemble/lyapunov.hpp"
#include "io/json.hpp"

namespace carom::cli {

/// `starts`: whether they are stationary for the flow, and why not.
void add_starts(io::Json&, const System&);
/// The same of exponents, for which starts of the map are drawn from the flow's measure; `drift`.
void add_starts(io::Json&, const System&, const LyapunovResult&, const LyapunovEstimate&);
/// What was drawn in place of starts of the map; "" where nothing was, as in older archives.
std::string drawn_text(const System&, const LyapunovResult&);
/// Particles that would not have started on a wall, and do not count.
std::uint64_t uncounted(const System&, const LyapunovResult&);
/// Doubts about exponents that remember their starts, as phrases.
std::vector<std::string> drift_notes(const System&, const LyapunovResult&, const LyapunovEstimate&);
/// Why correlations are not those of the flow, as a phrase; "" where they are.
std::string correlation_note(const System&);

}  // namespace carom::cli
