// carom diffusion: mean square displacement and diffusion coefficient of an ensemble.
#include "carom/ensemble/diffusion.hpp"

#include "cli/commands/commands.hpp"
#include "cli/commands/run_shared.hpp"
#include "cli/reports/diffusion_report.hpp"

namespace carom::cli {

int diffusion(const Options& options) {
  return run_ensemble<DiffusionResult>(options, run_diffusion);
}

}  // namespace carom::cli
