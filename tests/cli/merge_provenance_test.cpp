// What merging keeps of its parts, and what is equal though it is written differently.
#include <gtest/gtest.h>

#include "kill_and_resume.hpp"

namespace carom {
namespace {

const std::string stadium = "$carom escape stadium --trajectories 300 --quiet --json ";

TEST(MergedParts, MayWriteEqualNumbersDifferently) {
  const Shell shell;
  ASSERT_EQ(shell(stadium + "--t-max 10 --shard 1/3 -o 1.h5 && " + stadium + "--t-max 10.0 --shard 2/3 -o 2.h5 && " + stadium +
                  "--t-max 20/2 --shard 3/3 -o 3.h5 && " + stadium + "--t-max 10 -o whole.h5 && " + stadium +
                  "--t-max 10.01 --shard 2/3 -o other.h5").status, 0);
  const auto whole = datasets(shell, "whole.h5");
  for (const std::string order : {"1.h5 2.h5 3.h5", "3.h5 2.h5 1.h5", "2.h5 3.h5 1.h5"}) {
    const Outcome o = shell("$carom merge sum.h5 --force --json " + order);
    EXPECT_EQ(o.status, 0) << o.err;
    if (o.status == 0) expect_same_datasets(shell.folder() + "/sum.h5", whole);  // /system is one of them
  }
  const Outcome same = shell("$carom escape --resume 1.h5 --t-max 1e1");
  EXPECT_EQ(same.status, 0) << same.err;
  const Outcome other = shell("$carom merge no.h5 1.h5 other.h5");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("run.t_max is 10.01, not 10"), std::string::npos) << other.err;
}

// Names are no numbers.
TEST(MergedParts, MayNotNameHolesDifferently) {
  const Shell shell;
  const std::string hole = "--t-max 9 --set 'table.hole=[{wall=\"right\",center=\"pi/2\",width=0.5,name=\"";
  ASSERT_EQ(shell(stadium + hole + "1\"}]' --shard 1/2 -o 1.h5 && " + stadium + hole + "1.0\"}]' --shard 2/2 -o 2.h5").status, 0);
  const Outcome o = shell("$carom merge sum.h5 1.h5 2.h5");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("table.hole differs"), std::string::npos) << o.err;
}

}  // namespace
}  // namespace carom
