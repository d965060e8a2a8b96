// carom escape --splitting as a user sees it.
#include <gtest/gtest.h>

#include "program.hpp"

namespace carom {
namespace {

TEST(SplittingCommand, PrintsItsKeysAndOneDigest) {
  const Shell shell;
  const std::string command =
      "$carom escape three-disc --splitting hits:lin:0:6:7 --population 300 --repetitions 4 --json";
  const Outcome one = shell(command + " --threads 1"), two = shell(command + " --threads 2");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_TRUE(is_json_object(one.out));
  for (const char* key :
       {"version", "seconds", "levels", "population", "repetitions", "kick", "lookback", "rejected",
        "kick_cost", "lost", "collisions", "digest", "survival_hits", "fit"})
    EXPECT_NE(json_value(one.out, key), "") << key;
  for (const char* key : {"digest", "kick", "survival_hits", "fit"})
    EXPECT_EQ(json_value(one.out, key), json_value(two.out, key)) << key;
  EXPECT_EQ(json_value(one.out, "levels"), "\"hits\"");
  EXPECT_NE(json_value(one.out, "fit").find("stderr"), std::string::npos);
  EXPECT_TRUE(shell.files().empty());
}

// The kick is chosen where none is given, and what is given is taken.
TEST(SplittingCommand, ChoosesItsKick) {
  const Shell shell;
  const std::string command =
      "$carom escape three-disc --splitting hits:lin:0:8:9 --population 500 --repetitions 2 "
      "--json ";
  const auto kick = [&](const char* more) {
    return std::stod(json_value(shell(command + more).out, "kick"));
  };
  EXPECT_EQ(kick("--kick 0.01"), 0.01);
  const double two = kick("--lookback 2"), four = kick("--lookback 4");
  EXPECT_LE(two, 0x1p-9);
  EXPECT_LT(four, two / 4) << "each hit stretches by about 10";
  EXPECT_GT(four, two / 1024);
}

// 0 +- 0 would say that survival is impossible.
TEST(SplittingCommand, SaysThatItsPopulationsDiedOut) {
  const Shell shell;
  const std::string command =
      "$carom escape three-disc --splitting hits:0,30,60 --population 10 --repetitions 2 ";
  const Outcome json = shell(command + "--json"), text = shell(command);
  EXPECT_EQ(json.status, 0) << json.err;
  const std::string points = json_value(json.out, "survival_hits");
  const std::string after = points.substr(points.find("\"n\": 30"));
  EXPECT_EQ(after.find("\"value\": 0"), std::string::npos) << points;
  EXPECT_NE(after.find("\"value\": null"), std::string::npos) << points;
  EXPECT_NE(points.find("\"value\": 0."), std::string::npos) << "after the first hit some are left";
  EXPECT_NE(json_value(json.out, "note"), "") << json.out;
  EXPECT_NE(json_value(json.out, "fit").find("\"model\": null"), std::string::npos) << json.out;
  EXPECT_NE(json.err, "") << "populations of 10 are small";
  EXPECT_EQ(text.out.find("0.0000e+00"), std::string::npos) << text.out;
  const Outcome by_time = shell(
      "$carom escape three-disc --splitting 100,200 --times 0,50,150,250,350 --population 10 "
      "--repetitions 2 --t-max 350 --json");
  EXPECT_EQ(by_time.status, 0) << by_time.err;
  EXPECT_NE(json_value(by_time.out, "rate").find("null"), std::string::npos) << by_time.out;
  EXPECT_NE(json_value(by_time.out, "fit").find("\"model\": null"), std::string::npos)
      << by_time.out;
}

TEST(SplittingCommand, RefusesWhatItCannotDo) {
  const Shell shell;
  for (const auto& [options, key] : {std::pair{"--splitting 5,4", "splitting"},
                                     {"--splitting hits:lin:0:5", "--splitting"},
                                     {"--splitting 1,2 --population 1", "--population"},
                                     {"--splitting 1,2 --repetitions 1", "--repetitions"},
                                     {"--splitting 1,2 --kick 2", "kick"},
                                     {"--splitting 1,2 --lookback 9", "lookback"},
                                     {"--splitting 1,2 -o a.h5", "--output"},
                                     {"--splitting 1,2 --trajectories 100", "--population"},
                                     {"--splitting 1,2 --isa baseline", "--isa"},
                                     {"--splitting hits:1,2 --times 1,2", "--times"},
                                     {"--kick 0.1", "--kick"},
                                     {"--population 100", "--population"}}) {
    const Outcome o = shell(std::string("$carom escape magnetic-square ") + options);
    EXPECT_EQ(o.status, 1) << options;
    EXPECT_EQ(o.out, "") << options;
    EXPECT_NE(o.err.find(key), std::string::npos) << o.err;
  }
  EXPECT_TRUE(shell.files().empty());
}

}  // namespace
}  // namespace carom
