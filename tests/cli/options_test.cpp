// How options are named and refused.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

TEST(OptionNames, ACheckpointIsATimeOrSoManyBlocks) {
  const Shell shell;
  for (const char* command : {"escape", "diffusion"})
    EXPECT_NE(shell(std::string("$carom ") + command + " --help").out.find("--checkpoint SECONDS|blocks:N"), std::string::npos);
  for (const char* typed : {"Blocks:3", "block:3", "3s", "0"}) {
    const Outcome o = shell(std::string("$carom escape mushroom --trajectories 10 -o a.h5 --checkpoint ") + typed);
    EXPECT_EQ(o.status, 1) << typed;
    EXPECT_NE(o.err.find("or blocks:N"), std::string::npos) << o.err;
  }
}

TEST(OptionNames, EveryCommandMayBeQuiet) {
  const Shell shell;
  EXPECT_EQ(shell("$carom systems --quiet").status, 0);
  const Outcome o = shell("$carom escape mushroom --trajectories 10 --t-max 1 --quiet -o part.h5 && $carom merge all.h5 part.h5 --quiet");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.err, "");
  for (const char* command : {"escape", "run", "diffusion", "section", "merge", "table", "systems", "validate"})
    EXPECT_NE(shell(std::string("$carom ") + command + " --help").out.find("--quiet"), std::string::npos) << command;
}

}  // namespace
}  // namespace carom
