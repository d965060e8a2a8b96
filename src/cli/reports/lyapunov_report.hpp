// What `carom lyapunov` prints.
#pragma once

#include <string>

#include "carom/ensemble/lyapunov.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "io/json.hpp"

namespace carom::cli {

io::Json result_json(const System&, const LyapunovResult&, const EnsembleContext&);
std::string result_text(const System&, const LyapunovResult&, const EnsembleContext&);

}  // namespace carom::cli
