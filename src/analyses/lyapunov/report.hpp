// What `carom lyapunov` prints.
#pragma once

#include <string>

#include "carom/analyses/lyapunov.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/json.hpp"

namespace carom::cli {

files::Json result_json(const System&, const LyapunovResult&, const EnsembleContext&);
std::string result_text(const System&, const LyapunovResult&, const EnsembleContext&);

}  // namespace carom::cli
