// Outputs that are no files, or links to files elsewhere.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program.hpp"

namespace carom {
namespace {

using Names = std::vector<std::string>;

// All that write an archive; 1.h5, 2.h5 and run.h5 are there.
const Names writers = {"escape stadium --trajectories 10 --quiet -o ",
                       "escape stadium --trajectories 10 --per-trajectory --quiet -o ",
                       "diffusion lorentz-triangular --trajectories 10 --t-max 3 --quiet -o ",
                       "merge 1.h5 2.h5 -o ",
                       "section stadium --orbits 2 --points 3 --quiet -o ",
                       "run stadium --t-max 3 --quiet -o ",
                       "run --resume run.h5 --t-max 5 --quiet -o ",
                       "run stadium --precision certified --collisions 5 -o "};

void make_inputs(const Shell& shell) {
  ASSERT_EQ(shell("for k in 1 2; do $carom escape stadium --trajectories 10 --shard $k/2 --quiet "
                  "-o $k.h5 || exit 9; done; "
                  "$carom run stadium --t-max 3 -o run.h5 --quiet")
                .status,
            0);
}

struct Special {
  const char *make, *is;
};

// With --force, too, and before there is anything beside them.
void expect_refused(const Shell& shell, const Special& special, const std::string& message) {
  for (const std::string& writer : writers)
    for (const std::string force : {"", " --force"}) {
      const Outcome o =
          shell("timeout 300 $carom " + writer + "out.h5" + force + "; status=$?; test " +
                special.is + " out.h5 || exit 99; exit $status");
      EXPECT_EQ(o.status, 1) << writer << force;
      EXPECT_EQ(o.out, "") << writer;
      EXPECT_EQ(o.err.find("carom: out.h5: " + message), 0u) << writer << force << "\n" << o.err;
      EXPECT_EQ(shell.files(), (Names{"1.h5", "2.h5", "out.h5", "run.h5"})) << writer;
    }
}

TEST(NoFiles, PipesAndFoldersAreNoOutputs) {
  const Shell shell;
  make_inputs(shell);
  ASSERT_EQ(shell("mkfifo out.h5").status, 0);
  expect_refused(shell, {"mkfifo out.h5", "-p"}, "the output is a device or a pipe");
  for (const std::string command :
       {"escape --resume out.h5", "run --resume out.h5", "merge sum.h5 out.h5"}) {
    const Outcome o = shell("timeout 300 $carom " + command);
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_EQ(o.err.find("carom: out.h5: "), 0u) << o.err;
  }
  ASSERT_EQ(shell("rm out.h5 && mkdir out.h5").status, 0);
  expect_refused(shell, {"mkdir out.h5", "-d"}, "the output is a directory");
}

TEST(NoFiles, DevicesAreNoOutputs) {
  const Shell shell;
  make_inputs(shell);
  if (shell("mknod out.h5 c 1 3").status != 0) GTEST_SKIP() << "no right to make a device";
  expect_refused(shell, {"mknod", "-c"}, "the output is a device or a pipe");
}

const std::string link_and_file =
    "test -L out.h5 && test -f real/a.h5 && test ! -L real/a.h5 && test $(ls -A real | wc -l) = "
    "1";

TEST(Links, AreFollowedToTheFile) {
  const Shell shell;
  make_inputs(shell);
  ASSERT_EQ(shell("mkdir real; ln -s real/a.h5 out.h5").status, 0);
  for (const std::string& writer : writers) {
    // The file is not there, and then it is.
    const Outcome anew = shell("rm -f real/a.h5; $carom " + writer + "out.h5");
    EXPECT_EQ(anew.status, 0) << writer << "\n" << anew.err;
    EXPECT_EQ(shell(link_and_file).status, 0) << writer;
    const Outcome refused = shell("$carom " + writer + "out.h5");
    EXPECT_EQ(refused.err.find("carom: real/a.h5: "), 0u) << writer << "\n" << refused.err;
    EXPECT_EQ(shell("$carom " + writer + "out.h5 --force").status, 0) << writer;
    EXPECT_EQ(shell(link_and_file).status, 0) << writer;
    EXPECT_EQ(shell.files(), (Names{"1.h5", "2.h5", "out.h5", "real", "run.h5"})) << writer;
  }
}

TEST(Links, CheckpointsStandBesideTheFile) {
  const Shell shell;
  const std::string go_on =
      " --quiet --block 4 --checkpoint blocks:2000 & pid=$!; until_saved real/a.h5; ";
  const std::string look = "kill -9 $pid; wait $pid; ls real";
  ASSERT_EQ(
      shell("mkdir real; ln -s $PWD/real/a.h5 real/link; mv real/link .; ln -s link out.h5").status,
      0);
  const Outcome first =
      shell("$carom escape mushroom --trajectories 1e9 --per-trajectory -o out.h5" + go_on + look);
  EXPECT_EQ(first.out, "a.h5.part\n") << first.err;
  const Outcome again =
      shell("$carom escape --resume out.h5" + go_on +
            "timeout 300 $carom escape --resume real/a.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(again.status, 130) << again.err;
  EXPECT_NE(again.err.find("carom: real/a.h5: "), std::string::npos) << again.err;
  EXPECT_EQ(shell(link_and_file).status, 0);
  EXPECT_EQ(shell.files(), (Names{"link", "out.h5", "real"}));
}

TEST(Links, LinksInACircleAreRefused) {
  const Shell shell;
  const Outcome o = shell("ln -s b.h5 a.h5; ln -s a.h5 b.h5; $carom run stadium --t-max 3 -o a.h5");
  expect_refused(o, "a.h5: ");
}

// Resumed in place, a run has its copy beside the file.
TEST(Links, ARunGoesOnBehindALink) {
  const Shell shell;
  ASSERT_EQ(shell("mkdir real; ln -s real/a.h5 out.h5; $carom run mushroom --t-max 3 -o out.h5 "
                  "&& $carom run --resume out.h5 --t-max 5")
                .status,
            0);
  EXPECT_EQ(shell(link_and_file).status, 0);
}

}  // namespace
}  // namespace carom
