#include "cli/commands/commands.hpp"
#include "cli/commands/ensemble_job.hpp"
#include "cli/common.hpp"

namespace carom::cli {

LoadedSystem system_of_command(const Options& options) {
  const std::string& command = options.command;
  if (command == "escape") check_escape_options(options);
  if (is_ensemble(command)) return load_ensemble(options);
  if (command == "run") return system_of_run(options);
  if (command == "section") return system_of_section(options);
  if (command == "compare") return system_of_compare(options);
  return load_typed(options);
}

}  // namespace carom::cli
