// An ensemble takes and removes its own files alone, whatever else has their names.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program.hpp"

namespace carom {
namespace {

using Names = std::vector<std::string>;

const std::string mushroom = "$carom escape mushroom --trajectories 2000 --t-max 20 --quiet --json ";

// Leaves q.h5.part, and q.h5.records where they are asked for.
void leave_a_checkpoint(const Shell& shell, const std::string& options) {
  shell("$carom escape mushroom --trajectories 1e9 --quiet --block 4 --checkpoint blocks:2000 -o q.h5 " + options +
        " & pid=$!; until_saved q.h5; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("q.h5.part"));
}

TEST(OwnFiles, AnArchiveMayBeCalledPart) {
  const Shell shell;
  ASSERT_EQ(shell(mushroom + "--shard 1/2 -o run1.part && " + mushroom + "--shard 2/2 -o b.h5").status, 0);
  const std::string before = shell.read("run1.part");
  const Outcome again = shell("$carom escape --resume run1.part --json");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json_value(again.out, "status"), "\"completed\"");
  EXPECT_TRUE(shell.read("run1.part") == before);
  EXPECT_EQ(shell("$carom merge --force run1 run1.part b.h5").status, 0);
  EXPECT_TRUE(shell.read("run1.part") == before);
  for (const std::string command : {"run stadium --t-max 3", "section ellipse-magnetic --orbits 2 --points 3"})
    EXPECT_EQ(shell("$carom " + command + " --quiet --force -o run1").status, 0) << command;
  EXPECT_TRUE(shell.read("run1.part") == before);
  EXPECT_EQ(shell.files(), (Names{"b.h5", "run1", "run1.part"}));
  // It is not what run1 goes on with.
  const Outcome none = shell("rm run1; $carom escape --resume run1");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("run1: there is no such file"), std::string::npos) << none.err;
}

TEST(OwnFiles, AnInterruptedArchiveCalledPartGoesOn) {
  const Shell shell;
  const Outcome o = shell(mushroom + "-o whole.h5 && for k in 1 2 3; do " + mushroom + "--shard $k/3 -o $k.h5 || exit 9; done; "
                          "$carom merge sum.part 1.h5 3.h5");
  ASSERT_EQ(o.status, 0) << o.err;
  const Outcome end = shell("$carom escape --resume sum.part --quiet --json && $carom escape --resume whole.h5 --json > whole");
  EXPECT_EQ(end.status, 0) << end.err;
  EXPECT_EQ(json_value(end.out, "digest"), json_value(shell.read("whole"), "digest"));
  EXPECT_TRUE(shell.exists("sum.part"));
  EXPECT_FALSE(shell.exists("sum"));
}

TEST(OwnFiles, ACheckpointIsFoundByItsOwnName) {
  const Shell shell;
  leave_a_checkpoint(shell, "");
  const Outcome o = shell("$carom escape --resume q.h5.part --quiet --json --checkpoint blocks:20 & pid=$!; until_saved q.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(o.status, 130) << o.err;
  EXPECT_EQ(shell.files(), Names{"q.h5"});
  // The name of a checkpoint that is over still means its archive.
  const Outcome again = shell("$carom escape --resume q.h5.part --seed 7");
  EXPECT_NE(again.err.find("run.seed is 7, not 1"), std::string::npos) << again.err;
}

// A checkpoint without records says nothing about a file of that name.
TEST(OwnFiles, RecordsThatNoCheckpointNamesStay) {
  const Shell shell;
  leave_a_checkpoint(shell, "");
  shell("echo mine > q.h5.records");
  EXPECT_EQ(shell("$carom run stadium --t-max 3 --quiet --force -o q.h5").status, 0);
  EXPECT_EQ(shell.files(), (Names{"q.h5", "q.h5.records"}));
  EXPECT_EQ(shell.read("q.h5.records"), "mine\n");
}

struct Others {
  std::string make;       ///< leaves a.h5.part or a.h5.records
  std::string told_of;    ///< what the message names
  bool forced;            ///< --force replaces it
};

TEST(OwnFiles, FilesOfOthersAreRefused) {
  const std::vector<Others> all = {
      {"echo notes > a.h5.part; echo r > a.h5.records", "a.h5.part", true},
      {"echo r > a.h5.records", "a.h5.records", true},
      {mushroom + "-o a.h5.part", "a.h5.part", false},
      {"$carom run stadium --t-max 3 -o a.h5.part", "a.h5.part", false},
      {"echo notes > a.h5.part.new", "a.h5.part.new", true},
      {mushroom + "-o a.h5.part.new", "a.h5.part.new", true},
  };
  for (const Others& one : all) {
    const Shell shell;
    ASSERT_EQ(shell(one.make).status, 0);
    shell("cp -r . ../before.$$; mv ../before.$$ before");
    for (const std::string records : {"", " --per-trajectory"}) {
      const Outcome o = shell(mushroom + "-o a.h5" + records);
      EXPECT_EQ(o.status, 1) << one.make;
      EXPECT_EQ(o.out, "");
      EXPECT_EQ(o.err.find("carom: " + one.told_of + ": "), 0u) << o.err;
      EXPECT_EQ(shell("for f in a.*; do cmp $f before/$f || exit 1; done; [ $(ls a.* | wc -l) = $(ls before | wc -l) ]").status, 0) << one.make;
    }
    const Outcome forced = shell(mushroom + "-o a.h5 --per-trajectory --force");
    EXPECT_EQ(forced.status, one.forced ? 0 : 1) << one.make << "\n" << forced.err;
    EXPECT_EQ(shell.exists("a.h5"), one.forced);
    EXPECT_EQ(shell.exists("a.h5.part"), !one.forced);
    EXPECT_FALSE(shell.exists("a.h5.records"));
    EXPECT_FALSE(shell.exists("a.h5.part.new"));
  }
}

// Whoever writes aside looks first at what stands there.
TEST(OwnFiles, WhatIsWrittenAsideReplacesNobodys) {
  const Shell shell;
  ASSERT_EQ(shell(mushroom + "--shard 1/2 -o 1.h5 && " + mushroom + "--shard 2/2 -o 2.h5 && $carom run stadium --t-max 3 -o run.h5 --quiet").status, 0);
  const std::vector<std::pair<std::string, std::string>> all = {
      {"merge a.h5 1.h5 2.h5", "a.h5.part.new"},
      {"section stadium --orbits 2 --points 3 -o a.h5", "a.h5.new"},
      {"run stadium --precision certified --collisions 5 -o a.h5", "a.h5.new"},
      {"run --resume run.h5 --t-max 5 -o a.h5", "a.h5.new"}};
  for (const auto& [command, aside] : all)
    for (const std::string& make : {"echo notes > " + aside, "cp 1.h5 " + aside}) {
      ASSERT_EQ(shell(make + "; cp " + aside + " before").status, 0);
      const Outcome o = shell("$carom " + command);
      EXPECT_EQ(o.status, 1) << command;
      EXPECT_EQ(o.err.find("carom: " + aside + ": 'a.h5' would be written here first, and this is another file"), 0u) << o.err;
      EXPECT_EQ(shell("cmp before " + aside).status, 0) << command;
      EXPECT_FALSE(shell.exists("a.h5")) << command;
      EXPECT_EQ(shell("$carom " + command + " --force").status, 0) << command;
      EXPECT_EQ(shell("rm a.h5 before && ls").out, "1.h5\n2.h5\nrun.h5\n") << command;
    }
}

// What a kill leaves there is no file of others: an archive in the making, cut anywhere.
TEST(OwnFiles, WhatAKillLeftAsideIsReplaced) {
  const Shell shell;
  leave_a_checkpoint(shell, "");
  for (const std::string left : {"head -c 700 q.h5.part", "head -c 3000 /dev/zero", "cat q.h5.part", "true"}) {
    const Outcome o = shell(left + " > a.h5.part.new; " + mushroom + "-o a.h5");
    EXPECT_EQ(o.status, 0) << left << "\n" << o.err;
    EXPECT_FALSE(shell.exists("a.h5.part.new"));
    EXPECT_EQ(shell("rm a.h5; " + left + " > a.h5.new; $carom section stadium --orbits 2 --points 3 -o a.h5; rm a.h5").status, 0) << left;
  }
  // Killed as it took the place of the checkpoint, it is whole.
  ASSERT_EQ(shell(mushroom + "-o whole.h5 && mv whole.h5 q.h5.part.new").status, 0);
  const Outcome o = shell("$carom escape --resume q.h5 --quiet --checkpoint blocks:20 & pid=$!; until_saved q.h5; kill -INT $pid; wait $pid");
  EXPECT_EQ(o.status, 130) << o.err;
}

// A checkpoint that begins as it should and cannot be read: --resume says so, --force replaces it.
TEST(OwnFiles, ADamagedCheckpointGivesWayToForce) {
  for (const std::string damage : {"truncate -s 700 q.h5.part", "printf xxxxxxxx | dd of=q.h5.part bs=1 seek=9 conv=notrunc 2>/dev/null"}) {
    const Shell shell;
    leave_a_checkpoint(shell, "");
    shell(damage);
    const Outcome resumed = shell("$carom escape --resume q.h5");
    EXPECT_EQ(resumed.status, 1);
    EXPECT_NE(resumed.err.find("q.h5.part: the file is not an archive"), std::string::npos) << resumed.err;
    const Outcome refused = shell(mushroom + "-o q.h5");
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("q.h5.part: the checkpoint of 'q.h5' would go here, and this is none"), std::string::npos) << refused.err;
    const Outcome forced = shell(mushroom + "-o q.h5 --force");
    EXPECT_EQ(forced.status, 0) << forced.err;
    EXPECT_EQ(shell.files(), Names{"q.h5"});
  }
}

TEST(OwnFiles, ALockReplacesNobodysFile) {
  const Shell shell;
  ASSERT_EQ(shell(mushroom + "--shard 1/2 -o 1.h5 && echo notes > a.h5.lock && mkdir b.h5.lock").status, 0);
  for (const std::string name : {"a.h5", "b.h5"})
    for (const std::string command : {"escape mushroom --trajectories 20 --t-max 20 -o ", "run stadium --t-max 3 -o ",
                                      "section stadium --orbits 2 --points 3 -o ", "merge --force "}) {
      const Outcome o = shell("$carom " + command + name + (command.starts_with("merge") ? " 1.h5" : ""));
      EXPECT_EQ(o.status, 1) << command;
      EXPECT_EQ(o.err.find("carom: " + name + ".lock: the lock of '" + name + "' would go here, and this is another file"), 0u) << o.err;
    }
  EXPECT_EQ(shell.files(), (Names{"1.h5", "a.h5.lock", "b.h5.lock"}));
  EXPECT_EQ(shell.read("a.h5.lock"), "notes\n");
  // One that a kill left is empty.
  EXPECT_EQ(shell(": > c.h5.lock; " + mushroom + "-o c.h5").status, 0);
  EXPECT_FALSE(shell.exists("c.h5.lock"));
}

// What stands beside a good archive neither hides nor stops it.
TEST(OwnFiles, OthersBesideAnArchiveAreLeft) {
  const Shell shell;
  ASSERT_EQ(shell(mushroom + "--shard 1/2 -o a.h5 && " + mushroom + "--shard 2/2 -o b.h5 && echo notes > a.h5.part && echo r > b.h5.records").status, 0);
  const Outcome again = shell("$carom escape --resume a.h5 --json");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json_value(again.out, "status"), "\"completed\"");
  EXPECT_EQ(shell("$carom escape --resume b.h5").status, 0);
  EXPECT_EQ(shell("$carom merge sum.h5 a.h5 b.h5").status, 0);
  EXPECT_EQ(shell.read("a.h5.part") + shell.read("b.h5.records"), "notes\nr\n");
  // What would go on needs the name.
  const Outcome half = shell("$carom merge half.h5 a.h5 && echo notes > half.h5.part && $carom escape --resume half.h5");
  EXPECT_EQ(half.status, 1);
  EXPECT_NE(half.err.find("half.h5.part: the checkpoint of 'half.h5' would go here"), std::string::npos) << half.err;
  EXPECT_EQ(shell.read("half.h5.part"), "notes\n");
}

