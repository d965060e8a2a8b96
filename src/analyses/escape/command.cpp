// carom escape: survival probability and escape rate of an ensemble.
#include "carom/analyses/escape.hpp"

#include "analyses/escape/command_options.hpp"
#include "analyses/escape/report.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/run_shared.hpp"

namespace carom::cli {

int escape(const Options& options) {
  refuse_parts_of_others(options);
  check_escape_options(options);
  if (!options.splitting.empty()) return splitting(options);
  return run_ensemble<EscapeResult>(options, [](const System& system, const auto& how) {
    return run_escape(system, {how, {}});
  });
}

}  // namespace carom::cli
