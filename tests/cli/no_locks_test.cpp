// Archives where the file system gives no locks.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

// Every command that writes an archive says so once, and refuses nothing.
TEST(NoLocks, AreToldOf) {
  if (CAROM_EMULATED) GTEST_SKIP() << "the emulator would be given the library, too";
  const Shell shell;
  // HDF5 asks for locks of its own.
  const std::string without =
      "export HDF5_USE_FILE_LOCKING=FALSE ASAN_OPTIONS=verify_asan_link_order=0; carom=\"env "
      "LD_PRELOAD=" CAROM_NO_LOCKS " $carom\"; ";
  const char* const commands[] = {
      "escape mushroom --trajectories 10 --t-max 1 --quiet",
      "diffusion lorentz-triangular --trajectories 10 --t-max 1 --quiet", "run stadium --t-max 3",
      "run stadium --t-max 3 --precision certified",
      "section ellipse-magnetic --orbits 2 --points 5"};
  for (const std::string command : commands) {
    const Outcome o = shell(without + "$carom " + command + " --force -o a.h5");
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(o.err,
              "carom: no other process is kept from writing 'a.h5': its file system gives no locks "
              "(No locks available)\n")
        << command;
    EXPECT_FALSE(shell.exists("a.h5.part"));
    EXPECT_EQ(shell("$carom " + command + " --force -o a.h5").err, "") << command;
  }
  shell("$carom escape mushroom --trajectories 10 --t-max 1 --shard 1/2 --quiet -o part.h5");
  EXPECT_NE(shell(without + "$carom merge all.h5 part.h5").err.find("'all.h5'"), std::string::npos);
  EXPECT_NE(shell(without + "$carom escape --resume all.h5").err.find("'all.h5'"),
            std::string::npos);
  // What is complete is only shown.
  EXPECT_EQ(shell(without + "$carom escape --resume part.h5").err, "");
}

}  // namespace
}  // namespace carom
