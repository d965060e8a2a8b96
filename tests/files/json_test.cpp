#include "files/json.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "files/progress.hpp"

namespace carom {

using namespace files;

namespace {

TEST(Json, NumbersReadBackAsTheSameDouble) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (!(std::abs(x) <= std::numeric_limits<double>::max())) continue;
    EXPECT_EQ(std::strtod(Json(x).text().c_str(), nullptr), x);
  }
  EXPECT_EQ(Json(0.1).text(), "0.1");
  EXPECT_EQ(Json(-3.0).text(), "-3");
}

TEST(Json, BeyondDoubleIsAString) {
  EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).text(), "\"inf\"");
  EXPECT_EQ(Json(std::numeric_limits<double>::quiet_NaN()).text(), "null");
  EXPECT_EQ(Json(std::uint64_t{1} << 53).text(), "9007199254740992");
  EXPECT_EQ(Json((std::uint64_t{1} << 53) + 1).text(), "\"9007199254740993\"");
  EXPECT_EQ(Json(std::numeric_limits<std::int64_t>::min()).text(), "\"-9223372036854775808\"");
  EXPECT_EQ(Json(-7).text(), "-7");
}

TEST(Json, EscapesText) {
  EXPECT_EQ(Json("a \"b\"\\\n\x01").text(), "\"a \\\"b\\\"\\\\\\n\\u0001\"");
  EXPECT_EQ(Json(true).text(), "true");
  EXPECT_EQ(Json().text(), "null");
}

TEST(Json, KeepsTheOrderOfKeys) {
  Json json = Json::object();
  json.set("z", 1).set("a", Json::array().push(1).push(2));
  json.set("list", Json::array().push(Json::object().set("k", "v")).push(Json::object()));
  EXPECT_EQ(json.text(),
            "{\n  \"z\": 1,\n  \"a\": [1, 2],\n  \"list\": [\n    {\"k\": \"v\"},\n    {}\n  ]\n}");
  EXPECT_EQ(Json::object().text(), "{}");
}

TEST(Progress, NumbersAndTimesAreShort) {
  EXPECT_EQ(with_prefix(7), "7 ");
  EXPECT_EQ(with_prefix(999.4), "999 ");
  EXPECT_EQ(with_prefix(999.6), "1.00 k");
  EXPECT_EQ(with_prefix(12345678), "12.3 M");
  EXPECT_EQ(as_duration(3.2), "4 s");
  EXPECT_EQ(as_duration(200), "3 min 20 s");
  EXPECT_EQ(as_duration(7500), "2 h 5 min");
}

}  // namespace
}  // namespace carom
