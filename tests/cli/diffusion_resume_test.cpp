// Diffusion ensembles that are killed, interrupted, parted or short of disk: one digest and equal datasets.
#include <gtest/gtest.h>

#include <cstdlib>

#include "kill_and_resume.hpp"

namespace carom {
namespace {

const Ensemble lorentz{"diffusion", "lorentz-triangular --trajectories 8000 --t-max 100"};
const Ensemble soft{"diffusion", "soft-lorentz --trajectories 700 --t-max 10"};

// Five kills; fifty with CAROM_SOAK.
int kills(int few) { return std::getenv("CAROM_SOAK") ? 25 : few; }

TEST(DiffusionResume, AfterKillsIsTheUndisturbedRun) { kill_and_resume(lorentz, "", kills(3), 3); }

TEST(DiffusionResume, AfterKillsInLanesUnderForces) { kill_and_resume(soft, " --block 16", kills(2), 4); }

TEST(DiffusionResume, ADiskThatIsFullForAWhileCostsNothing) { fill_the_disk(lorentz, "", 4096); }

TEST(DiffusionResume, RefusesWhatDiffers) {
  const Shell shell;
  shell("$carom diffusion lorentz-triangular --trajectories 1e8 -o a.h5 --quiet --checkpoint 0.02 & pid=$!; "
        "until [ -e a.h5.part ]; do sleep 0.02; done; sleep 0.2; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5.part"));
  const std::pair<const char*, const char*> cases[] = {
      {"diffusion --resume a.h5 --seed 2", "run.seed is 2, not 1"},
      {"diffusion --resume a.h5 --window 1,2", "run.window"},
      {"diffusion lorentz-square --resume a.h5", "the system is lorentz-square, not lorentz-triangular"},
      {"diffusion --resume a.h5 --shard 1/2", "--shard is 1/2, not 1/1"},
      {"escape --resume a.h5", "does not hold an escape ensemble"},
      {"diffusion lorentz-triangular -o a.h5", "carom diffusion --resume a.h5"},
  };
  for (const auto& [options, message] : cases) {
    const Outcome o = shell("$carom " + std::string(options));
    EXPECT_EQ(o.status, 1) << options;
    EXPECT_EQ(o.out, "") << options;
    EXPECT_NE(o.err.find(message), std::string::npos) << options << "\n" << o.err;
  }
}

}  // namespace
}  // namespace carom
