// What `carom diffusion` prints.
#pragma once

#include <optional>
#include <string>

#include "carom/ensemble/diffusion.hpp"
#include "io/json.hpp"

namespace carom::cli {

/// A diffusion result with what follows from it.
struct DiffusionSummary {
  Horizon horizon;
  std::vector<MomentPoint> points;
  std::optional<DiffusionFit> fit;
  std::string no_D;  ///< why there is no D; "" where there is one
  std::string note;  ///< a doubt about D, or ""
};
DiffusionSummary summary_of(const System&, const DiffusionResult&);

Json diffusion_json(const System&, const DiffusionResult&, const DiffusionSummary&, const std::string& status,
                    const std::string& output);
std::string diffusion_text(const System&, const DiffusionResult&, const DiffusionSummary&,
                           const std::string& output);

}  // namespace carom::cli
