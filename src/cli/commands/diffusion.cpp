// carom diffusion: mean square displacement and diffusion coefficient of an ensemble.
#include "carom/ensemble/diffusion.hpp"

#include "cli/commands/commands.hpp"
#include "cli/commands/run_shared.hpp"
#include "cli/reports/diffusion_report.hpp"

namespace carom::cli {

int diffusion(const Options& options) {
  EnsembleKind<DiffusionResult> kind;
  kind.run = run_diffusion;
  kind.print = [&](const EnsembleJob<DiffusionResult>& job, const DiffusionResult& result,
                   const std::string& status) {
    print_diffusion(options, job.loaded.system, result, {status, job.output, job.shard});
  };
  return run_ensemble(options, kind);
}

}  // namespace carom::cli
