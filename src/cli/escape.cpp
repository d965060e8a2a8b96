// carom escape: survival probability and escape rate of an ensemble.
#include "carom/ensemble/escape.hpp"

#include "cli/certified_sample.hpp"
#include "cli/commands.hpp"
#include "cli/escape_report.hpp"
#include "cli/run_ensemble.hpp"

namespace carom::cli {

namespace {

// Options that another one gives a meaning.
void refuse_options_without_a_use(const Options& options) {
  const auto refuse = [](const std::string& given, const char* option, const char* other) {
    if (!given.empty()) throw InputError(Place{"command line", 0, 0, option}, fmt::format("it means nothing without {}", other), other);
  };
  if (options.certify_sample.empty()) refuse(options.digits, "--digits", "--certify-sample");
  if (!options.splitting.empty()) return;
  refuse(options.population, "--population", "--splitting");
  refuse(options.repetitions, "--repetitions", "--splitting");
  refuse(options.kick, "--kick", "--splitting");
  refuse(options.lookback, "--lookback", "--splitting");
}

}  // namespace

int escape(const Options& options) {
  refuse_parts_of_others(options);
  refuse_options_without_a_use(options);
  if (!options.splitting.empty()) return splitting(options);
  if (!options.certify_sample.empty()) return certified_sample(options);
  EnsembleKind<EscapeResult> kind;
  kind.run = [](const System& system, const EnsembleOptions<EscapeResult>& how) { return run_escape(system, {how, {}}); };
  kind.lost = [](const EscapeResult& result) { return result.counts.lost; };
  kind.print = [&](const EnsembleJob<EscapeResult>& job, const EscapeResult& result, const std::string& status) {
    const System& system = job.loaded.system;
    const EnsembleContext context{status, job.output, job.shard};
    print(options.json ? escape_json(system, result, context).text() + "\n" : escape_text(system, result, context));
  };
  return run_ensemble(options, kind);
}

}  // namespace carom::cli
