// What `carom diffusion` prints.
#pragma once

#include <optional>
#include <string>

#include "carom/analyses/diffusion.hpp"
#include "cli/reports/ensemble_context.hpp"
#include "files/json.hpp"

namespace carom::cli {

/// A diffusion result with what follows from it.
struct DiffusionSummary {
  Horizon horizon;
  std::vector<MomentPoint> points;
  std::optional<DiffusionFit> fit;
  std::string no_D;       ///< why there is no D; "" where there is one
  bool estimable = true;  ///< false where D may exist and only what was followed does not show it
  std::string note;       ///< a doubt about D, or ""
};
DiffusionSummary summary_of(const System&, const DiffusionResult&);

/// Null where none were counted.
files::Json free_paths_json(const System&, const DiffusionResult&);
/// "" where none were counted.
std::string free_paths_text(const System&, const DiffusionResult&, const Horizon&,
                            const EnsembleContext&);

}  // namespace carom::cli
