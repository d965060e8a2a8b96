// An ensemble takes and removes its own files alone, whatever else has their names.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program.hpp"

namespace carom {
namespace {

using Names = std::vector<std::string>;

const std::string mushroom =
    "$carom escape mushroom --trajectories 2000 --t-max 20 --quiet --json ";

// Leaves q.h5.part.
void leave_a_checkpoint(const Shell& shell, const std::string& options) {
  shell(
      "$carom escape mushroom --trajectories 1e9 --quiet --block 4 --checkpoint blocks:2000 -o "
      "q.h5 " +
      options + " & pid=$!; until_saved q.h5; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("q.h5.part/checkpoint.h5"));
}

TEST(OwnFiles, AnArchiveMayBeCalledPart) {
  const Shell shell;
  ASSERT_EQ(
      shell(mushroom + "--shard 1/2 -o run1.part && " + mushroom + "--shard 2/2 -o b.h5").status,
      0);
  const std::string before = shell.read("run1.part");
  const Outcome again = shell("$carom escape --resume run1.part --json");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json_value(again.out, "status"), "\"completed\"");
  EXPECT_TRUE(shell.read("run1.part") == before);
  // It has the name of the folder in which run1 would be made.
  for (const std::string command : {"merge run1 b.h5", "run stadium --t-max 3 --quiet -o run1",
                                    "escape stadium --trajectories 10 -o run1 --force"}) {
    const Outcome o = shell("$carom " + command);
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_EQ(o.err.find("carom: run1.part: "), 0u) << o.err;
  }
  EXPECT_TRUE(shell.read("run1.part") == before);
  EXPECT_EQ(shell.files(), (Names{"b.h5", "run1.part"}));
}

TEST(OwnFiles, AnInterruptedArchiveCalledPartGoesOn) {
  const Shell shell;
  const Outcome o = shell(mushroom + "-o whole.h5 && for k in 1 2 3; do " + mushroom +
                          "--shard $k/3 -o $k.h5 || exit 9; done; "
                          "$carom merge sum.part 1.h5 3.h5");
  ASSERT_EQ(o.status, 0) << o.err;
  const Outcome end = shell(
      "$carom escape --resume sum.part --quiet --json && $carom escape --resume whole.h5 --json > "
      "whole");
  EXPECT_EQ(end.status, 0) << end.err;
  EXPECT_EQ(json_value(end.out, "digest"), json_value(shell.read("whole"), "digest"));
  EXPECT_TRUE(shell.exists("sum.part"));
  EXPECT_FALSE(shell.exists("sum"));
}

TEST(OwnFiles, ACheckpointIsFoundByItsOwnName) {
  const Shell shell;
  leave_a_checkpoint(shell, "");
  // By the name that a shell completes, too.
  const std::string go_on = " --quiet --json --checkpoint blocks:20 & pid=$!; until_saved q.h5; ";
  const Outcome first =
      shell("$carom escape --resume q.h5.part/" + go_on + "kill -9 $pid; wait $pid");
  EXPECT_EQ(first.status, 137) << first.err;
  const Outcome o = shell("$carom escape --resume q.h5.part" + go_on + "kill -INT $pid; wait $pid");
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_EQ(shell.files(), Names{"q.h5"});
  // The name of a checkpoint that is over still means its archive.
  const Outcome again = shell("$carom escape --resume q.h5.part --seed 7");
  EXPECT_NE(again.err.find("run.seed"), std::string::npos) << again.err;
}

// Also with --force. Every command that writes asks: is FILE.part a folder of Carom's?
TEST(OwnFiles, FilesOfOthersAreRefused) {
  const Shell shell;
  ASSERT_EQ(shell(mushroom + "--shard 1/2 -o 1.h5 && " + mushroom +
                  "--shard 2/2 -o 2.h5 && $carom run stadium --t-max 3 -o run.h5 --quiet")
                .status,
            0);
  const std::vector<std::string> others = {
      "echo notes > a.h5.part",  "mkdir a.h5.part; echo notes > a.h5.part/checkpoint.h5",
      "cp 1.h5 a.h5.part",       "mkfifo a.h5.part",
      "ln -s nowhere a.h5.part", "mkdir real; ln -s real a.h5.part"};
  const std::vector<std::string> writers = {
      "escape mushroom --trajectories 20 --t-max 20 -o a.h5",
      "escape mushroom --trajectories 20 --t-max 20 --per-trajectory -o a.h5",
      "diffusion lorentz-triangular --trajectories 10 --t-max 3 -o a.h5",
      "merge a.h5 1.h5 2.h5",
      "section stadium --orbits 2 --points 3 -o a.h5",
      "run stadium --t-max 3 -o a.h5",
      "run stadium --precision certified --collisions 5 -o a.h5",
      "run --resume run.h5 --t-max 5 -o a.h5"};
  for (const std::string& other : others) {
    ASSERT_EQ(shell(other).status, 0);
    const Names before = shell.files();
    const std::string look =
        "ls -l a.h5.part; ls -lR . | grep -v '[.]out\\|[.]err'; test -p a.h5.part || cat "
        "a.h5.part a.h5.part/* 2>/dev/null; true";
    const std::string is = shell(look).out;
    for (const std::string& writer : writers)
      for (const std::string force : {"", " --force"}) {
        const Outcome o = shell("timeout 300 $carom " + writer + force);
        EXPECT_EQ(o.status, 1) << other << "\n" << writer;
        EXPECT_EQ(o.out, "") << writer;
        EXPECT_EQ(o.err.find("carom: a.h5.part: "), 0u) << writer << "\n" << o.err;
        EXPECT_EQ(shell.files(), before) << writer;
      }
    EXPECT_EQ(shell(look).out, is) << other;
    shell("rm -rf a.h5.part real");
  }
}

// What a kill leaves in the folder is replaced, whatever it is, and goes with it.
TEST(OwnFiles, FilesOfAKilledRunAreReplaced) {
  const Shell shell;
  for (const std::string left :
       {"true", ": > a.h5.part/carom.lock; head -c 700 /dev/urandom > a.h5.part/new",
        ": > a.h5.part/carom.lock; head -c 7200 /dev/zero > a.h5.part/records"})
    for (const std::string writer :
         {"escape mushroom --trajectories 20 --t-max 20 --per-trajectory",
          "section stadium --orbits 2 --points 3", "run stadium --t-max 3"}) {
      const Outcome o =
          shell("mkdir a.h5.part; " + left + "; $carom " + writer + " --quiet -o a.h5");
      EXPECT_EQ(o.status, 0) << left << "\n" << o.err;
      EXPECT_EQ(shell.files(), Names{"a.h5"}) << left;
      shell("rm a.h5");
    }
}

// What else is put into the folder stays.
TEST(OwnFiles, NotesInTheFolderStay) {
  const Shell shell;
  leave_a_checkpoint(shell, "--per-trajectory");
  ASSERT_EQ(shell("echo notes > q.h5.part/notes; " + mushroom + "-o q.h5 --force").status, 0);
  EXPECT_EQ(shell("ls q.h5.part").out, "carom.lock\nnotes\n");
  EXPECT_EQ(shell(mushroom + "-o q.h5 --force").status, 0);
  EXPECT_EQ(shell.read("q.h5.part/notes"), "notes\n");
}

// The archives of other commands, too: with --force an ensemble that was interrupted gives way.
TEST(OwnFiles, ForceReplacesACheckpoint) {
  const Shell shell;
  leave_a_checkpoint(shell, "--per-trajectory");
  ASSERT_EQ(shell("mv q.h5.part kept").status, 0);
  for (const std::string writer :
       {"compare henon-heiles --t-max 4 --schemes velocity-verlet", "orbit stadium --hits 2",
        "relax wigner --starts 2", "section stadium --orbits 2 --points 3", "run stadium --t-max 3",
        "run stadium --precision certified --collisions 5"}) {
    const Outcome o = shell("cp -r kept q.h5.part; $carom " + writer + " --quiet --force -o q.h5");
    EXPECT_EQ(o.status, 0) << writer << "\n" << o.err;
    EXPECT_EQ(shell.files(), (Names{"kept", "q.h5"})) << writer;
    shell("rm -rf q.h5*");
  }
}

// Nothing is written into the folder of another archive by its name.
TEST(OwnFiles, TheFolderIsNoPlaceForArchives) {
  const Shell shell;
  leave_a_checkpoint(shell, "");
  for (const std::string name : {"checkpoint.h5", "new", "rank-1", "mine.h5"}) {
    const Outcome o = shell("$carom run stadium --t-max 3 --force -o q.h5.part/" + name);
    EXPECT_EQ(o.status, 1) << name;
    EXPECT_EQ(o.err.find("carom: q.h5.part/" + name + ": "), 0u) << o.err;
  }
  EXPECT_EQ(shell("ls q.h5.part | grep -v new").out, "carom.lock\ncheckpoint.h5\n");
}

// A checkpoint that cannot be read: --resume says so, --force replaces it.
TEST(OwnFiles, ADamagedCheckpointGivesWayToForce) {
  for (const std::string damage :
       {"truncate -s 700 $c", "printf xxxxxxxx | dd of=$c bs=1 seek=9 conv=notrunc 2>/dev/null",
        "echo notes > $c", ": > $c"}) {
    const Shell shell;
    leave_a_checkpoint(shell, "");
    shell("c=q.h5.part/checkpoint.h5; " + damage);
    const Outcome resumed = shell("$carom escape --resume q.h5");
    EXPECT_EQ(resumed.status, 1);
    EXPECT_NE(resumed.err.find("q.h5.part/checkpoint.h5: "), std::string::npos) << resumed.err;
    const Outcome refused = shell(mushroom + "-o q.h5");
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("q.h5: "), std::string::npos) << refused.err;
    const Outcome forced = shell(mushroom + "-o q.h5 --force");
    EXPECT_EQ(forced.status, 0) << forced.err;
    EXPECT_EQ(shell.files(), Names{"q.h5"});
  }
}

// What stands beside a good archive neither hides nor stops it.
TEST(OwnFiles, OtherFilesBesideAnArchiveAreKept) {
  const Shell shell;
  ASSERT_EQ(shell(mushroom + "--shard 1/2 -o a.h5 && " + mushroom +
                  "--shard 2/2 -o b.h5 && echo notes > a.h5.part")
                .status,
            0);
  const Outcome again = shell("$carom escape --resume a.h5 --json");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json_value(again.out, "status"), "\"completed\"");
  EXPECT_EQ(shell("$carom merge sum.h5 a.h5 b.h5").status, 0);
  EXPECT_EQ(shell.read("a.h5.part"), "notes\n");
  ASSERT_EQ(shell("mkdir b.h5.part && echo notes > b.h5.part/checkpoint.h5").status, 0);
  EXPECT_EQ(shell("$carom escape --resume b.h5").status, 0);
  EXPECT_EQ(shell("rm sum.h5; $carom merge sum.h5 b.h5").status, 0);
  EXPECT_EQ(shell.read("b.h5.part/checkpoint.h5"), "notes\n");
  // What would go on needs the name.
  const Outcome half = shell(
      "$carom merge half.h5 a.h5 && echo notes > half.h5.part && $carom escape --resume half.h5");
  EXPECT_EQ(half.status, 1);
  EXPECT_NE(half.err.find("half.h5.part: "), std::string::npos) << half.err;
  EXPECT_EQ(shell.read("half.h5.part"), "notes\n");
}

// What was begun where there is no room goes.
TEST(OwnFiles, AFullDiskLeavesNothing) {
  const Shell shell;
  ASSERT_EQ(
      shell(mushroom + "-o 1.h5 --shard 1/2 && $carom run stadium --t-max 3 -o run.h5 --quiet")
          .status,
      0);
  if (shell("mkdir small && mount -t tmpfs -o size=64k carom-test small").status != 0)
    GTEST_SKIP() << "no right to mount a small disk";
  shell("head -c 200k /dev/zero 2>/dev/null > small/filler");
  for (const std::string command :
       {"escape mushroom --trajectories 10", "escape mushroom --trajectories 10 --per-trajectory",
        "diffusion lorentz-triangular --trajectories 10", "merge 1.h5",
        "section stadium --orbits 2 --points 3", "run stadium --t-max 3",
        "run --resume run.h5 --t-max 5", "run stadium --precision certified --collisions 5"}) {
    const Outcome o = shell("$carom " + command + " -o small/a.h5");
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_NE(o.err.find("'small/a.h5"), std::string::npos) << command << "\n" << o.err;
    EXPECT_EQ(shell("ls small").out, "filler\n") << command;
  }
  shell("umount small");
}

}  // namespace
}  // namespace carom
