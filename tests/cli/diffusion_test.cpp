// carom diffusion as a user sees it.
#include <gtest/gtest.h>

#include "program.hpp"

namespace carom {
namespace {

TEST(Diffusion, PrintsItsKeysAndOneDigest) {
  const Shell shell;
  const std::string command =
      "$carom diffusion lorentz-triangular --trajectories 500 --t-max 20 --json";
  const Outcome one = shell(command + " --threads 1"), two = shell(command + " --threads 2");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_TRUE(is_json_object(one.out));
  for (const char* key : {"version", "seconds", "trajectories", "lost", "collisions", "digest",
                          "msd", "fourth_moment", "correlation", "green_kubo", "D", "exponent",
                          "local_exponents", "window", "horizon", "corridors", "machta_zwanzig"})
    EXPECT_NE(json_value(one.out, key), "") << key;
  for (const char* key :
       {"digest", "msd", "fourth_moment", "correlation", "green_kubo", "D", "exponent"})
    EXPECT_EQ(json_value(one.out, key), json_value(two.out, key)) << key;
  EXPECT_EQ(json_value(one.out, "horizon"), "\"finite\"");
  EXPECT_NE(json_value(one.out, "D").find("stderr"), std::string::npos);
  EXPECT_TRUE(shell.files().empty());
}

TEST(Diffusion, SaysWhyThereIsNoCoefficient) {
  const Shell shell;
  const Outcome square =
      shell("$carom diffusion lorentz-square --trajectories 200 --t-max 20 --json");
  EXPECT_EQ(square.status, 0);
  EXPECT_EQ(json_value(square.out, "D"), "null");
  EXPECT_EQ(json_value(square.out, "horizon"), "\"infinite\"");
  const std::string reason = json_value(square.out, "reason");
  ASSERT_GT(reason.size(), 2u);
  EXPECT_NE(json_value(square.out, "corridors").find("width"), std::string::npos);
  const Outcome text = shell("$carom diffusion lorentz-square --trajectories 200 --t-max 20");
  EXPECT_NE(on_one_line(text.out).find(reason.substr(1, reason.size() - 2)), std::string::npos)
      << text.out;
  const Outcome closed = shell("$carom diffusion stadium --trajectories 200 --t-max 20 --json");
  EXPECT_EQ(json_value(closed.out, "D"), "null");
  EXPECT_NE(json_value(closed.out, "reason"), reason);
  // A field bends the flights.
  const Outcome bent =
      shell("$carom diffusion lorentz-square --trajectories 200 --t-max 20 --set field.B=1 --json");
  EXPECT_NE(json_value(bent.out, "D").find("value"), std::string::npos);
}

TEST(Diffusion, TakesTheWindowItIsTold) {
  const Shell shell;
  const std::string command =
      "$carom diffusion lorentz-triangular --trajectories 300 --times lin:1:10:10 --json ";
  const Outcome option = shell(command + "--window 2:5"),
                key = shell(command + "--set run.window=[2,5]");
  EXPECT_EQ(option.status, 0) << option.err;
  EXPECT_NE(json_value(option.out, "window").find("4"), std::string::npos) << "2, 3, 4, 5";
  EXPECT_EQ(json_value(option.out, "D"), json_value(key.out, "D"));
  for (const char* bad : {"5:2", "1", "a:b", "-1:3", "2,5"}) {
    const Outcome o = shell(command + "--window=" + bad);
    expect_refused(o, "command line: --window: ");
  }
  // Numbers are read as everywhere.
  const std::string exact = json_value(shell(command + "--window '5/2:sqrt(36)'").out, "window");
  EXPECT_NE(exact.find("\"from\": 3"), std::string::npos) << exact;
  EXPECT_NE(exact.find("\"to\": 6"), std::string::npos) << exact;
}

// Of particles that a cap has ended, those that hit often are the first.
TEST(Diffusion, DoubtsItsCoefficientUnderACap) {
  const Shell shell;
  const std::string command =
      "$carom diffusion lorentz-triangular --trajectories 200 --t-max 20 --json --collisions ";
  EXPECT_NE(json_value(shell(command + "30").out, "note"), "");
  EXPECT_EQ(json_value(shell(command + "1000000").out, "note"), "");
}

// From the walls half the integral of the correlations is .222 and not D = .170.
TEST(Diffusion, DoubtsCorrelationsOfStartsThatAreNotStationary) {
  const Shell shell;
  const std::string command = "$carom diffusion lorentz-triangular --trajectories 200 --t-max 20 ";
  const Outcome json = shell(command + "--set initial.kind=boundary --json");
  EXPECT_NE(json_value(json.out, "note").find("D(t) need not tend to D"), std::string::npos)
      << json.out;
  EXPECT_NE(json_value(json.out, "starts").find("false"), std::string::npos) << json.out;
  EXPECT_NE(on_one_line(shell(command + "--set initial.kind=boundary").out)
                .find("the starts are not stationary"),
            std::string::npos);
}

// Repeated they would be the same orbit, with an error of nothing.
TEST(Diffusion, FliesAListedStartOnce) {
  const Shell shell;
  shell(
      "printf '[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = "
      "1\n' > a.toml");
  const std::string command =
      "$carom diffusion a.toml --times lin:0:5:3 --t-max 5 --position 0,1.1 --velocity 1,1/3 "
      "--json";
  const Outcome one = shell(command), many = shell(command + " --trajectories 50");
  EXPECT_EQ(json_value(one.out, "trajectories"), "1") << one.err;
  for (const char* key : {"trajectories", "digest", "msd"})
    EXPECT_EQ(json_value(many.out, key), json_value(one.out, key)) << key;
}

// Three times are enough for a line, not for the exponent: growth as t^2 is told all the same.
TEST(Diffusion, DoubtsItsCoefficientWithFewTimes) {
  const Shell shell;
  const std::string ballistic =
      "$carom diffusion lorentz-triangular --trajectories 200 --times 0.01,0.02,0.03 ";
  const Outcome json = shell(ballistic + "--json"), text = shell(ballistic);
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_NE(json_value(json.out, "D").find("value"), std::string::npos);
  EXPECT_NE(json_value(json.out, "note"), "") << json.out;
  EXPECT_EQ(text.out.find("nan"), std::string::npos) << text.out;
}

TEST(Diffusion, TellsLackOfDataFromPhysics) {
  const Shell shell;
  const std::string command = "$carom diffusion lorentz-triangular --trajectories 3 --t-max 20 ";
  for (const char* few : {"--times 10", "--times 0,10", "--times 0", "--shard 1/4"}) {
    const Outcome o = shell(command + few + " --json");
    EXPECT_EQ(o.status, 0) << few << ": " << o.err;
    EXPECT_EQ(json_value(o.out, "D"), "null") << few;
    EXPECT_EQ(json_value(o.out, "horizon"), "\"finite\"") << few;
    EXPECT_NE(json_value(o.out, "reason"), "") << few;
  }
  for (const char* window : {"30:40", "19.9:20", "0:0.01"}) {
    const Outcome o = shell(command + "-o a.h5 --window " + window);
    expect_refused(o, "run.window: ");
  }
  EXPECT_TRUE(shell.files().empty());
}

TEST(Diffusion, WritesAnArchiveThatReadsAlike) {
  const Shell shell;
  const std::string command = "$carom diffusion lorentz-triangular --trajectories 300 --t-max 10 ";
  EXPECT_EQ(shell(command + "--threads 1 -o a.h5").status, 0);
  EXPECT_EQ(shell(command + "--threads 2 -o b.h5").status, 0);
  EXPECT_EQ(shell(command + "-o a.h5").status, 1) << "exists";
  const Outcome same = shell("h5diff --exclude-path /provenance a.h5 b.h5 2>&1 || echo differ");
  if (same.out.find("not found") == std::string::npos) {
    EXPECT_EQ(same.out, "");
  }
  EXPECT_FALSE(shell.exists("a.h5.part"));
}

// Free paths are part of the system, so archives, parts and sums of parts have them.
TEST(Diffusion, KeepsFreePathsInArchives) {
  const Shell shell;
  const std::string command =
      "$carom diffusion lorentz-square --trajectories 300 --t-max 20 --free-paths --json ";
  const std::string paths = json_value(shell(command + "-o a.h5").out, "free_paths");
  EXPECT_NE(paths.find("expected_mean"), std::string::npos);
  EXPECT_EQ(json_value(shell("$carom diffusion --resume a.h5 --json").out, "free_paths"), paths);
  shell(command + "--shard 1/2 -o b.h5");
  shell(command + "--shard 2/2 -o c.h5");
  EXPECT_EQ(json_value(shell("$carom merge c.h5 b.h5 -o d.h5 --json").out, "free_paths"), paths);
  expect_refused(shell("$carom diffusion soft-lorentz --free-paths --json"), "run.free_paths");
}

// A particle that never hits has no mean length of flights.
TEST(Diffusion, HasNoFreePathsWithoutHits) {
  const Shell shell;
  const Outcome o = shell(
      "$carom diffusion stadium --trajectories 1 --position 0,0 --velocity 0,-1 --free-paths "
      "--json -o a.h5");
  EXPECT_EQ(o.status, 0) << o.err;
  const std::string paths = json_value(o.out, "free_paths");
  EXPECT_NE(paths.find("\"mean\": {\"value\": null, \"stderr\": null}"), std::string::npos)
      << o.out;
  const Outcome again = shell("$carom diffusion --resume a.h5");
  EXPECT_NE(again.out.find("no particle has hit a wall"), std::string::npos) << again.out;
}

}  // namespace
}  // namespace carom
