// Shards that are merged, and ranks that fail.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "archive_contents.hpp"
#include "processes.hpp"
#include "program.hpp"
#include "sanitizers.hpp"
#include "soak.hpp"

namespace carom {
namespace {

std::map<std::string, std::string> datasets(const Shell& shell, const std::string& file) {
  return open_archive(shell.folder() + "/" + file).datasets;
}

const std::string ensemble =
    "$carom escape stadium --set run.trajectories=6000 --t-max 60 --quiet --json ";

TEST(Merge, PartsInAnyOrderGiveTheWhole) {
  for (const std::string records : {"", " --per-trajectory", " --set initial.kind=sobol"}) {
    const Shell shell;
    const Outcome o = shell(ensemble + records + " -o whole.h5 && for k in 1 2 3; do " + ensemble +
                            records + " --shard $k/3 -o $k.h5 || exit 9; done");
    ASSERT_EQ(o.status, 0) << o.err;
    const auto whole = datasets(shell, "whole.h5");
    EXPECT_EQ(open_archive(shell.folder() + "/2.h5").complete, 1);
    EXPECT_FALSE(datasets(shell, "2.h5") == whole);
    for (const char* order : {"1.h5 2.h5 3.h5", "3.h5 1.h5 2.h5"}) {
      const Outcome merged = shell("$carom merge all.h5 " + std::string(order) + " --json --force");
      EXPECT_EQ(merged.status, 0) << merged.err;
      EXPECT_EQ(merged.err, "");
      EXPECT_EQ(json_value(merged.out, "status"), "\"completed\"");
      expect_same_datasets(shell.folder() + "/all.h5", whole);
      const Contents all = open_archive(shell.folder() + "/all.h5");
      EXPECT_EQ(all.complete, 1);
      EXPECT_TRUE(all.undescribed.empty());
    }
    // In two steps; and what is missing is filled in.
    const Outcome two = shell("$carom merge -o two.h5 3.h5 1.h5 --json");
    EXPECT_EQ(two.status, 0);
    EXPECT_EQ(json_value(two.out, "status"), "\"incomplete\"");
    EXPECT_NE(two.err.find("2 000 of 6 000"), std::string::npos) << two.err;
    EXPECT_EQ(shell("$carom merge three.h5 two.h5 2.h5").status, 0);
    expect_same_datasets(shell.folder() + "/three.h5", whole);
    EXPECT_EQ(shell("$carom escape --resume two.h5").status, 0);
    expect_same_datasets(shell.folder() + "/two.h5", whole);
  }
}

TEST(Merge, RefusesWhatOverlapsOrDoesNotMatch) {
  const Shell shell;
  const Outcome o =
      shell(ensemble + "--shard 1/2 -o a.h5 && " + ensemble + "--shard 2/2 -o b.h5 && " + ensemble +
            "--shard 2/3 -o c.h5 && " + ensemble + "--shard 2/2 --seed 5 -o seed.h5 && " +
            ensemble + "--shard 2/2 --per-trajectory -o records.h5 && " + ensemble +
            "--shard 2/2 --collisions 59 -o cap.h5 && $carom run stadium --t-max 2 -o run.h5");
  ASSERT_EQ(o.status, 0) << o.err;
  const std::pair<const char*, const char*> cases[] = {
      {"a.h5 b.h5 a.h5", "a.h5: "},
      {"a.h5 c.h5", "c.h5: "},
      {"a.h5 seed.h5", "run.seed"},
      {"a.h5 cap.h5", "run.collisions"},
      {"a.h5 records.h5", "--per-trajectory"},
      {"a.h5 none.h5", "none.h5: "},
      {"a.h5 run.h5", "run.h5: "},
      {"", "merge: "},
  };
  for (const auto& [files, message] : cases) {
    const Outcome refused = shell("$carom merge all.h5 " + std::string(files));
    EXPECT_EQ(refused.status, 1) << files;
    EXPECT_EQ(refused.out, "");
    EXPECT_NE(refused.err.find(message), std::string::npos) << files << "\n" << refused.err;
    EXPECT_FALSE(shell.exists("all.h5"));
  }
  EXPECT_NE(shell("$carom merge a.h5 b.h5").err.find("--force"), std::string::npos);
  for (const char* wrong : {"0/2", "3/2", "1", "1/0", "a/b", "-1/2", "1/2/3"})
    EXPECT_EQ(shell(ensemble + "--shard " + wrong).status, 1) << wrong;
}

// A window is asked for by the report alone. In any order the sum has that of the first part.
TEST(Merge, PartsMayAskForOtherWindows) {
  const Shell shell;
  for (const std::string command :
       {"escape magnetic-square --trajectories 500 --t-max 20 ",
        "diffusion lorentz-triangular --trajectories 300 --t-max 20 "}) {
    const Outcome o = shell("rm -f *.h5; run=\"$carom " + command + "\"\n" +
                            "$run --shard 1/2 --window 2:10 -o a.h5 && $run --shard 2/2 --window "
                            "5:15 -o b.h5 && $run --window 2:10 -o all.h5 &&"
                            "$carom merge ab.h5 a.h5 b.h5 && $carom merge ba.h5 b.h5 a.h5");
    ASSERT_EQ(o.status, 0) << o.err;
    const auto whole = open_archive(shell.folder() + "/all.h5").datasets;
    expect_same_datasets(shell.folder() + "/ab.h5", whole);
    expect_same_datasets(shell.folder() + "/ba.h5", whole);
  }
  // Exponents are added up within theirs.
  const std::string lyapunov = "$carom lyapunov stadium --closed --trajectories 20 --t-max 20 ";
  shell(lyapunov + "--shard 1/2 --window 2:10 -o c.h5; " + lyapunov +
        "--shard 2/2 --window 5:15 -o d.h5");
  expect_refused(shell("$carom merge cd.h5 c.h5 d.h5"), "d.h5: ");
}

// Parts with many report times are large in memory: 145 kB a time. One by one they fit.
TEST(Merge, HoldsOnePartAtATime) {
  if (shadows_of_memory) GTEST_SKIP() << "the sanitizer takes more than the limit of memory";
  const Shell shell;
  const Outcome o = shell(
      "for k in $(seq 9); do $carom diffusion lorentz-triangular --trajectories 90 --times "
      "lin:0.01:10:500 "
      "--shard $k/9 --quiet -o $k.h5 || exit 9; done");
  ASSERT_EQ(o.status, 0) << o.err;
  const Outcome merged = shell("ulimit -v 750000; $carom merge all.h5 ?.h5 --json");
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(json_value(merged.out, "status"), "\"completed\"");
}

int count_of(const std::string& words, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
    ++count;
  return count;
}

// Twenty-five times with CAROM_SOAK. The other ranks may come to their end before mpirun ends them;
// the killed one never does.
TEST(Ranks, AKilledRankCostsTheLastBlocksAlone) {
  if (!has_mpi()) GTEST_SKIP() << "no mpirun";
  const Shell shell;
  const std::string run =
      "$carom escape stadium --trajectories 3e6 --t-max 60 --quiet --json --threads 1";
  ASSERT_EQ(shell(run + " -o whole.h5").status, 0);
  const auto whole = datasets(shell, "whole.h5");
  for (int kill = 0; kill < (tests::soak() ? 25 : 3); ++kill) {
    const bool last = kill % 2 == 0;  // of the three: mpirun starts them in their order
    const std::string victim = last ? "tail -1" : "head -1",
                      share = "a.h5.part/rank-" + std::string(last ? "2" : "0"),
                      wait = std::to_string(0.02 * kill);
    for (int tries = 0;; ++tries) {
      ASSERT_LT(tries, 20) << "it ends before it is killed";
      const Outcome killed =
          shell(ranks(3) + run + " -o a.h5 --checkpoint blocks:100 & pid=$!; until_saved " + share +
                "; sleep " + wait + "; kill -9 $(children_of $pid | " + victim + "); wait $pid");
      if (killed.status != 0 && shell.exists(share + ".part/checkpoint.h5")) break;
      shell("rm -rf a.h5*");
    }
    EXPECT_EQ(open_archive(shell.folder() + "/" + share + ".part/checkpoint.h5").complete, 0);
    const Outcome anew = shell(run + " -o a.h5");
    expect_refused(anew, "a.h5: ");
    EXPECT_NE(anew.err.find("carom escape --resume a.h5"), std::string::npos) << anew.err;
    // By the same ranks, by others, and by one process.
    const int number = std::vector{3, 2, 0}[static_cast<std::size_t>(kill % 3)];
    const Outcome end =
        shell("cp -r a.h5.part left; " + ranks(number) + "$carom escape --resume a.h5 --json");
    EXPECT_EQ(end.status, 0) << end.err;
    EXPECT_EQ(json_value(end.out, "ranks"), std::to_string(std::max(1, number)));
    expect_same_datasets(shell.folder() + "/a.h5", whole);
    EXPECT_EQ(shell.files(), (std::vector<std::string>{"a.h5", "left", "whole.h5"}));
    // As if it had been killed before it removed the shares: these are in the sum already.
    const Outcome again =
        shell("mv left a.h5.part; " + ranks(number) + "$carom escape --resume a.h5 --json");
    EXPECT_EQ(again.status, 0) << again.err;
    expect_same_datasets(shell.folder() + "/a.h5", whole);
    EXPECT_EQ(shell.files(), (std::vector<std::string>{"a.h5", "whole.h5"}));
    shell("rm a.h5");
  }
}

// `limit` of the shell for one rank alone: the others must not wait for it for ever.
Outcome with_limit(const Shell& shell, int rank, const std::string& limit,
                   const std::string& command) {
  return shell("cat > one.sh <<'END'\n[ \"$OMPI_COMM_WORLD_RANK\" = " + std::to_string(rank) +
               " ] && ulimit " + limit + "\nexec \"$@\"\nEND\n" +
               "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
               // Open MPI 5 has its shared memory in files, which the limit would meet first.
               "OMPI_MCA_btl=self,tcp OMPI_MCA_btl_tcp_if_include=lo PMIX_MCA_gds=hash "
               "ASAN_OPTIONS=detect_leaks=0 timeout 100 mpirun "
               "--oversubscribe "
               "--bind-to none -n 3 bash one.sh " +
               command);
}

TEST(Ranks, AllEndWhenOneHasNoDiskAndSayWhyOnce) {
  if (!has_mpi()) GTEST_SKIP() << "no mpirun";
  const Shell shell;
  const std::string run =
      "$carom escape stadium --trajectories 1e9 --t-max 60 --quiet --threads 1 --per-trajectory "
      "--checkpoint blocks:20 ";
  for (const int rank : {0, 1}) {
    // No room for the first checkpoint; and none for more than 2 MB of records.
    const Outcome first = with_limit(shell, rank, "-f 1", run + "-o a.h5");
    EXPECT_EQ(first.status, 1) << first.err;
    EXPECT_EQ(count_of("carom: cannot write 'a.h5", first.err), 1) << first.err;
    shell("rm -rf a.h5*");
    const Outcome later = with_limit(shell, rank, "-f 2000", run + "-o b.h5");
    EXPECT_EQ(later.status, 1) << later.err;
    EXPECT_EQ(count_of("carom: cannot write 'b.h5", later.err), 1) << later.err;
    EXPECT_NE(later.err.find("carom escape --resume b.h5"), std::string::npos) << later.err;
    const Outcome on = shell(
        "$carom escape --resume b.h5 --quiet --json --checkpoint blocks:20 & pid=$!; until_saved "
        "b.h5; kill -INT $pid; wait $pid");
    EXPECT_EQ(on.status, 130) << on.err;
    EXPECT_EQ(shell.files(), (std::vector<std::string>{"b.h5", "one.sh"}));
    shell("rm -rf b.h5*");
  }
}

// A value that cannot be kept ends the sweep of all ranks, also of those that wait for the next
// one.
TEST(Ranks, AllEndWhenASweepHasNoDisk) {
  if (!has_mpi()) GTEST_SKIP() << "no mpirun";
  const Shell shell;
  const Outcome o = with_limit(shell, 0, "-f 40",
                               "$carom escape stadium --trajectories 2000 --t-max 20 --quiet "
                               "--threads 1 --sweep run.seed=lin:1:8:8 -o a.h5");
  EXPECT_EQ(o.status, 1) << o.err;
  EXPECT_EQ(count_of("carom: cannot write 'a.h5", o.err), 1) << o.err;
}

// Without an archive the shares are in the first rank's folder for temporary files.
TEST(Ranks, AllEndWhenThereIsNoTemporaryFolder) {
  if (!has_mpi()) GTEST_SKIP() << "no mpirun";
  const Shell shell;
  const Outcome o =
      shell("cat > one.sh <<'END'\nexport TMPDIR=/nowhere\nexec \"$@\"\nEND\n" + ranks(3) +
            "timeout 60 bash one.sh $carom escape stadium --trajectories 1e9 --quiet --threads 1");
  EXPECT_EQ(o.status, 1) << o.err;
  EXPECT_EQ(o.out, "");
  EXPECT_EQ(count_of("carom: ", o.err), 1) << o.err;
}

// Where the memory ends depends on the machine, so there may even be enough; but no rank waits for
// ever.
TEST(Ranks, AllEndWhenOneHasNoMemory) {
  if (!has_mpi()) GTEST_SKIP() << "no mpirun";
  const Shell shell;
  for (const int rank : {0, 1})
    for (const std::string memory : {"300000", "450000"}) {
      const Outcome o = with_limit(shell, rank, "-v " + memory,
                                   "$carom diffusion lorentz-triangular --trajectories 1000 "
                                   "--times lin:0.01:10:1000 --quiet --threads 1 --force -o a.h5");
      EXPECT_NE(o.status, 124) << "rank " << rank << " with " << memory << " kB\n" << o.err;
      EXPECT_EQ(o.status == 0, shell.exists("a.h5")) << o.err;
      shell("rm -rf a.h5*");
    }
}

TEST(Ranks, SpeakWithOneVoice) {
  if (!has_mpi()) GTEST_SKIP() << "no mpirun";
  const Shell shell;
  const Outcome good = shell(ranks(3) + ensemble);
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_TRUE(is_json_object(good.out)) << good.out;
  const Outcome bad = shell(ranks(3) + "$carom escape stadium --set table.radius=-1");
  EXPECT_EQ(bad.status, 1);
  EXPECT_EQ(bad.err.find("carom: "), bad.err.rfind("carom: ")) << bad.err;
  const Outcome other = shell(ranks(2) + "$carom table stadium --json");
  EXPECT_EQ(other.status, 0);
  EXPECT_TRUE(is_json_object(other.out)) << other.out;
}

}  // namespace
}  // namespace carom
