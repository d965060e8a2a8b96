// carom compare and carom schemes as users call them.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "carom/integrators/scheme.hpp"
#include "cli/program.hpp"

namespace carom {
namespace {

const std::string compare =
    "$carom compare henon-heiles --t-max 4 --schemes velocity-verlet,blanes-moan-srkn6b,arkode ";

TEST(Comparisons, HaveTheKeysOfTheGuide) {
  const Shell shell;
  const Outcome o = shell(compare + "--json");
  EXPECT_EQ(o.status, 0) << o.err;
  ASSERT_TRUE(is_json_object(o.out));
  for (const char* key : {"t", "growth", "size", "speed", "reference", "longest_resolved", "error",
                          "cheapest", "fastest", "measured", "schemes"})
    EXPECT_NE(json_value(o.out, key), "") << key;
  EXPECT_EQ(json_value(o.out, "t"), "4");
}

TEST(Comparisons, AreStoredOnceAndWholly) {
  const Shell shell;
  EXPECT_EQ(shell(compare + "-o a.h5").status, 0);
  EXPECT_TRUE(shell.exists("a.h5"));
  expect_refused(shell(compare + "-o a.h5"), "a.h5");
  EXPECT_EQ(shell(compare + "-o a.h5 --force").status, 0);
  expect_refused(shell(compare + "--steps 0 -o b.h5"), "command line: --steps");
  EXPECT_FALSE(shell.exists("b.h5"));
}

TEST(Comparisons, OfFreeParticlesHaveExactFlightsAsReference) {
  const Shell shell;
  const Outcome o = shell("$carom compare stadium --closed --schemes ruth-3 --json --trajectory 2");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_NE(json_value(o.out, "reference").find("exact flights"), std::string::npos);
  EXPECT_EQ(json_value(o.out, "longest_resolved"), "null");
}

// Where every step meets a wall nothing is known of its areas, and the reason is said.
TEST(Comparisons, SayWhyAreasAreNotMeasured) {
  const Shell shell;
  const std::string typed =
      "$carom compare circle --closed --schemes velocity-verlet --steps 9 --t-max 40 ";
  const Outcome o = shell(typed + "--json"), text = shell(typed);
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("\"areas\": null"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("\"areas_reason\": \"none of"), std::string::npos) << o.out;
  EXPECT_NE(on_one_line(text.out).find("areas not measured (none of"), std::string::npos)
      << text.out;
}

// The steps of an adaptive scheme change along the displacements: differences may err by half of
// the form, and then they do not show that it is kept.
TEST(Comparisons, DoNotKnowAreasFromDifferencesThatErr) {
  const Shell shell;
  const std::string typed = "$carom compare henon-heiles --schemes cvode --tolerances 1e-3 ";
  const Outcome o = shell(typed + "--json"), text = shell(typed);
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("\"symplectic\": null"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("\"areas_reason\": \"the differences err by"), std::string::npos) << o.out;
  EXPECT_NE(on_one_line(text.out).find("areas not measured (the differences err by"),
            std::string::npos)
      << text.out;
}

// Of a run that failed nothing is known, and of a single step not the way back.
TEST(Comparisons, ShowNoNumbersThatAreNotKnown) {
  const Shell shell;
  const Outcome o = shell(
      "$carom compare henon-heiles --schemes ruth-3 --t-max 0.1 --steps 100,0.1 --verbose --quiet");
  ASSERT_EQ(o.status, 0) << o.err;
  const std::regex failed("\n +100( +-){5} +[0-9]+ +-\n");
  EXPECT_TRUE(std::regex_search(o.out, failed)) << o.out;
  const std::regex single("\n +0\\.1( +[-.e0-9]+){3} +- +- +[0-9]+ ");
  EXPECT_TRUE(std::regex_search(o.out, single)) << o.out;
}

// The adaptive ones, too, look for particles within a range once a step.
TEST(Comparisons, AdaptiveSchemesMoveParticlesThatMeetWithinARange) {
  const Shell shell;
  std::ofstream(shell.folder() + "/yukawa.toml") << R"toml(
table = { shape = "rectangle", width = 4, height = 3 }
particles = { count = 2, energy = 4 }
interaction = { kind = "yukawa", strength = 0.1, range = 0.01 }
)toml";
  const Outcome o =
      shell("$carom compare ./yukawa.toml --t-max 0.5 --schemes arkode,velocity-verlet --json");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(is_json_object(o.out));
}

TEST(Comparisons, SchemesAreListedALineEach) {
  const Shell shell;
  const Outcome text = shell("$carom schemes"), json = shell("$carom schemes --json");
  EXPECT_TRUE(is_json_object(json.out));
  const std::size_t below = text.out.find("\nSources\n");
  ASSERT_NE(below, std::string::npos);
  std::size_t from = 0, source = below;
  for (const Scheme& scheme : schemes()) {
    from = text.out.find("\n  " + std::string(scheme.name) + " ", from);
    ASSERT_LT(from, below) << scheme.name;
    source = text.out.find("\n  " + std::string(scheme.name) + " ", source);
    ASSERT_NE(source, std::string::npos) << scheme.name;
    // Long ones are folded.
    std::istringstream words(text.out.substr(source)), wanted{std::string(scheme.source)};
    std::string word, name;
    words >> name;
    for (std::string other; wanted >> other;) EXPECT_TRUE(words >> word && word == other) << name;
  }
  EXPECT_NE(text.out.find("cvode", from), std::string::npos);
}

}  // namespace
}  // namespace carom
