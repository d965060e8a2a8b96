// What merging keeps of its parts, and what is equal though it is written differently.
#include <gtest/gtest.h>

#include "kill_and_resume.hpp"

namespace carom {
namespace {

const std::string stadium = "$carom escape stadium --trajectories 300 --quiet --json ";

// An attribute's bytes.
std::string provenance(const Shell& shell, const std::string& file, const char* name) {
  const hid_t archive = H5Fopen((shell.folder() + "/" + file).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t group = H5Gopen2(archive, "provenance", H5P_DEFAULT);
  const std::string bytes = read_attribute(group, name);
  H5Gclose(group);
  H5Fclose(archive);
  return bytes;
}

TEST(MergedParts, MayWriteEqualNumbersDifferently) {
  const Shell shell;
  ASSERT_EQ(shell(stadium + "--t-max 10 --shard 1/3 -o 1.h5 && " + stadium +
                  "--t-max 10.0 --shard 2/3 -o 2.h5 && " + stadium +
                  "--t-max 20/2 --shard 3/3 -o 3.h5 && " + stadium + "--t-max 10 -o whole.h5 && " +
                  stadium + "--t-max 10.01 --shard 2/3 -o other.h5")
                .status,
            0);
  const auto whole = datasets(shell, "whole.h5");
  for (const std::string order : {"1.h5 2.h5 3.h5", "3.h5 2.h5 1.h5", "2.h5 3.h5 1.h5"}) {
    const Outcome o = shell("$carom merge sum.h5 --force --json " + order);
    EXPECT_EQ(o.status, 0) << o.err;
    if (o.status == 0)
      expect_same_datasets(shell.folder() + "/sum.h5", whole);  // /system is one of them
  }
  const Outcome same = shell("$carom escape --resume 1.h5 --t-max 1e1");
  EXPECT_EQ(same.status, 0) << same.err;
  const Outcome other = shell("$carom merge no.h5 1.h5 other.h5");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("run.t_max"), std::string::npos) << other.err;
}

// Names are no numbers.
TEST(MergedParts, MayNotNameHolesDifferently) {
  const Shell shell;
  const std::string hole =
      "--t-max 9 --set 'table.hole=[{wall=\"right\",center=\"pi/2\",width=0.5,name=\"";
  ASSERT_EQ(shell(stadium + hole + "1\"}]' --shard 1/2 -o 1.h5 && " + stadium + hole +
                  "1.0\"}]' --shard 2/2 -o 2.h5")
                .status,
            0);
  const Outcome o = shell("$carom merge sum.h5 1.h5 2.h5");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("table.hole"), std::string::npos) << o.err;
}

TEST(MergedParts, StayNamedWhenTheSumGoesOn) {
  const Shell shell;
  ASSERT_EQ(shell("for k in 1 2 3; do " + stadium +
                  "--t-max 9 --shard $k/3 -o $k.h5 || exit 9; done; "
                  "$carom merge sum.h5 1.h5 3.h5")
                .status,
            0);
  const std::string before = provenance(shell, "sum.h5", "merged");
  EXPECT_NE(before.find("3.h5"), std::string::npos);
  ASSERT_EQ(shell("$carom escape --resume sum.h5").status, 0);
  EXPECT_EQ(provenance(shell, "sum.h5", "merged"), before);
}

// As with threads, the sum has the most of any part.
TEST(MergedParts, PartsOfTwoInstructionSetsHaveTheWider) {
  const Shell shell;
  if (shell(stadium + "--t-max 9 --shard 2/2 --isa avx2 -o 2.h5").status != 0)
    GTEST_SKIP() << "no AVX2";
  ASSERT_EQ(shell(stadium + "--t-max 9 --shard 1/2 --isa baseline -o 1.h5").status, 0);
  for (const std::string order : {"1.h5 2.h5", "2.h5 1.h5"})
    EXPECT_EQ(json_value(shell("$carom merge sum.h5 --force --json " + order).out, "isa"),
              "\"avx2\"")
        << order;
}

}  // namespace
}  // namespace carom
