// All exponents of a system, as `carom lyapunov --spectrum` prints them.
#pragma once

#include <string>

#include "carom/analyses/lyapunov.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// Adds its keys, null where nothing could be measured; none where no spectrum was asked for.
void add_spectrum(files::Json&, const System&, const LyapunovResult&);
/// "" where there is none.
std::string spectrum_text(const System&, const LyapunovResult&, const EnsembleContext&);

}  // namespace carom::cli
