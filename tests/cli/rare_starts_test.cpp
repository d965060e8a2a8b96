// Starts that hardly any draw finds: Ctrl-C ends the search for them.
#include <gtest/gtest.h>

#include "program.hpp"

namespace carom {
namespace {

TEST(RareStarts, AreGivenUpAtCtrlC) {
  const Shell shell;
  shell(
      "printf '[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[particles]\nenergy = "
      "1e-9\n[initial]\nkind = \"rectangle\"\n"
      "min = [0, 0]\nmax = [100, 100]\n[[potential]]\nkind = \"harmonic\"\nomega = 1\ncenter = "
      "[0.5, 0.5]\n"
      "[integrator]\nstep = 0.01\n[run]\nt_max = 5\ntrajectories = 100\n' > rare.toml");
  for (const std::string command : {"escape ./rare.toml -o a.h5", "diffusion ./rare.toml -o a.h5",
                                    "section ./rare.toml --points 5 -o a.h5"}) {
    const Outcome o =
        shell("$carom " + command +
              " --json --quiet & pid=$!; until_listening; until [ -e a.h5.part/carom.lock ] || ! "
              "kill -0 $pid; do sleep 0.02; done; sleep 0.5; "
              "kill -INT $pid; n=0; while kill -0 $pid && [ $n -lt 100 ]; do sleep 0.1; n=$((n + "
              "1)); done 2>/dev/null; "
              "kill -9 $pid 2>/dev/null; wait $pid; status=$?; rm -rf a.h5*; exit $status");
    EXPECT_EQ(o.status, 130) << command;
    EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"") << command << o.err;
    EXPECT_EQ(shell.files(), std::vector<std::string>{"rare.toml"}) << command;
  }
}

}  // namespace
}  // namespace carom
