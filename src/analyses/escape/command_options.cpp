#include "analyses/escape/command_options.hpp"

#include <fmt/format.h>

#include <utility>

#include "carom/base/error.hpp"
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
    refuse_beside(options.block, "--block", "--splitting");
    refuse_beside(options.checkpoint, "--checkpoint", "--splitting");
    refuse_beside(options.overrides.trajectories, "--trajectories",
                  "--splitting, which has --population");
    refuse_beside(options.isa == "auto" ? "" : options.isa, "--isa",
                  "--splitting, which takes the widest lanes");
    if (options.splitting.starts_with("hits:"))
      refuse_beside(options.overrides.times, "--times", "levels of hits");
  }
  if (!options.splitting.empty()) return;
  refuse(options.population, "--population", "--splitting");
  refuse(options.repetitions, "--repetitions", "--splitting");
  refuse(options.kick, "--kick", "--splitting");
  refuse(options.lookback, "--lookback", "--splitting");
}

}  // namespace carom::cli
