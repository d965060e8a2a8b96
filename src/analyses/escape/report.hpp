// The result of an ensemble for machines and for people.
#pragma once

#include <string>

#include "carom/analyses/escape.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/json.hpp"

namespace carom::cli {

files::Json result_json(const System&, const EscapeResult&, const EnsembleContext&);
std::string result_text(const System&, const EscapeResult&, const EnsembleContext&);

}  // namespace carom::cli
