// carom lyapunov as a user sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <string>

#include "kill_and_resume.hpp"
#include "processes.hpp"
#include "program.hpp"
#include "systems.hpp"

namespace carom {
namespace {

const char* const command =
    "$carom lyapunov stadium --closed --trajectories 300 --t-max 100 --json ";

TEST(Lyapunov, PrintsItsKeysAndOneDigest) {
  const Shell shell;
  const std::string typed = command;
  const Outcome one = shell(typed + "--threads 1"), two = shell(typed + "--threads 2");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_TRUE(is_json_object(one.out));
  for (const char* key :
       {"version", "seconds", "trajectories", "orbits", "lost", "collisions", "digest", "window",
        "lambda", "per_collision", "block_errors", "long_enough", "distribution", "convergence",
        "chaotic_share", "regularity", "starts", "drift", "notes"})
    EXPECT_NE(json_value(one.out, key), "") << key;
  for (const char* key : {"digest", "lambda", "per_collision", "distribution", "chaotic_share"})
    EXPECT_EQ(json_value(one.out, key), json_value(two.out, key)) << key;
  EXPECT_NE(json_value(one.out, "lambda").find("stderr"), std::string::npos);
  EXPECT_TRUE(shell.files().empty());
}

// A short run calls no orbit regular, and says what it does not know in place of a number.
TEST(Lyapunov, SaysWhatAShortRunDoesNotTell) {
  const Shell shell;
  const std::string few = "$carom lyapunov stadium --closed --trajectories 1000 --json --t-max ";
  const Outcome brief = shell(few + "20");
  EXPECT_EQ(brief.status, 0) << brief.err;
  EXPECT_EQ(json_value(brief.out, "chaotic_share"), "null");
  EXPECT_NE(json_value(brief.out, "no_share"), "");
  EXPECT_NE(json_value(brief.out, "regularity").find("\"regular\": 0"), std::string::npos);
  EXPECT_NE(json_value(brief.out, "lambda"), "null");
  const Outcome none = shell(few + "4");
  EXPECT_EQ(none.status, 0) << none.err;
  EXPECT_EQ(json_value(none.out, "lambda"), "null");
  EXPECT_NE(json_value(none.out, "reason").find("too short"), std::string::npos);
  const Outcome told = shell(few + "400 -o told.h5");
  EXPECT_NE(json_value(told.out, "chaotic_share").find("\"high\": 1"), std::string::npos);
  EXPECT_EQ(json_value(told.out, "no_share"), "");
  EXPECT_EQ(json_value(shell("$carom lyapunov --resume told.h5 --json").out, "chaotic_share"),
            json_value(told.out, "chaotic_share"));
}

// Deviations in regular tables grow linearly: ln t / t is no exponent.
TEST(Lyapunov, OfRegularTablesIsZero) {
  const Shell shell;
  for (const std::string table : {"circle", "ellipse-magnetic --set field.B=0"}) {
    const std::string typed =
        "$carom lyapunov " + table + " --closed --trajectories 100 --t-max 50 ";
    const Outcome json = shell(typed + "--json");
    EXPECT_EQ(json_value(json.out, "law"), "\"linear\"") << json.err;
    EXPECT_NE(json_value(json.out, "lambda").find("\"value\": 0"), std::string::npos);
    EXPECT_NE(shell(typed).out.find("lambda = 0: "), std::string::npos);
  }
}

// Starts on all walls have the measure of the map: those of the flow are drawn. Of others a drift
// is doubted.
TEST(Lyapunov, SaysHowItsStartsAreDistributed) {
  const Shell shell;
  const std::string typed = "$carom lyapunov stadium --closed --trajectories 20000 --t-max 400 ";
  const Outcome all = shell(typed + "--json");
  EXPECT_NE(json_value(all.out, "starts").find("uniform"), std::string::npos) << all.out;
  EXPECT_EQ(json_value(all.out, "notes").find("drift"), std::string::npos) << all.out;
  EXPECT_NE(on_one_line(shell(typed).out).find("in place of starts from all walls"),
            std::string::npos);
  const Outcome one = shell(typed + "--set initial.wall=bottom --json");
  EXPECT_NE(json_value(one.out, "notes").find("lambda still drifts: it is too small"),
            std::string::npos)
      << one.out;
  EXPECT_NE(json_value(one.out, "starts").find("false"), std::string::npos) << one.out;
}

TEST(Lyapunov, PartsOnTheDiskAddUpToTheWhole) {
  for (const char* starts : {"", "--set initial.kind=sobol "}) {
    const Shell shell;
    const std::string typed = std::string(command) + starts;
    const Outcome whole = shell(typed + "-o whole.h5");
    ASSERT_EQ(whole.status, 0) << whole.err;
    for (const char* part : {"1", "2"})
      EXPECT_EQ(shell(typed + "--shard " + part + "/2 -o part" + part + ".h5").status, 0);
    const Outcome sum = shell("$carom merge sum.h5 part2.h5 part1.h5 --json");
    EXPECT_EQ(sum.status, 0) << sum.err;
    const Outcome again = shell("$carom lyapunov --resume sum.h5 --json");
    for (const char* key : {"digest", "lambda", "per_collision", "block_errors", "distribution",
                            "chaotic_share", "regularity", "drift"}) {
      EXPECT_EQ(json_value(sum.out, key), json_value(whole.out, key)) << key;
      EXPECT_EQ(json_value(again.out, key), json_value(whole.out, key)) << key;
    }
    // The window belongs to the sums.
    EXPECT_EQ(shell("$carom lyapunov --resume whole.h5 --window 50:100").status, 1);
  }
}

TEST(Lyapunov, AKilledRunEndsAsTheUndisturbedOne) {
  kill_and_resume({"lyapunov", "stadium --closed --trajectories 6000 --t-max 2e3"}, "", 2, 5);
}

// Of a system that ends before anything can be measured there is no number: nothing is written.
TEST(Lyapunov, RefusesWhatEndsTooEarly) {
  const Shell shell;
  const std::string typed = "$carom lyapunov three-disc --json -o none.h5 ";
  expect_refused(shell(typed + "--trajectories 50"), "run.trajectories");
  expect_refused(shell(typed + "--trajectories 20000 --t-max 5"), "run.t_max");
  expect_refused(shell(typed + "--trajectories 20000 --set 'table.centers=[[0,0]]'"), "table");
  EXPECT_TRUE(shell.files().empty());
  // Nor from parts, which say nothing alone.
  if (has_mpi()) expect_refused(shell(ranks(2) + typed + "--trajectories 50"), "run.trajectories");
  EXPECT_TRUE(shell.files().empty());
  for (const char* part : {"1", "2"})
    EXPECT_EQ(shell("$carom lyapunov three-disc --trajectories 50 --shard " + std::string(part) +
                    "/2 -o part" + part + ".h5")
                  .status,
              0);
  expect_refused(shell("$carom merge sum.h5 part1.h5 part2.h5 --json"), "run.trajectories");
  EXPECT_FALSE(shell.exists("sum.h5"));
  expect_refused(shell("$carom lyapunov stadium --window 5:20 --t-max 10"), "run.window");
}

// Where the cap on hits ends the particles, a longer time helps none of them.
TEST(Lyapunov, AdvisesWhatLetsParticlesGoOn) {
  const Shell shell;
  const std::string capped = "$carom lyapunov stadium --closed --trajectories 50 --collisions ";
  const Outcome none = shell(capped + "10 --t-max 1000");
  expect_refused(none, "run.collisions");
  EXPECT_NE(none.err.find("50 of them after 10 collisions (expected more --collisions"),
            std::string::npos)
      << none.err;
  EXPECT_EQ(none.err.find("--t-max"), std::string::npos) << none.err;
  const Outcome some = shell(capped + "10 --t-max 25");
  ASSERT_EQ(some.status, 0) << some.err;
  EXPECT_NE(on_one_line(some.out).find("; more --collisions would let"), std::string::npos)
      << some.out;
  const Outcome gone = shell("$carom lyapunov stadium --trajectories 50 --t-max 4000");
  EXPECT_EQ(gone.status, 1);
  EXPECT_EQ(gone.err.find("--collisions"), std::string::npos) << gone.err;
}

// Three discs let go of all: the exponent is that of the orbits that never leave.
TEST(Lyapunov, OfTheRepellerIsTheSameOnThreadsAndFromParts) {
  const Shell shell;
  const std::string typed = "$carom lyapunov three-disc --trajectories 20000 --json ";
  const Outcome one = shell(typed + "--threads 1 -o whole.h5"), two = shell(typed + "--threads 2");
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_NE(json_value(one.out, "repeller"), "null");
  for (const char* part : {"1", "2"})
    EXPECT_EQ(shell(typed + "--shard " + part + "/2 -o part" + part + ".h5").status, 0);
  const Outcome sum = shell("$carom merge sum.h5 part2.h5 part1.h5 --json");
  const Outcome stored = shell("$carom lyapunov --resume whole.h5 --json");
  for (const char* key : {"digest", "lambda", "per_collision", "repeller", "notes"})
    for (const Outcome* other : {&two, &sum, &stored})
      EXPECT_EQ(json_value(one.out, key), json_value(other->out, key)) << key << other->err;
}

// Around islands populations have no slope: what survives late is not what survived early.
TEST(Lyapunov, OfATableWithIslandsIsThatOfOrbitsThatStay) {
  const Shell shell;
  const Outcome o = shell("$carom lyapunov magnetic-square --trajectories 2e4 --t-max 200 --json");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NE(json_value(o.out, "repeller").find("\"drifts\": true"), std::string::npos);
  const std::string lambda = json_value(o.out, "lambda");
  EXPECT_LT(std::fabs(std::stod(lambda.substr(lambda.find("value") + 8))), 0.03) << lambda;
}

// Areas are kept by every map on the way; an archive holds the whole sum.
TEST(Lyapunov, TheSpectrumComesInPairsAndGoesOnFromArchives) {
  const Shell shell;
  const std::string typed = "$carom lyapunov wigner --spectrum --trajectories 4 --t-max 10 --json ";
  const Outcome whole = shell(typed + "-o whole.h5");
  ASSERT_EQ(whole.status, 0) << whole.err;
  const std::string spectrum = json_value(whole.out, "spectrum");
  EXPECT_EQ(std::count(spectrum.begin(), spectrum.end(), '{'), 20);
  EXPECT_LT(std::stod(json_value(whole.out, "pairing")), 1e-9);
  EXPECT_NE(json_value(whole.out, "zeros").find("\"count\": 8"), std::string::npos);
  for (const char* part : {"1", "2"})
    EXPECT_EQ(shell(typed + "--shard " + part + "/2 -o part" + part + ".h5").status, 0);
  const Outcome sum = shell("$carom merge sum.h5 part2.h5 part1.h5 --json"),
                again = shell("$carom lyapunov --resume whole.h5 --json");
  for (const char* key : {"digest", "lambda", "spectrum", "entropy", "pairing", "zeros"})
    for (const Outcome* other : {&sum, &again})
      EXPECT_EQ(json_value(other->out, key), json_value(whole.out, key)) << key << other->err;
  const Outcome none = shell("$carom lyapunov wigner --trajectories 4 --t-max 10 --json");
  EXPECT_EQ(json_value(none.out, "spectrum"), "");
}

// A coarse step is doubted as everywhere; one so coarse that deviations run away is named.
TEST(Lyapunov, DoubtsAndRefusesCoarseSteps) {
  const Shell shell;
  const std::string coarse =
      "$carom lyapunov henon-heiles --set integrator.scheme=velocity-verlet --set "
      "integrator.step=0.9 --json --t-max ";
  const Outcome doubted = shell(coarse + "50");
  EXPECT_EQ(doubted.status, 3);
  EXPECT_NE(json_value(doubted.out, "energy_error"), "");
  expect_refused(shell(coarse + "300"), "integrator.step: ");
}

// Repeated they would scatter by nothing at all.
TEST(Lyapunov, TakesEachListedStartOnce) {
  const Shell shell;
  const std::string henon_heiles = "$carom lyapunov henon-heiles --t-max 300 --json --quiet ";
  const Outcome many = shell(henon_heiles + "--trajectories 50 -o a.h5");
  EXPECT_EQ(json_value(many.out, "trajectories"), "1") << many.err;
  const Outcome one = shell(henon_heiles + "--trajectories 1");
  EXPECT_EQ(json_value(one.out, "digest"), json_value(many.out, "digest"));
  EXPECT_EQ(json_value(shell("$carom lyapunov --resume a.h5 --json").out, "digest"),
            json_value(one.out, "digest"));
}

// A gas on a torus hits no wall: its contacts are what was computed, and they are stored.
TEST(Lyapunov, CountsContactsOfDiscs) {
  const Shell shell;
  std::ofstream(shell.folder() + "/gas.toml")
      << discs_on_a_torus << "t_max = 20\ntrajectories = 2\n";
  for (const std::string name : {"lyapunov", "diffusion"}) {
    const Outcome made = shell("$carom " + name + " ./gas.toml --quiet -o " + name + ".h5");
    EXPECT_TRUE(std::regex_search(
        made.out, std::regex("\n0 collisions and [1-9][0-9 ]* contacts in .*contacts/s")))
        << made.out << made.err;
    const Outcome json = shell("$carom " + name + " ./gas.toml --json"),
                  again = shell("$carom " + name + " --resume " + name + ".h5 --json");
    EXPECT_GT(std::stod(json_value(json.out, "contacts")), 10.0);
    EXPECT_EQ(json_value(json.out, "contacts"), json_value(again.out, "contacts"));
    shell("$carom " + name + " ./gas.toml --shard 1/2 -o 1.h5 --force; $carom " + name +
          " ./gas.toml --shard 2/2 -o 2.h5 --force");
    EXPECT_EQ(json_value(shell("$carom merge all.h5 1.h5 2.h5 --force --json").out, "contacts"),
              json_value(json.out, "contacts"));
  }
}

}  // namespace
}  // namespace carom
