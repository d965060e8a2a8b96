// carom escape: survival probability and escape rate of an ensemble.
#include "analyses/escape/command_options.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/ensemble_job.hpp"

namespace carom::cli {

int escape(const Options& options) {
  refuse_parts_of_others(options);
  check_escape_options(options);
  return options.splitting.empty() ? ensemble(options) : splitting(options);
}

}  // namespace carom::cli
