// carom lyapunov as a user sees it.
#include <gtest/gtest.h>

#include "kill_and_resume.hpp"
#include "program.hpp"

namespace carom {
namespace {

const char* const command =
    "$carom lyapunov stadium --closed --trajectories 300 --t-max 100 --json ";

TEST(Lyapunov, PrintsItsKeysAndOneDigest) {
  const Shell shell;
  const std::string typed = command;
  const Outcome one = shell(typed + "--threads 1"), two = shell(typed + "--threads 2");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_TRUE(is_json_object(one.out));
  for (const char* key : {"version", "seconds", "trajectories", "orbits", "lost", "collisions",
                          "digest", "window", "lambda", "per_collision", "block_errors",
                          "long_enough", "distribution", "chaotic_share", "regularity", "notes"})
    EXPECT_NE(json_value(one.out, key), "") << key;
  for (const char* key : {"digest", "lambda", "per_collision", "distribution", "chaotic_share"})
    EXPECT_EQ(json_value(one.out, key), json_value(two.out, key)) << key;
  EXPECT_NE(json_value(one.out, "lambda").find("stderr"), std::string::npos);
  EXPECT_TRUE(shell.files().empty());
}

TEST(Lyapunov, PartsOnTheDiskAddUpToTheWhole) {
  const Shell shell;
  const std::string typed = command;
  const Outcome whole = shell(typed + "-o whole.h5");
  ASSERT_EQ(whole.status, 0) << whole.err;
  for (const char* part : {"1", "2"})
    EXPECT_EQ(shell(typed + "--shard " + part + "/2 -o part" + part + ".h5").status, 0);
  const Outcome sum = shell("$carom merge sum.h5 part2.h5 part1.h5 --json");
  EXPECT_EQ(sum.status, 0) << sum.err;
  const Outcome again = shell("$carom lyapunov --resume sum.h5 --json");
  for (const char* key :
       {"digest", "lambda", "per_collision", "block_errors", "distribution", "regularity"}) {
    EXPECT_EQ(json_value(sum.out, key), json_value(whole.out, key)) << key;
    EXPECT_EQ(json_value(again.out, key), json_value(whole.out, key)) << key;
  }
  // The window belongs to the sums.
  EXPECT_EQ(shell("$carom lyapunov --resume whole.h5 --window 50:100").status, 1);
}

TEST(Lyapunov, AKilledRunEndsAsTheUndisturbedOne) {
  kill_and_resume({"lyapunov", "stadium --closed --trajectories 6000 --t-max 2e3"}, "", 2, 5);
}

TEST(Lyapunov, SaysWhyThereIsNone) {
  const Shell shell;
  const Outcome o = shell("$carom lyapunov three-disc --trajectories 50 --t-max 1e4 --json");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(json_value(o.out, "lambda"), "null");
  EXPECT_GT(json_value(o.out, "reason").size(), 2u);
  expect_refused(shell("$carom lyapunov stadium --window 5:20 --t-max 10"), "run.window");
}

}  // namespace
}  // namespace carom
