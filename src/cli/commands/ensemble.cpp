// The commands of ensembles, which differ in the kind of their result alone.
#include "cli/commands/commands.hpp"
#include "cli/commands/run_shared.hpp"

namespace carom::cli {

int ensemble(const Options& options) {
  int status = bad_input;
  for_kind(options.command, [&]<class Result>(std::type_identity<Result>) {
    status = run_ensemble<Result>(options);
  });
  return status;
}

}  // namespace carom::cli
