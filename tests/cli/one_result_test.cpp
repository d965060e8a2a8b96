// On any threads, ranks, instruction sets and blocks, in parts and after interruptions: one digest
// and equal datasets.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "archive_contents.hpp"
#include "processes.hpp"
#include "program.hpp"
#include "soak.hpp"

namespace carom {
namespace {

struct Way {
  int processes = 0, threads = 1;
  std::string block, isa;
};

// All ways of this machine; without CAROM_SOAK every so many of them, and none of one process under
// mpirun, each start of which takes a second. A number that 2 and 3 do not divide meets each set.
std::vector<Way> ways_to_run(const Shell& shell, std::size_t every) {
  std::vector<std::string> sets;
  for (const std::string isa : {"baseline", "avx2", "avx512"})
    if (shell("$carom escape circle --trajectories 1 --isa " + isa).status == 0)
      sets.push_back(isa);
  std::vector<Way> all, some;
  for (const int processes : {0, 1, 2, 4}) {
    if ((processes > 0 && !has_mpi()) || (processes == 1 && !tests::soak())) continue;
    for (const int threads : {1, 2})
      for (const std::string block : {"7", "1024"})
        for (const std::string& isa : sets) all.push_back({processes, threads, block, isa});
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % every == 0 || tests::soak()) some.push_back(all[i]);
  return some;
}

// `command` with its system and options: some tenths of a second of computing.
void expect_one_result(const std::string& command, const std::string& options, std::size_t every) {
  const Shell shell;
  const std::string run_it = "$carom " + command + " " + options + " --quiet --json ";
  ASSERT_EQ(shell(run_it + "-o whole.h5").status, 0);
  const auto whole = open_archive(shell.folder() + "/whole.h5").datasets;
  int number = 0, interrupted = 0;
  for (const Way& way : ways_to_run(shell, every)) {
    const std::string run = ranks(way.processes) + run_it + "--threads " +
                            std::to_string(way.threads) + " --block " + way.block + " --isa " +
                            way.isa;
    SCOPED_TRACE(run);
    const Outcome one = shell("rm -rf *.h5.* one.h5; " + run + " -o one.h5");
    EXPECT_EQ(one.status, 0) << one.err;
    expect_same_datasets(shell.folder() + "/one.h5", whole);
    const std::string order = number++ % 2 == 0 ? "3.h5 1.h5 2.h5" : "2.h5 3.h5 1.h5";
    const Outcome parts =
        shell("rm -f ?.h5 all.h5; for k in 1 2 3; do " + run +
              " --shard $k/3 -o $k.h5 || exit 9; done; $carom merge all.h5 " + order);
    EXPECT_EQ(parts.status, 0) << parts.err;
    expect_same_datasets(shell.folder() + "/all.h5", whole);
    // The first of the ranks: mpirun itself would soon end them all.
    const std::string process = way.processes > 0 ? "$(children_of $pid | head -1)" : "$pid";
    const std::string saved = way.processes > 1 ? "r.h5.part/rank-1" : "r.h5";
    bool ended = true;
    for (int tries = 0; ended && tries < 5; ++tries) {
      shell("rm -rf r.h5*; " + run + " -o r.h5 --checkpoint blocks:1 & pid=$!; until_saved " +
            saved + "; kill -INT " + process + "; wait $pid");
      ended = shell.exists("r.h5") && open_archive(shell.folder() + "/r.h5").complete != 0;
    }
    interrupted += !ended;
    const Outcome end =
        shell(ranks(way.processes) + "$carom " + command + " --resume r.h5 --threads 2");
    EXPECT_EQ(end.status, 0) << end.err;
    expect_same_datasets(shell.folder() + "/r.h5", whole);
  }
  EXPECT_GT(2 * interrupted, number) << "most ended before they were interrupted";
  testing::Test::RecordProperty("ways", number);
  testing::Test::RecordProperty("interrupted", interrupted);
}

TEST(OneResult, EscapesHaveOneResult) {
  expect_one_result("escape", "magnetic-square --trajectories 2000 --t-max 1e5 --per-trajectory",
                    13);
}

TEST(OneResult, EscapesUnderForcesHaveOneResult) {
  expect_one_result("escape", "soft-lorentz --trajectories 200 --t-max 30 --per-trajectory", 19);
}

TEST(OneResult, DiffusionHasOneResult) {
  expect_one_result("diffusion", "lorentz-triangular --trajectories 600 --t-max 4e4", 19);
}

TEST(OneResult, DiffusionUnderForcesHasOneResult) {
  expect_one_result("diffusion", "soft-lorentz --trajectories 200 --t-max 50", 19);
}

}  // namespace
}  // namespace carom
