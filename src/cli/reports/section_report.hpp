// The counts of a section for machines.
#pragma once

#include <string>

#include "carom/ensemble/section_run.hpp"
#include "io/json.hpp"

namespace carom::cli {

/// `output`: the archive, or "".
io::Json section_json(const System&, const SectionResult&, const std::string& status,
                      const std::string& output);

}  // namespace carom::cli
