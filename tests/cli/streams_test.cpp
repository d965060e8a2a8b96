// Standard streams that are closed or full: messages are lost, and nothing else.
#include <gtest/gtest.h>

#include "kill_and_resume.hpp"

namespace carom {
namespace {

const Ensemble mushroom{"escape", "mushroom --trajectories 1.5e5 --t-max 4000"};

// Without a standard error, the records would be the file that messages go into.
TEST(Streams, ClosedStreamsAreNotTakenForFiles) {
  const Shell shell;
  const Undisturbed whole(shell, mushroom, " --per-trajectory");
  const Outcome o = shell(until_records_are_full(mushroom) + " >&- 2>&-");
  EXPECT_EQ(o.status, 1);
  ASSERT_TRUE(shell.exists("a.h5.part/checkpoint.h5"));
  const Outcome end = shell("$carom" + mushroom.on("a.h5"));
  EXPECT_EQ(end.status, 0) << end.err;
  expect_same_datasets(shell.folder() + "/a.h5", whole.contents);
}

TEST(Streams, AResultThatNobodyGetsIsAnError) {
  const Shell shell;
  const Outcome o = shell("$carom escape stadium --trajectories 100 --t-max 9 >&-");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.err.rfind("carom: ", 0), 0u) << o.err;
}

// As other programs in a pipe: silently, by the signal, and with all else done.
TEST(Streams, AReaderThatLeavesEndsTheProgramSilently) {
  const Shell shell;
  const Outcome o = shell(
      "mkfifo pipe; head -c 1 pipe >first & "
      "$carom escape stadium --trajectories 100 --t-max 9 --times lin:0:9:50000 -o a.h5 >pipe; "
      "echo $?");
  EXPECT_EQ(o.out, "141\n");
  EXPECT_EQ(o.err.find("carom: "), std::string::npos) << o.err;
  EXPECT_EQ(shell("$carom escape --resume a.h5 --json | grep -c '\"completed\"'").out, "1\n");
}

TEST(Streams, AWarningThatNobodyReadsEndsNothing) {
  const Shell shell;
  // A folder in its way costs a checkpoint or two; where it stands there for long, because the
  // machine is busy, the run gives up.
  Outcome o;
  for (int tries = 0; tries < 10 && o.status != 130; ++tries)
    o = shell(
        "rm -rf a.h5*; $carom escape mushroom --trajectories 1e9 --quiet --json -o a.h5 "
        "--checkpoint 0.4 2>/dev/full & pid=$!; "
        "until_saved a.h5; until mkdir a.h5.part/new; do sleep 0.02; done; sleep 0.6; rmdir "
        "a.h5.part/new; "
        "kill -INT $pid; wait $pid");
  EXPECT_EQ(o.status, 130);
  EXPECT_EQ(json_value(o.out, "status"), "\"interrupted\"");
  EXPECT_EQ(shell.files().size(), 1u);
  ASSERT_EQ(shell("$carom escape stadium --trajectories 100 --t-max 9 --shard 1/2 -o 1.h5 --quiet")
                .status,
            0);
  const Outcome half = shell("$carom merge half.h5 1.h5 --json 2>/dev/full");
  EXPECT_EQ(half.status, 0);
  EXPECT_EQ(json_value(half.out, "status"), "\"incomplete\"");
}

// What is read from the disk may be anything.
TEST(Streams, RecordsOfOtherTrajectoriesAreRefused) {
  const Shell shell;
  ASSERT_EQ(shell(until_records_are_full(mushroom)).status, 1);
  ASSERT_TRUE(shell.exists("a.h5.part/checkpoint.h5"));
  const Outcome o =
      shell("head -c 7200 /dev/zero | dd of=a.h5.part/records conv=notrunc 2>/dev/null; $carom" +
            mushroom.on("a.h5"));
  expect_refused(o, "a.h5.part/records: ");
  EXPECT_FALSE(shell.exists("a.h5"));
}

}  // namespace
}  // namespace carom
