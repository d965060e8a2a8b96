// How options are named and refused.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

TEST(OptionNames, ACheckpointIsATimeOrANumberOfBlocks) {
  const Shell shell;
  for (const char* command : {"escape", "diffusion"})
    EXPECT_NE(shell(std::string("$carom ") + command + " --help")
                  .out.find("--checkpoint SECONDS|blocks:N"),
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
       {"escape", "run", "diffusion", "section", "merge", "table", "systems", "validate"})
    EXPECT_NE(shell(std::string("$carom ") + command + " --help").out.find("--quiet"),
              std::string::npos)
        << command;
}

// Where it has no effect, that is told; the names are checked even so.
TEST(OptionNames, InstructionSetsAreCheckedWithoutLanes) {
  const Shell shell;
  const char* const commands[] = {"run stadium --t-max 3",
                                  "run stadium --t-max 3 --precision certified", "table stadium",
                                  "section ellipse-magnetic --orbits 2 --points 5"};
  for (const std::string command : commands) {
    const Outcome o = shell("$carom " + command + " --isa baseline");
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(o.err.rfind("carom: --isa ", 0), 0u) << o.err;
    EXPECT_EQ(shell("$carom " + command + " --isa mmx").status, 1) << command;
  }
  const Outcome sample = shell("$carom escape stadium --t-max 3 --certify-sample 5 --isa baseline");
  EXPECT_EQ(sample.err.rfind("carom: --isa ", 0), 0u) << sample.err;
}

}  // namespace
}  // namespace carom
