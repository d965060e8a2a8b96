// The result of an ensemble for machines and for people.
#pragma once

#include <string>

#include "carom/ensemble/escape.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "io/json.hpp"

namespace carom::cli {

io::Json result_json(const System&, const EscapeResult&, const EnsembleContext&);
std::string result_text(const System&, const EscapeResult&, const EnsembleContext&);

}  // namespace carom::cli
