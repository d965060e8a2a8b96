// The line of progress: what it says of the rest.
#include "io/progress.hpp"

#include <gtest/gtest.h>

namespace carom {
namespace {

TEST(Progress, TellsTheRestByWhatThisProcessHasDone) {
  EXPECT_DOUBLE_EQ(seconds_left(10.0, 0.0, 0.25), 30.0);
  // Nine tenths were there before: half of the last tenth took ten seconds.
  EXPECT_NEAR(seconds_left(10.0, 0.9, 0.95), 10.0, 1e-9);
  EXPECT_LT(seconds_left(10.0, 0.9, 0.9), 0.0);
  EXPECT_LT(seconds_left(10.0, 0.0, 1.0), 0.0);
}

}  // namespace
}  // namespace carom
