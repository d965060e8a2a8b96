// carom diffusion: mean square displacement and diffusion coefficient of an ensemble.
#include "carom/ensemble/diffusion.hpp"

#include <cstdio>
#include <memory>

#include "carom/lanes/soft_lanes.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/diffusion_report.hpp"
#include "io/progress.hpp"

namespace carom::cli {

int diffusion(const Options& options) {
  check_engine(options);
  DiffusionOptions how;
  how.threads = threads_of(options);
  how.lanes = instruction_set_of(options);
  SystemOverrides overrides = options.overrides;
  if (!options.window.empty()) overrides.set.emplace_back("run.window", "[" + options.window + "]");
  LoadedSystem loaded = load_system(options.system, overrides);
  choose_engine(options.engine, loaded.system);
  const System& system = loaded.system;

  std::unique_ptr<DiffusionArchive> archive;
  if (!options.output.empty()) {
    Provenance origin = provenance_of(options, system, how.threads);
    if (SoftLanes::suits(*system.table, system.dynamics)) origin.isa = name_of(*how.lanes);
    archive = std::make_unique<DiffusionArchive>(options.output, loaded, origin, options.force);
  }
  how.interrupted = &catch_interrupts();

  DiffusionResult result;
  {
    Progress progress(!options.quiet);
    const double all = static_cast<double>(system.run.trajectories);
    if (progress.enabled())
      how.progress = [&](std::uint64_t trajectories, std::uint64_t hits) {
        if (progress.due())
          progress.show(static_cast<double>(trajectories) / all,
                        with_prefix(static_cast<double>(hits) / progress.seconds()) + "hits/s");
      };
    result = run_diffusion(system, how);
  }
  const std::string status = result.complete ? "completed" : "interrupted";
  const DiffusionSummary summary = summary_of(system, result);
  if (archive) archive->finish(result, summary.points, status);

  for (const auto& [index, report] : result.reports) std::fprintf(stderr, "carom: %s\n", report.c_str());
  print(options.json ? diffusion_json(system, result, summary, status, options.output).text() + "\n"
                     : diffusion_text(system, result, summary, options.output));
  if (result.lost > 0) return lost;
  return result.complete ? done : stopped;
}

}  // namespace carom::cli
