// Diffusion ensembles that are killed, interrupted, parted or short of disk: one digest and equal
// datasets.
#include <gtest/gtest.h>

#include "kill_and_resume.hpp"
#include "soak.hpp"

namespace carom {
namespace {

const Ensemble lorentz{"diffusion", "lorentz-triangular --trajectories 8000 --t-max 2e4"};
const Ensemble soft{"diffusion", "soft-lorentz --trajectories 700 --t-max 10"};

// Five kills; fifty with CAROM_SOAK.
int kills(int few) { return tests::soak() ? 25 : few; }

TEST(DiffusionResume, AKilledRunEndsAsTheUndisturbedOne) {
  kill_and_resume(lorentz, "", kills(3), 3);
}

TEST(DiffusionResume, AKilledRunInLanesEndsAsTheUndisturbedOne) {
  kill_and_resume(soft, " --block 16", kills(2), 4);
}

TEST(DiffusionResume, ADiskThatIsFullForAWhileCostsNothing) { fill_the_disk(lorentz, "", 4096); }

TEST(DiffusionResume, RefusesWhatDiffers) {
  const Shell shell;
  shell(
      "$carom diffusion lorentz-triangular --trajectories 1e8 -o a.h5 --quiet --checkpoint "
      "blocks:1 & pid=$!; "
      "until_saved a.h5; kill -9 $pid; wait $pid");
  ASSERT_TRUE(shell.exists("a.h5.part/checkpoint.h5"));
  const std::pair<const char*, const char*> cases[] = {
      {"diffusion --resume a.h5 --seed 2", "run.seed"},
      {"diffusion lorentz-square --resume a.h5", "lorentz-square"},
      {"diffusion --resume a.h5 --shard 1/2", "--shard"},
      {"escape --resume a.h5", "a.h5.part/checkpoint.h5: "},
      {"diffusion lorentz-triangular -o a.h5", "carom diffusion --resume a.h5"},
      {"diffusion --resume a.h5 --engine steps", "--engine"},
  };
  for (const auto& [options, message] : cases) {
    const Outcome o = shell("$carom " + std::string(options));
    EXPECT_EQ(o.status, 1) << options;
    EXPECT_EQ(o.out, "") << options;
    EXPECT_NE(o.err.find(message), std::string::npos) << options << "\n" << o.err;
  }
}

// What D is taken from belongs to the report: nothing is computed for it, and the archive stays as
// it is.
TEST(DiffusionResume, TakesAnotherWindow) {
  const Shell shell;
  const std::string ensemble =
      "lorentz-triangular --trajectories 2000 --t-max 50 --times lin:1:50:50 --quiet --json";
  const Outcome whole = shell("$carom diffusion " + ensemble + " --window 5:50 -o a.h5");
  ASSERT_EQ(whole.status, 0) << whole.err;
  const std::string before = shell.read("a.h5");
  const Outcome as_it_was = shell("$carom diffusion --resume a.h5 --json"),
                other = shell("$carom diffusion --resume a.h5 --window 20:40 --json");
  EXPECT_EQ(as_it_was.status, 0) << as_it_was.err;
  EXPECT_EQ(json_value(as_it_was.out, "window"), json_value(whole.out, "window"));
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_EQ(json_value(other.out, "digest"), json_value(whole.out, "digest"));
  EXPECT_EQ(json_value(other.out, "window"),
            json_value(shell("$carom diffusion " + ensemble + " --window 20:40").out, "window"));
  EXPECT_NE(json_value(other.out, "window"), json_value(whole.out, "window"));
  EXPECT_TRUE(shell.read("a.h5") == before);
  // A system without one: that of the archive.
  EXPECT_EQ(json_value(shell("$carom diffusion " + ensemble + " --resume a.h5").out, "window"),
            json_value(whole.out, "window"));
  // On the way, too: the archive is that of the first command.
  const auto contents = datasets(shell, "a.h5");
  shell("$carom diffusion " + ensemble +
        " --window 5:50 -o b.h5 --checkpoint blocks:1 & pid=$!; until_there "
        "b.h5.part/checkpoint.h5; kill -INT $pid; wait $pid; "
        "$carom diffusion --resume b.h5 --window 20:40");
  expect_same_datasets(shell.folder() + "/b.h5", contents);
}

}  // namespace
}  // namespace carom
