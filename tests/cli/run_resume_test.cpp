// Runs under forces that go on: to the bit of an undisturbed one, in archives and reports.
#include <gtest/gtest.h>

#include <string>

#include "archive_contents.hpp"
#include "program.hpp"

namespace carom {
namespace {

// Forces: the same digits of energies, and the same count of evaluations, in the archive and in the
// report.
TEST(RunResume, UnderForcesGoesOnAsIfNeverStopped) {
  const Shell shell;
  for (const char* system :
       {"henon-heiles", "wigner --set particles.energy=8",
        "coulomb-circle --set particles.count=4 --set integrator.unresolved=count",
        "antidot-magnetic", "soft-lorentz",
        "henon-heiles --set integrator.scheme=velocity-verlet --set integrator.step=0.01"})
    for (const char* sample : {"7", "0.37"}) {
      const Outcome o =
          shell(std::string("run=\"$carom run ") + system + " --set run.sample=" + sample +
                " --set run.times=[1,2] --set integrator.energy_tolerance=1 --force\"\n"
                "$run --t-max 9 -o whole.h5 --json > whole.json && $run --t-max 2.234 -o part.h5 &&"
                "$carom run --resume part.h5 --t-max 4 && $carom run --resume part.h5 --t-max 9 "
                "--json > part.json");
      EXPECT_EQ(o.status, 0) << o.err;
      expect_same_datasets(shell.folder() + "/part.h5",
                           open_archive(shell.folder() + "/whole.h5").datasets);
      const std::string whole = shell.read("whole.json"), part = shell.read("part.json");
      for (const char* key : {"steps", "force_evaluations", "energy_error", "particles"})
        EXPECT_EQ(json_value(part, key), json_value(whole, key)) << system << " " << key;
    }
}

TEST(RunResume, SaysAfterwardsThatTheStepWasChosen) {
  const Shell shell;
  shell(
      "cat > well.toml << 'END'\n[[potential]]\nkind = \"harmonic\"\nomega = 1\n[initial]\n"
      "kind = \"point\"\nposition = [1, 0]\nvelocity = [0, 0.5]\nEND\n"
      "$carom run ./well.toml --t-max 2 -o a.h5");
  const Outcome more = shell("$carom run --resume a.h5 --t-max 4 --json");
  EXPECT_EQ(json_value(more.out, "step_chosen"), "true") << more.err;
  const Outcome mine = shell(
      "$carom escape ./well.toml --set integrator.step=0.01 --trajectories 2 --t-max 1 "
      "--json -o b.h5");
  EXPECT_EQ(json_value(mine.out, "step_chosen"), "") << mine.err;
  shell("$carom escape ./well.toml --trajectories 2 --t-max 1 -o c.h5");
  EXPECT_EQ(json_value(shell("$carom escape --resume c.h5 --json").out, "step_chosen"), "true");
}

}  // namespace
}  // namespace carom
