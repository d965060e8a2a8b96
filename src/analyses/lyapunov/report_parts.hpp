// Parts of what `carom lyapunov` prints: what starts that are not stationary do to exponents, and
// the spectrum.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "carom/analyses/lyapunov.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// `starts`: whether they are stationary for the flow; starts of the map are drawn from the flow's
/// measure; `drift`.
void add_starts(files::Json&, const System&, const LyapunovResult&, const LyapunovEstimate&);
/// What was drawn in place of starts of the map; "" where nothing was.
std::string drawn_text(const System&, const LyapunovResult&);
/// Particles that would not have started on a wall, and do not count.
std::uint64_t uncounted(const System&, const LyapunovResult&);
/// Doubts about exponents that remember their starts, as phrases.
std::vector<std::string> drift_notes(const System&, const LyapunovResult&, const LyapunovEstimate&);

/// Adds its keys, null where nothing could be measured; none where no spectrum was asked for.
void add_spectrum(files::Json&, const System&, const LyapunovResult&);
/// "" where there is none.
std::string spectrum_text(const System&, const LyapunovResult&, const EnsembleContext&);

}  // namespace carom::cli
