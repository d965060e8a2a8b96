// carom escape: survival probability and escape rate of an ensemble.
#include <fmt/format.h>

#include "carom/base/error.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/run_ensemble.hpp"
#include "cli/common.hpp"

namespace carom::cli {

void check_escape_options(const Options& options) {
  const auto refuse = [](const std::string& given, const char* option, const char* other) {
    if (!given.empty())
      throw InputError(place_of(option), fmt::format("it has no effect without {}", other), other);
  };
  const auto refuse_beside = [](const std::string& given, const char* option, const char* other) {
    if (!given.empty())
      throw InputError(place_of(option), fmt::format("it cannot be combined with {}", other),
                       "one of the two");
  };
  if (!options.splitting.empty()) {
    const char* const only = "a plain ensemble, without --splitting";
    if (!options.resume.empty())
      throw InputError(place_of("--resume"), "this cannot be continued", only);
    if (!options.shard.empty())
      throw InputError(place_of("--shard"), "this cannot be divided", only);
    refuse_beside(options.block, "--block", "--splitting");
    refuse_beside(options.checkpoint, "--checkpoint", "--splitting");
    refuse_beside(options.overrides.trajectories, "--trajectories",
                  "--splitting, which has --population");
    refuse_beside(options.isa == "auto" ? "" : options.isa, "--isa",
                  "--splitting, which takes the widest lanes");
    if (options.splitting.starts_with("hits:"))
      refuse_beside(options.overrides.times, "--times", "levels of hits");
    return;
  }
  refuse(options.population, "--population", "--splitting");
  refuse(options.repetitions, "--repetitions", "--splitting");
  refuse(options.kick, "--kick", "--splitting");
  refuse(options.lookback, "--lookback", "--splitting");
}

int escape(const Options& options) {
  check_escape_options(options);
  return options.splitting.empty() ? run_ensemble<EscapeResult>(options) : splitting(options);
}

}  // namespace carom::cli