// A run that was killed before its first checkpoint leaves records without any, which are nobody's.
TEST(OwnFiles, EmptyRecordsAreNobodys) {
  const Shell shell;
  const Outcome o = shell(": > a.h5.records; " + mushroom + "-o a.h5 --per-trajectory");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(shell.files(), Names{"a.h5"});
}

// What was begun where there is no room goes.
TEST(OwnFiles, AFullDiskLeavesNothing) {
  const Shell shell;
  ASSERT_EQ(shell(mushroom + "-o 1.h5 --shard 1/2 && $carom run stadium --t-max 3 -o run.h5 --quiet").status, 0);
  if (shell("mkdir small && mount -t tmpfs -o size=64k carom-test small").status != 0) GTEST_SKIP() << "no right to mount a small disk";
  shell("head -c 200k /dev/zero 2>/dev/null > small/filler");
  for (const std::string command :
       {"escape mushroom --trajectories 10", "escape mushroom --trajectories 10 --per-trajectory", "diffusion lorentz-triangular --trajectories 10",
        "merge 1.h5", "section stadium --orbits 2 --points 3", "run stadium --t-max 3", "run --resume run.h5 --t-max 5",
        "run stadium --precision certified --collisions 5"}) {
    const Outcome o = shell("$carom " + command + " -o small/a.h5");
    EXPECT_EQ(o.status, 1) << command;
    EXPECT_EQ(o.err.find("carom: cannot write 'small/a.h5"), 0u) << command << "\n" << o.err;
    EXPECT_NE(o.err.find("No space left on device"), std::string::npos) << command << "\n" << o.err;
    EXPECT_EQ(shell("ls small").out, "filler\n") << command;
  }
  shell("umount small");
}

}  // namespace
}  // namespace carom
