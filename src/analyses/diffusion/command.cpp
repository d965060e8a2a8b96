// carom diffusion: mean square displacement and diffusion coefficient of an ensemble.
#include "carom/analyses/diffusion.hpp"

#include "analyses/diffusion/report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/run_shared.hpp"

namespace carom::cli {

int diffusion(const Options& options) {
  return run_ensemble<DiffusionResult>(options, run_diffusion);
}

}  // namespace carom::cli
