// What the commands of ensembles print: each kind's report is in its folder of analyses/.
#pragma once

#include <string>

#include "carom/analyses/kinds.hpp"
#include "cli/reports/doubts.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/json.hpp"

namespace carom::cli {

#define CAROM_DECLARE(Result)                                                    \
  files::Json result_json(const System&, const Result&, const EnsembleContext&); \
  std::string result_text(const System&, const Result&, const EnsembleContext&); \
  Doubts doubts_of(const System&, const Result&);
CAROM_FOR_ENSEMBLES(CAROM_DECLARE)
#undef CAROM_DECLARE

}  // namespace carom::cli
