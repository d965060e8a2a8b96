// The decay that carom escape fits: parts, archives and windows.
#include <gtest/gtest.h>

#include "program.hpp"

namespace carom {
namespace {

// From "fit", or another key, to the end of its list of alternatives.
std::string fit_of(const std::string& json, const std::string& key = "fit") {
  const std::size_t begin = json.find("\"" + key + "\": ");
  return begin == std::string::npos
             ? ""
             : json.substr(begin, json.find(']', json.find("alt", begin)) - begin);
}
std::string value(const std::string& fit, const std::string& key) {
  const std::size_t begin = fit.find("\"" + key + "\": ") + key.size() + 4;
  return fit.substr(begin, fit.find_first_of(",}", begin) - begin);
}

const std::string circle = "$carom escape circle --trajectories 2e5 --quiet --json ";

TEST(Decay, OfTheCircleIsAPower) {
  const Shell shell;
  const Outcome o = shell(circle);
  ASSERT_EQ(o.status, 0) << o.err;
  const std::string fit = fit_of(o.out);
  EXPECT_EQ(value(fit, "model"), "\"power\"") << fit;
  EXPECT_NEAR(std::stod(value(fit, "exponent")), 1.0, 4 * std::stod(value(fit, "stderr")));
}

TEST(Decay, OfTheStadiumHasNoPlateau) {
  const Shell shell;
  const Outcome o = shell("$carom escape stadium --trajectories 2e5 --seed 2 --quiet --json");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out.find("plateau"), std::string::npos) << fit_of(o.out);
}

TEST(Decay, OfAShortWindowIsALocalSlope) {
  const Shell shell;
  const std::string wide = circle + "--window 100:300", narrow = circle + "--window 100:150";
  EXPECT_EQ(value(fit_of(shell(wide).out), "local_slope"), "false");
  EXPECT_EQ(value(fit_of(shell(narrow).out), "local_slope"), "true");
  const std::string text = shell("$carom escape circle --trajectories 2e5 --window 100:150").out;
  EXPECT_NE(text.find("    local slope: a = "), std::string::npos) << text;
  const std::string sweep = shell(
                                "$carom escape circle --trajectories 2e5 --window 100:150 --sweep "
                                "table.radius=list:1,1.1")
                                .out;
  EXPECT_NE(sweep.find("power, local"), std::string::npos) << sweep;
  EXPECT_NE(sweep.find("  local: the slope in a window"), std::string::npos) << sweep;
}

TEST(Decay, OfPartsIsThatOfTheWhole) {
  const Shell shell;
  const std::string report = shell(circle).out;
  const std::string whole = fit_of(report), by_hits = fit_of(report, "fit_hits");
  ASSERT_NE(whole, "");
  ASSERT_NE(by_hits, "");
  const Outcome parts = shell(circle + "--shard 1/2 -o a.h5 && " + circle +
                              "--shard 2/2 -o b.h5 && $carom merge b.h5 a.h5 -o c.h5 --json");
  ASSERT_EQ(parts.status, 0) << parts.err;
  const std::string merged = parts.out.substr(parts.out.rfind("\"system\""));
  EXPECT_EQ(fit_of(merged), whole);
  EXPECT_EQ(fit_of(merged, "fit_hits"), by_hits);
  const Outcome again = shell("$carom escape --resume c.h5 --json --quiet");
  EXPECT_EQ(fit_of(again.out), whole);
  EXPECT_EQ(fit_of(again.out, "fit_hits"), by_hits);
}

TEST(Decay, TakesAWindowAlsoOfAnArchive) {
  const Shell shell;
  const std::string asked = fit_of(shell(circle + "--window 20:200 -o a.h5").out);
  EXPECT_NE(asked.find("\"window\": [20, 200"), std::string::npos) << asked;
  EXPECT_EQ(fit_of(shell("$carom escape --resume a.h5 --json --quiet").out), asked);
  const std::string other = fit_of(shell("$carom escape --resume a.h5 --window 16:128 --json").out);
  EXPECT_NE(other.find("\"window\": [16, 128]"), std::string::npos) << other;
}

TEST(Decay, SaysWhyThereIsNone) {
  const Shell shell;
  const Outcome capped = shell(circle + "--collisions 5");
  EXPECT_EQ(value(fit_of(capped.out), "model"), "null") << capped.out;
  EXPECT_NE(capped.out.find("the cap on hits"), std::string::npos);
  const Outcome closed = shell("$carom escape circle --closed --trajectories 1000 --quiet");
  EXPECT_NE(closed.out.find("No decay was fitted"), std::string::npos) << closed.out;
}

TEST(Decay, RefusesAWindowWithoutAUse) {
  const Shell shell;
  EXPECT_EQ(shell("$carom escape circle --window 5:2").status, 1);
  EXPECT_EQ(shell("$carom escape circle --window 5").status, 1);
}

}  // namespace
}  // namespace carom
