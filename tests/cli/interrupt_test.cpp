// Signals to the program.
#include <gtest/gtest.h>

#include "cli/program.hpp"

namespace carom {
namespace {

// timeout and mpirun send it to the process, and to its group.
TEST(Interrupt, SeveralTimesAtOnceIsOnce) {
  const Shell shell;
  for (int i = 0; i < 4; ++i) {
    const Outcome o = shell(
        "$carom escape stadium --set 'table.hole=[]' --t-max 1e9 --trajectories 1 "
        "--times 1 --json --quiet & pid=$!; until_listening; "
        "for n in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do kill -TERM $pid 2>/dev/null; done; "
        "wait $pid");
    EXPECT_EQ(o.status, 130) << o.err;
    EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"") << i;
  }
}

}  // namespace
}  // namespace carom
