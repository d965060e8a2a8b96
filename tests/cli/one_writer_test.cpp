// One process at a time writes an archive, and leaves nothing behind when it ends.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "kill_and_resume.hpp"

namespace carom {
namespace {

// Starts `command`, waits for a checkpoint with trajectories in it, does `meanwhile` and kills it.
Outcome while_it_runs(const Shell& shell, const std::string& command,
                      const std::string& meanwhile) {
  return shell("$carom " + command +
               " --quiet -o q.h5 >log 2>&1 & pid=$!; "
               "until_saved q.h5 || exit 99; " +
               meanwhile +
               "\nstatus=$?; kill -9 $pid; wait $pid 2>/dev/null; rm log; exit $status");
}

const std::string endless =
    "escape mushroom --trajectories 1e9 --t-max 400 --per-trajectory --block 4 --checkpoint "
    "blocks:2000";

TEST(OneWriter, TheCheckpointOfALiveRunIsKept) {
  const Shell shell;
  ASSERT_EQ(shell("for k in 2 3; do $carom escape stadium --trajectories 100 --t-max 9 --shard "
                  "$k/3 -o s$k.h5 --quiet || exit 9; done")
                .status,
            0);
  for (const std::string other :
       {"merge q.h5 s2.h5 s3.h5 --force",
        "section ellipse-magnetic --orbits 2 --points 3 --force -o q.h5",
        "run stadium --t-max 3 --force -o q.h5",
        "run siam-photon --precision certified --digits 20 --force -o q.h5",
        "escape stadium --trajectories 10 --force -o q.h5",
        "escape stadium --trajectories 10 -o q.h5", "escape --resume q.h5"}) {
    const Outcome o = while_it_runs(shell, endless, "timeout 300 $carom " + other);
    EXPECT_EQ(o.status, 1) << other;
    EXPECT_NE(o.err.find("q.h5: "), std::string::npos) << other << "\n" << o.err;
    EXPECT_TRUE(shell.exists("q.h5.part/checkpoint.h5") && shell.exists("q.h5.part/records"))
        << other;
    // Interrupted after its first checkpoint: on a busy machine it may be long until it listens.
    const Outcome on = shell(
        "$carom escape --resume q.h5 --checkpoint blocks:20 --quiet & pid=$!; until_saved q.h5; "
        "kill -INT $pid; wait $pid");
    EXPECT_EQ(on.status, 130) << other << "\n" << on.err;
    EXPECT_EQ(shell.files(), (std::vector<std::string>{"q.h5", "s2.h5", "s3.h5"})) << other;
    shell("rm -rf q.h5*");
  }
}

// What is made in the folder of the archive is the live run's, by its own name, too.
TEST(OneWriter, TheFilesOfALiveRunAreKept) {
  const Shell shell;
  ASSERT_EQ(shell("for k in 2 3; do $carom escape stadium --trajectories 100 --t-max 9 --shard "
                  "$k/3 -o s$k.h5 --quiet || exit 9; done")
                .status,
            0);
  std::string others;
  for (const std::string name :
       {"q.h5.part", "q.h5.part/checkpoint.h5", "q.h5.part/records", "q.h5.part/new"})
    for (const std::string& command :
         {"merge " + name + " s2.h5 s3.h5",
          "section ellipse-magnetic --orbits 2 --points 3 -o " + name,
          "run stadium --t-max 3 -o " + name,
          "run siam-photon --precision certified --digits 20 -o " + name,
          "escape stadium --trajectories 10 -o " + name,
          "diffusion lorentz-triangular --trajectories 10 --t-max 3 -o " + name})
      others += "timeout 300 $carom " + command + " --force; echo status $? >&2\n";
  const Outcome o = while_it_runs(shell, endless, others);
  std::istringstream lines(o.err);
  int refused = 0;
  for (std::string line, status; std::getline(lines, line) && std::getline(lines, status);
       ++refused) {
    EXPECT_EQ(status, "status 1") << line;
    EXPECT_EQ(line.find("carom: q.h5.part"), 0u) << line;
  }
  EXPECT_EQ(refused, 24) << o.err;
  EXPECT_EQ(shell("ls q.h5.part | grep -v new").out, "carom.lock\ncheckpoint.h5\nrecords\n");
  const Outcome on = shell(
      "$carom escape --resume q.h5 --checkpoint blocks:20 --quiet & pid=$!; until_saved q.h5; kill "
      "-INT $pid; wait $pid");
  EXPECT_EQ(on.status, 130) << on.err;
  EXPECT_EQ(shell.files(), (std::vector<std::string>{"q.h5", "s2.h5", "s3.h5"}));
}

TEST(OneWriter, TheSecondOfTwoRunsIsRefused) {
  const Shell shell;
  const Outcome o = shell(
      "$carom run stadium --set 'table.hole=[]' --collisions 1e9 -o r.h5 --quiet & pid=$!; "
      "until_there r.h5; while [ $(stat -c %s r.h5) -lt 1000000 ]; do sleep 0.01; done; "
      "$carom run stadium --t-max 3 --force -o r.h5; status=$?; kill -INT $pid; wait $pid; exit "
      "$status");
  EXPECT_EQ(o.status, 1);
  EXPECT_NE(o.err.find("r.h5: "), std::string::npos) << o.err;
  EXPECT_EQ(shell.files(), std::vector<std::string>{"r.h5"});
}

// Others write aside, too: killed, they leave the checkpoint as it was.
TEST(OneWriter, AKilledSectionLeavesTheCheckpoint) {
  const Shell shell;
  while_it_runs(shell, endless, "true");
  const std::string before = shell.read("q.h5.part/checkpoint.h5");
  const Outcome o = shell(
      "$carom section ellipse-magnetic --orbits 1e6 --points 100 --force --quiet -o q.h5 & pid=$!; "
      "sleep 0.5; kill -9 $pid; wait $pid");
  EXPECT_EQ(o.status, 137) << o.err;
  EXPECT_TRUE(shell.read("q.h5.part/checkpoint.h5") == before);
  // To its end it takes the name, as --force says.
  const Outcome end =
      shell("$carom section ellipse-magnetic --orbits 2 --points 3 --force --quiet -o q.h5");
  EXPECT_EQ(end.status, 0) << end.err;
  EXPECT_EQ(shell.files(), std::vector<std::string>{"q.h5"});
}

TEST(OneWriter, ASecondStartRefusesWhatTheFirstHasMade) {
  const Shell shell;
  const Outcome o = shell(
      "for i in 1 2 3 4 5 6; do $carom escape stadium --trajectories 2000 --t-max 20 --quiet "
      "--seed $i -o a.h5 >/dev/null && echo $i >> won & done; wait");
  EXPECT_EQ(shell.read("won").size(), 2u) << shell.read("won") << o.err;
  EXPECT_EQ(shell.files(), (std::vector<std::string>{"a.h5", "won"}));
}

TEST(OneWriter, AClosedPipeLeavesTheArchiveAlone) {
  const Shell shell;
  const Outcome o = shell(
      "mkfifo pipe; true < pipe & exec 7> pipe; wait $!; rm pipe; "
      "$carom escape magnetic-square --trajectories 3e4 --per-trajectory --quiet -o g.h5 >&7; echo "
      "$? > status");
  EXPECT_EQ(shell.read("status"), "141\n");  // SIGPIPE: the reader is gone, and nothing is said
  EXPECT_EQ(o.err, "");
  EXPECT_EQ(shell.files(), (std::vector<std::string>{"g.h5", "status"}));
  EXPECT_EQ(open_archive(shell.folder() + "/g.h5").complete, 1);
}

TEST(OneWriter, CompleteRunsAreCleanedUp) {
  const Shell shell;
  shell(until_records_are_full({"escape", "mushroom --trajectories 1e6 --t-max 400"}, "q.h5"));
  // As if it had been killed between its last steps.
  ASSERT_EQ(
      shell("cp -r q.h5.part left && $carom escape --resume q.h5 --quiet && mv left q.h5.part")
          .status,
      0);
  const Outcome o = shell("$carom escape --resume q.h5 --quiet");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(shell.files(), std::vector<std::string>{"q.h5"});
}

TEST(OneWriter, ForceWithoutRecordsRemovesOldOnes) {
  const Shell shell;
  while_it_runs(shell, endless, "true");
  ASSERT_TRUE(shell.exists("q.h5.part/records"));
  const Outcome o =
      shell("$carom escape mushroom --trajectories 100 --t-max 40 --force --quiet -o q.h5");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(shell.files(), std::vector<std::string>{"q.h5"});
}

}  // namespace
}  // namespace carom
