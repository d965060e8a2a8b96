// carom escape: survival probability and escape rate of an ensemble.
#include "carom/ensemble/escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "carom/base/error.hpp"
#include "cli/commands.hpp"
#include "cli/certified_sample.hpp"
#include "cli/common.hpp"
#include "cli/escape_report.hpp"
#include "io/progress.hpp"

namespace carom::cli {

int escape(const Options& options) {
  if (!options.splitting.empty()) return splitting(options);
  if (!options.certify_sample.empty()) return certified_sample(options);
  check_engine(options);
  EscapeOptions how;
  how.threads = threads_of(options);
  LoadedSystem loaded = load_system(options.system, options.overrides);
  choose_engine(options.engine, loaded.system);
  const System& system = loaded.system;

  std::unique_ptr<EscapeArchive> archive;
  if (!options.output.empty()) {
    archive = std::make_unique<EscapeArchive>(options.output, loaded, provenance_of(options, system, how.threads),
                                              options.force, options.per_trajectory);
    if (options.per_trajectory)
      how.records = [&](const std::vector<TrajectoryRecord>& records) { archive->append(records); };
  }
  how.interrupted = &catch_interrupts();
  how.lanes = instruction_set_of(options);

  EscapeResult result;
  {
    Progress progress(!options.quiet);
    const double all = static_cast<double>(system.run.trajectories);
    if (progress.enabled())
      how.progress = [&](std::uint64_t trajectories, std::uint64_t hits) {
        if (progress.due())
          progress.show(static_cast<double>(trajectories) / all,
                        with_prefix(static_cast<double>(hits) / progress.seconds()) + "hits/s");
      };
    result = run_escape(system, how);
  }
  const std::string status = result.complete ? "completed" : "interrupted";
  if (archive) archive->finish(result, status);

  for (const auto& [index, report] : result.reports) std::fprintf(stderr, "carom: %s\n", report.c_str());
  print(options.json ? escape_json(system, result, status, options.output).text() + "\n"
                     : escape_text(system, result, options.output));
  if (result.counts.lost > 0) return lost;
  return result.complete ? done : stopped;
}

}  // namespace carom::cli
