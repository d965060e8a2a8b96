// carom relax: equilibria of the potential energy, and small oscillations about them.
#include "carom/analyses/relax.hpp"

#include <optional>

#include "analyses/relax/report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/common.hpp"
#include "cli/loading.hpp"
#include "cli/signals.hpp"
#include "files/progress.hpp"

namespace carom::cli {

RelaxOptions relax_options(const Options& options) {
  RelaxOptions how;
  how.threads = threads_of(options);
  how.saddles = options.saddles;
  if (!options.starts.empty()) how.starts = whole_number(options.starts, "--starts", 1);
  return how;
}

int relax(const Options& options) {
  RelaxOptions how = relax_options(options);
  std::optional<files::Progress> preparing(std::in_place, !options.quiet);
  const LoadedSystem loaded = load_typed(options);
  preparing.reset();
  const System& system = loaded.system;
  how.interrupted = &catch_interrupts();
  const ArchiveLock lock = claim_output(options);
  RelaxResult result;
  {
    files::Progress progress(!options.quiet);
    if (progress.enabled())
      how.progress = [&](std::uint64_t starts) { progress.count(starts, how.starts, "starts"); };
    result = run_relax(system, how);
  }
  if (!options.output.empty())
    write_equilibria(options.output, loaded, provenance_of(options, system, result.threads), result,
                     options.force, lock);
  const std::string archive = named_archive(options, options.output);
  print_report(
      options, [&] { return relax_json(system, result, archive); },
      [&] { return relax_text(system, result, archive, options.verbose); });
  return result.complete ? done : stopped;
}

}  // namespace carom::cli
