#include "carom/base/error.hpp"

#include <gtest/gtest.h>

namespace carom {
namespace {

TEST(Place, LeavesOutWhatIsUnknown) {
  EXPECT_EQ(describe({"a.toml", 3, 7, "table.width"}), "a.toml, line 3, column 7: table.width");
  EXPECT_EQ(describe({"a.toml", 3, 0, "table.width"}), "a.toml, line 3: table.width");
  EXPECT_EQ(describe({"command line", 0, 0, "run.t_max"}), "command line: run.t_max");
  EXPECT_EQ(describe({"a.toml", 3, 7, ""}), "a.toml, line 3, column 7");
  EXPECT_EQ(describe({"", 0, 0, "run.t_max"}), "run.t_max");
  EXPECT_EQ(describe({"", 2, 1, ""}), "line 2, column 1");
  EXPECT_EQ(describe({}), "");
}

TEST(InputError, SaysPlaceProblemExpectedAndNearest) {
  const Place place{"a.toml", 3, 7, "table.widht"};
  EXPECT_STREQ(
      InputError(place, "unknown key", "a key of [table]", "width").what(),
      "a.toml, line 3, column 7: table.widht: unknown key (expected a key of [table]; did you mean "
      "'width'?)");
  EXPECT_STREQ(InputError(place, "unknown key", "", "width").what(),
               "a.toml, line 3, column 7: table.widht: unknown key (did you mean 'width'?)");
  EXPECT_STREQ(InputError(place, "wrong type", "a number").what(),
               "a.toml, line 3, column 7: table.widht: wrong type (expected a number)");
  EXPECT_STREQ(InputError("no such file").what(), "no such file");
  const InputError error(place, "unknown key", "a key", "width");
  EXPECT_EQ(error.place().column, 7);
  EXPECT_EQ(error.problem(), "unknown key");
  EXPECT_EQ(error.expected(), "a key");
  EXPECT_EQ(error.nearest(), "width");
}

TEST(NearestName, FindsTypingErrors) {
  const std::vector<std::string> keys = {"width",         "height", "radius",
                                         "larmor_radius", "t_max",  "B"};
  EXPECT_EQ(nearest_name("widht", keys), "width");   // two letters swapped
  EXPECT_EQ(nearest_name("widt", keys), "width");    // one missing
  EXPECT_EQ(nearest_name("widthh", keys), "width");  // one too many
  EXPECT_EQ(nearest_name("raduis", keys), "radius");
  EXPECT_EQ(nearest_name("tmax", keys), "t_max");
  EXPECT_EQ(nearest_name("Larmor-Radius", keys), "larmor_radius");
  EXPECT_EQ(nearest_name("b", keys), "B");
  EXPECT_EQ(nearest_name("mni", {"max", "min"}), "min");  // one swap, not two replacements
}

TEST(NearestName, IsSilentWhenNothingIsNear) {
  const std::vector<std::string> keys = {"width", "height", "B"};
  EXPECT_EQ(nearest_name("temperature", keys), "");
  EXPECT_EQ(nearest_name("x", keys), "");
  EXPECT_EQ(nearest_name("", keys), "");
  EXPECT_EQ(nearest_name("width", {}), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'w'), keys), "");
}

TEST(NearestName, TakesTheFirstOfEquallyNearOnes) {
  EXPECT_EQ(nearest_name("side_9", {"side_1", "side_2"}), "side_1");
  EXPECT_EQ(nearest_name("side_2", {"side_1", "side_2"}), "side_2");
}

}  // namespace
}  // namespace carom
