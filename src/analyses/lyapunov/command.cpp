// carom lyapunov: Lyapunov exponents of an ensemble, and which of its orbits are chaotic.
#include "carom/analyses/lyapunov.hpp"

#include "cli/commands/commands.hpp"
#include "cli/commands/run_shared.hpp"

namespace carom::cli {

int lyapunov(const Options& options) { return run_ensemble<LyapunovResult>(options, run_lyapunov); }

}  // namespace carom::cli
