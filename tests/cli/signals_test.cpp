// Signals by which a machine, not a user, ends a run.
#include <gtest/gtest.h>

#include <string>

#include "cli/program.hpp"

namespace carom {
namespace {

// Without an end of its own.
const char* const endless =
    "$carom escape stadium --set 'table.hole=[]' --t-max 1e3 --times 1e3 --trajectories 1e12 "
    "--threads 1 --block 16 --quiet --json -o run.h5 ";
// A checkpoint as soon as there is something to keep.
const char* const and_save = "--checkpoint blocks:1 ";

TEST(Signals, AClosedTerminalInterrupts) {
  const Shell shell;
  // The shell that runs this test may ignore hangups.
  const Outcome o = shell("carom=\"env --default-signal=HUP $carom\"; " + std::string(endless) +
                          and_save + "& pid=$!; until_saved run.h5; kill -HUP $pid; wait $pid");
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"") << o.err;
  EXPECT_TRUE(shell.exists("run.h5"));
  EXPECT_FALSE(shell.exists("run.h5.part"));
}

// nohup starts it so. A run that ends may still save what was under way, and has its archive soon.
TEST(Signals, IgnoredHangupsStayIgnored) {
  const Shell shell;
  const Outcome o =
      shell(std::string("trap '' HUP; ") + endless + and_save +
            "& pid=$!; until_saved run.h5; kill -HUP $pid; n=0; while [ $n -lt 20 ] && until_saved "
            "run.h5; do n=$((n + 1)); done; "
            "[ $n = 20 ] && [ ! -e run.h5 ] && echo went on >&2; kill -TERM $pid; wait $pid");
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_NE(o.err.find("went on"), std::string::npos) << o.err;
}

// It comes every second until the hard limit.
TEST(Signals, TheSoftLimitOfProcessorTimeInterrupts) {
  const Shell shell;
  const Outcome o = shell(std::string("ulimit -S -t 1; ") + endless);
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"") << o.err;
  EXPECT_TRUE(shell.exists("run.h5"));
}

// A table of forces takes a while, in which nothing asks whether to stop. The values before are on
// the disk.
TEST(Signals, EndASweepWhileItReadsASystem) {
  const Shell shell;
  shell(
      "cat > broad.toml <<'END'\n[lattice]\nvectors = [[1, 0], [0, 1]]\n[[potential]]\nkind = "
      "\"fermi\"\nheight = 1\nradius = 0.25\nsoftness = 0.35\nlattice = true\n[particles]\nenergy "
      "= "
      "100\n[integrator]\nstep = 0.01\n[initial]\nkind = \"uniform\"\nEND\n");
  const Outcome o = shell(
      "$carom escape ./broad.toml --sweep run.seed=list:1,2 --t-max 0.1 --trajectories 2 -o s.h5 & "
      "pid=$!; until_listening; sleep 0.1; kill -TERM $pid; wait $pid");
  // Ended by the signal while it read, or told to stop while it computed: both are at once.
  EXPECT_TRUE(o.status == 128 + 15 || o.status == 130) << o.status << o.err;
  EXPECT_EQ(shell.exists("s.h5"), o.status == 130);
  const Outcome again = shell("$carom escape --resume s.h5 --json");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json_value(again.out, "status"), "\"completed\"");
}

}  // namespace
}  // namespace carom
