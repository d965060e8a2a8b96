// Quasi-random starts under forces: the same bits however they are computed, and the same
// distribution as random ones.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "program.hpp"

namespace carom {
namespace {

// A hill in a square with a hole: particles climb it with a speed that the energy leaves.
const char* const hill = R"toml([table]
shape = "rectangle"
width = 1
height = 1
[[table.hole]]
wall = "bottom"
center = 0.5
width = 0.2
[[potential]]
kind = "gaussian"
height = 0.3
width = 0.2
center = [0.5, 0.6]
[particles]
energy = 0.5
[integrator]
step = 0.01
[initial]
kind = "sobol"
[run]
t_max = 3
trajectories = 2000
)toml";

TEST(QuasiRandomUnderForces, GivesTheSameBitsHoweverItIsComputed) {
  const Shell shell;
  std::ofstream(shell.folder() + "/hill.toml") << hill;
  for (const std::string command : {"escape ./hill.toml --json --quiet ",
                                    "escape antidot-magnetic --set initial.kind=sobol --json "
                                    "--quiet --trajectories 300 --t-max 5 ",
                                    "lyapunov ./hill.toml --json --quiet --trajectories 200 "}) {
    const std::string typed = "$carom " + command;
    const Outcome whole = shell(typed);
    ASSERT_EQ(whole.status, 0) << whole.err;
    const std::string digest = json_value(whole.out, "digest");
    for (const char* how : {"--threads 1", "--block 7", "--isa baseline", "--isa avx2"}) {
      const Outcome other = shell(typed + how);
      if (other.status == 1) continue;  // an instruction set that this machine does not have
      EXPECT_EQ(json_value(other.out, "digest"), digest) << how << other.err;
    }
    for (const char* part : {"1", "2", "3"})
      shell(typed + "--force --shard " + part + "/3 -o " + part + ".h5");
    EXPECT_EQ(json_value(shell("$carom merge all.h5 3.h5 1.h5 2.h5 --force --json").out, "digest"),
              digest);
  }
}

TEST(QuasiRandomUnderForces, HasTheMeanOfRandomStarts) {
  const Shell shell;
  std::ofstream(shell.folder() + "/hill.toml") << hill;
  struct Found {
    double value, error;
  };
  const auto found = [&](const std::string& options) {
    const std::string lambda = json_value(
        shell("$carom lyapunov ./hill.toml --closed --trajectories 320 --t-max 20 --json --quiet " +
              options)
            .out,
        "lambda");
    const auto number = [&](const std::string& key) {
      return std::stod(lambda.substr(lambda.find("\"" + key + "\": ") + key.size() + 4));
    };
    return Found{number("value"), number("stderr")};
  };
  const Found quasi = found(""), random = found("--set initial.kind=uniform");
  EXPECT_LE(std::fabs(quasi.value - random.value), 4.0 * std::hypot(quasi.error, random.error));
  EXPECT_GT(quasi.error, 0.0);
  EXPECT_NE(quasi.value, random.value);
}

}  // namespace
}  // namespace carom
