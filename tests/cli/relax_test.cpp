// carom relax as a user sees it.
#include <gtest/gtest.h>

#include <string>

#include "program.hpp"

namespace carom {
namespace {

TEST(RelaxCommand, PrintsItsKeysAndStoresItsEquilibria) {
  const Shell shell;
  const std::string command = "$carom relax wigner --starts 20 --json ";
  const Outcome o = shell(command + "--threads 1 -o a.h5");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(is_json_object(o.out));
  EXPECT_EQ(json_value(o.out, "starts"), "20");
  EXPECT_EQ(json_value(o.out, "without"), "0");
  EXPECT_NE(o.out.find("\"kind\": \"minimum\""), std::string::npos);
  for (const char* key : {"version", "seed", "seconds", "status", "energy", "energy_error",
                          "positions", "walls", "frequencies", "growths", "found", "archive"})
    EXPECT_NE(o.out.find('"' + std::string(key) + "\": "), std::string::npos) << key;
  const Outcome two = shell(command + "--threads 2 -o b.h5");
  const auto equilibria = [](const Outcome& of) {
    const std::size_t from = of.out.find("\"equilibria\"");
    return of.out.substr(from, of.out.find("\"archive\"") - from);
  };
  EXPECT_EQ(equilibria(o), equilibria(two));
  const Outcome same = shell("h5diff --exclude-path /provenance a.h5 b.h5 2>&1 || echo differ");
  if (same.out.find("not found") == std::string::npos) {
    EXPECT_EQ(same.out, "");
  }
  EXPECT_EQ(shell("$carom relax wigner --starts 5 -o a.h5").status, 1);  // it exists
}

TEST(RelaxCommand, RefusesWhatHasNoEquilibria) {
  const Shell shell;
  expect_refused(shell("$carom relax stadium"), "potential: ");
  expect_refused(shell("$carom relax wigner --starts 0"), "command line: --starts: ");
  EXPECT_EQ(shell("$carom relax wigner --t-max 5").status, 2);
  EXPECT_EQ(shell("$carom escape stadium --saddles").status, 2);
}

/// Nothing moves: no step is chosen, and no energy is needed.
TEST(RelaxCommand, NeedsNeitherAStepNorAnEnergy) {
  const Shell shell;
  const Outcome low = shell("$carom relax wigner --set particles.energy=0.1 --starts 5 --json");
  EXPECT_EQ(low.status, 0) << low.err;
  EXPECT_EQ(json_value(low.out, "without"), "0");
  shell(
      "printf '[[potential]]\\nkind = \"harmonic\"\\n[interaction]\\nkind = \"coulomb\"\\n"
      "[particles]\\ncount = 3\\nenergy = 0.01\\n[initial]\\nkind = \"rectangle\"\\nmin = [-1, "
      "-1]\\n"
      "max = [1, 1]\\n' > low.toml");
  const Outcome chosen = shell("$carom relax ./low.toml --starts 5 --json -o low.h5");
  EXPECT_EQ(chosen.status, 0) << chosen.err;
  EXPECT_EQ(json_value(chosen.out, "without"), "0");
}

TEST(RelaxCommand, TellsOfWallsAndSaddles) {
  const Shell shell;
  const Outcome wall =
      shell("$carom relax coulomb-circle --set particles.count=3 --starts 5 --json");
  EXPECT_NE(wall.out.find("[\"circle\", \"circle\", \"circle\"]"), std::string::npos) << wall.out;
  const Outcome saddles = shell("$carom relax soft-lorentz --saddles --starts 20 --json");
  EXPECT_NE(saddles.out.find("\"saddle\""), std::string::npos) << saddles.out;
}

}  // namespace
}  // namespace carom
