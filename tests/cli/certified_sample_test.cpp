// carom escape --certify-sample.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cli/program.hpp"

namespace carom {
namespace {

double number(const std::string& text, const std::string& key) {
  const std::string value = json_value(text, key);
  return value.empty() ? -1.0 : std::strtod(value.c_str(), nullptr);
}

TEST(CertifiedSample, FindsOrbitsThatEscapeOtherwiseAndNoBias) {
  const Shell shell;
  const std::string run = "$carom escape stadium --trajectories 500 --certify-sample 400 --quiet ";
  const Outcome json = shell(run + "--json --threads 2");
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_TRUE(is_json_object(json.out));
  EXPECT_EQ(number(json.out, "pairs"), 400);
  // Orbits of more than some 40 collisions escape after another number of them.
  EXPECT_GT(number(json.out, "other_hits"), 80);
  EXPECT_LT(number(json.out, "other_hits"), 240);
  EXPECT_GT(number(json.out, "p_value"), 1e-3);
  EXPECT_GT(number(json.out, "threshold"), number(json.out, "statistic") * 0.2);
  // Threads do not show.
  const std::string one = shell(run + "--json --threads 1").out;
  EXPECT_EQ(json_value(one, "survival"), json_value(json.out, "survival"));
  EXPECT_NE(json_value(one, "survival"), "");
  EXPECT_NE(shell(run).out, "");
}

// Before rounding has grown both curves are one.
TEST(CertifiedSample, ShortOrbitsAreTheSame) {
  const Shell shell;
  const Outcome json = shell(
      "$carom escape stadium --trajectories 200 --certify-sample 200 --t-max 8 --quiet --json");
  EXPECT_EQ(json.status, 0) << json.err;
  for (const char* key : {"other_hole", "other_hits", "other_time", "statistic"})
    EXPECT_EQ(number(json.out, key), 0) << key;
}

// Some cyclotron orbits meet no wall, and never leave in either way.
TEST(CertifiedSample, PinnedOrbitsStay) {
  const Shell shell;
  const Outcome json = shell(
      "$carom escape magnetic-square --set field.larmor_radius=0.2 --t-max 5 --quiet --json "
      "--trajectories 200 --certify-sample 200 --times 5");
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(number(json.out, "pairs"), 200);
  for (const char* key : {"undecided", "singular", "other_hole", "other_hits", "other_time"})
    EXPECT_EQ(number(json.out, key), 0) << key;
}

// Orbits into a corner without a limit end as singular, in doubles and in balls; then there is
// nothing to compare.
TEST(CertifiedSample, SaysThatNothingWasCompared) {
  const Shell shell;
  const std::string run =
      "printf '[table]\nshape = \"triangle\"\npoints = [[0, 0], [3, 0], [0, 2]]\n[run]\nt_max = "
      "10\n"
      "[initial]\nkind = \"point\"\nposition = [1, 0.5]\nvelocity = [4, -1]\n' > corner.toml; "
      "$carom escape ./corner.toml --quiet --trajectories 5 --certify-sample 5 --times 5 ";
  const Outcome json = shell(run + "--json");
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_EQ(number(json.out, "pairs"), 0);
  EXPECT_EQ(number(json.out, "singular") + number(json.out, "certified_singular"), 5);
  EXPECT_EQ(number(json.out, "undecided"), 0);
  for (const char* key : {"p_value", "statistic", "threshold"})
    EXPECT_EQ(json_value(json.out, key), "null") << key;
}

// An orbit may take hours; Ctrl-C and SIGTERM end it, in doubles as in balls.
TEST(CertifiedSample, StopsWithinAnOrbit) {
  const Shell shell;
  const char* sample =
      "$carom escape stadium --set 'table.hole=[]' --trajectories 1 --certify-sample 1 --json "
      "--times 1 ";
  for (const char* in_doubles : {"--t-max 1e12", "--t-max 1e6"}) {
    for (const char* signal : {"INT", "TERM"}) {
      const Outcome stopped =
          shell(std::string(sample) + in_doubles + " & pid=$!; until_listening; sleep 1; kill -" +
                signal + " $pid; wait $pid");
      EXPECT_EQ(stopped.status, 130) << in_doubles << signal << stopped.err;
      EXPECT_EQ(json_value(stopped.out, "status"), "\"interrupted\"");
      EXPECT_EQ(number(stopped.out, "undecided"), 0) << "it is not known to be";
    }
  }
}

TEST(CertifiedSample, RefusesWhatItCannotCertify) {
  const Shell shell;
  for (const char* wrong :
       {"stadium --certify-sample 0", "stadium --certify-sample -5", "stadium --certify-sample x",
        "stadium --trajectories 1e19 --certify-sample 1.5e18",
        "stadium --trajectories 10 --certify-sample 11", "coulomb-circle --certify-sample 10",
        "stadium --certify-sample 10 --digits 0", "stadium --certify-sample 10 -o x.h5"}) {
    const Outcome refused = shell(std::string("$carom escape ") + wrong);
    expect_refused(refused, "command line: --");
  }
}

}  // namespace
}  // namespace carom
