// Lengths of free flights, as `carom diffusion` prints them.
#pragma once

#include <string>

#include "carom/analyses/diffusion.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// Null where none were counted.
files::Json free_paths_json(const System&, const DiffusionResult&);
/// "" where none were counted.
std::string free_paths_text(const System&, const DiffusionResult&, const Horizon&,
                            const EnsembleContext&);

}  // namespace carom::cli
