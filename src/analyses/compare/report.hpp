// What a comparison of integrators says.
#pragma once

#include <string>

#include "carom/analyses/compare.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// `verbose`: every run, not the schemes alone. `archive`: its name, "": none.
std::string compare_text(const System&, const Comparison&, const std::string& archive,
                         bool verbose);
files::Json compare_json(const System&, const Comparison&, const std::string& archive);

}  // namespace carom::cli
