// How options are named and refused.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "cli/program.hpp"

namespace carom {
namespace {

TEST(OptionNames, ACheckpointIsATimeOrANumberOfBlocks) {
  const Shell shell;
  for (const char* command : {"escape", "diffusion"})
    EXPECT_NE(shell(std::string("$carom ") + command + " --help").out.find("--checkpoint SECONDS"),
              std::string::npos);
  for (const char* typed : {"Blocks:3", "block:3", "3s", "0"}) {
    const Outcome o = shell(
        std::string("$carom escape mushroom --trajectories 10 -o a.h5 --checkpoint ") + typed);
    expect_refused(o, "command line: --checkpoint: ");
  }
}

TEST(OptionNames, EveryCommandMayBeQuiet) {
  const Shell shell;
  EXPECT_EQ(shell("$carom systems --quiet").status, 0);
  const Outcome o = shell(
      "$carom escape mushroom --trajectories 10 --t-max 1 --quiet -o part.h5 && $carom merge "
      "all.h5 part.h5 --quiet");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.err, "");
  for (const char* command :
       {"escape", "run", "diffusion", "lyapunov", "section", "relax", "compare", "schemes", "orbit",
        "merge", "table", "systems", "validate"})
    EXPECT_NE(shell(std::string("$carom ") + command + " --help").out.find("--quiet"),
              std::string::npos)
        << command;
}

// An option that a command does not use is not in its help, and refused with the commands that it
// belongs to.
TEST(OptionNames, CommandsHaveNoOptionsWithoutAUse) {
  const Shell shell;
  const std::pair<const char*, std::vector<const char*>> without[] = {
      {"table",
       {"--seed", "--t-max", "--threads", "--isa", "--position", "--times", "--engine",
        "--trajectories"}},
      {"run", {"--times", "--isa", "--threads", "--trajectories"}},
      {"section", {"--times", "--isa", "--trajectories"}},
      {"merge", {"--seed", "--set"}},
      {"systems", {"--set", "--threads", "--force"}}};
  for (const auto& [command, options] : without)
    for (const std::string option : options) {
      const std::string line = std::string("$carom ") + command;
      EXPECT_EQ(shell(line + " --help").out.find(option + " "), std::string::npos)
          << command << option;
      const Outcome o = shell(line + " stadium " + option + " 1");
      EXPECT_EQ(o.status, 2) << command << option;
      EXPECT_NE(o.err.find(option + " means nothing to carom " + command), std::string::npos)
          << o.err;
      EXPECT_NE(o.err.find("an option of"), std::string::npos) << o.err;
    }
}

}  // namespace
}  // namespace carom
