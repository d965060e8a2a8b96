// The line of progress: what it says of the rest.
#include "files/progress.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace carom {

using namespace files;

namespace {

TEST(Progress, EstimatesTheRestFromThisProcessAlone) {
  EXPECT_DOUBLE_EQ(seconds_left(10.0, 0.0, 0.25), 30.0);
  // Nine tenths were there before: half of the last tenth took ten seconds.
  EXPECT_NEAR(seconds_left(10.0, 0.9, 0.95), 10.0, 1e-9);
  EXPECT_LT(seconds_left(10.0, 0.9, 0.9), 0.0);
  EXPECT_LT(seconds_left(10.0, 0.0, 1.0), 0.0);
}

// Standard error is a terminal here, whatever the test's own is.
TEST(Progress, SaysThatItIsAtWorkWhileNothingIsShown) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY), before = dup(STDERR_FILENO);
  if (terminal < 0) GTEST_SKIP() << "no terminals";  // as under qemu-user
  ASSERT_EQ(grantpt(terminal), 0);
  ASSERT_EQ(unlockpt(terminal), 0);
  const int side = open(ptsname(terminal), O_RDWR | O_NOCTTY);
  ASSERT_GE(side, 0);
  std::fflush(stderr);
  ASSERT_GE(dup2(side, STDERR_FILENO), 0);
  std::string seen;
  {
    const Progress progress(true);
    char text[256];
    pollfd wait{terminal, POLLIN, 0};
    if (poll(&wait, 1, 60'000) == 1)
      seen.assign(
          text, static_cast<std::size_t>(std::max<ssize_t>(0, read(terminal, text, sizeof text))));
  }
  std::fflush(stderr);
  dup2(before, STDERR_FILENO);
  for (const int file : {terminal, before, side}) close(file);
  EXPECT_NE(seen.find("so far"), std::string::npos) << seen;
}

}  // namespace
}  // namespace carom
