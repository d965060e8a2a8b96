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

}  // namespace
}  // namespace carom
