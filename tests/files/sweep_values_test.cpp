// Values that --sweep asks for: exact where they can be, refused where they are no numbers.
#include "files/toml/sweep_values.hpp"

#include <gtest/gtest.h>

#include "carom/base/exact_number.hpp"

namespace carom::tests {
namespace {

using Values = std::vector<std::string>;

Values of(const std::string& typed) { return files::swept_key(typed).values; }

TEST(SweepValues, LieEvenlyAndExactlyBetweenTheirEnds) {
  EXPECT_EQ(files::swept_key("field.B=lin:0:1:3").key, "field.B");
  EXPECT_EQ(of("a.b=lin:0:4:5"), (Values{"0", "1", "2", "3", "4"}));
  EXPECT_EQ(of("a.b=lin:0:1:4"), (Values{"0", "1/3", "2/3", "1"}));
  EXPECT_EQ(of("a.b=lin:0.1:0.7:4"), (Values{"0.1", "0.3", "0.5", "0.7"}))
      << "no 0.30000000000000004";
  EXPECT_EQ(of("a.b=lin:1:-1:3"), (Values{"1", "0", "-1"}));
  for (const std::string& value : of("a.b=lin:0:pi/2:4")) ExactNumber(std::string_view(value));
  EXPECT_EQ(ExactNumber(std::string_view(of("a.b=lin:0:pi:3")[1])).to_double(),
            ExactNumber("pi/2").to_double());
}

TEST(SweepValues, HaveOneFactorBetweenThem) {
  EXPECT_EQ(of("a.b=log:1:1000:4"), (Values{"1", "10", "100", "1000"}));
  EXPECT_EQ(of("a.b=log:0.001:1:4"), (Values{"0.001", "0.01", "0.1", "1"}));
  EXPECT_EQ(of("a.b=log:8:1:4"), (Values{"8", "4", "2", "1"}));
  const Values irrational = of("a.b=log:1:10:3");
  EXPECT_EQ(irrational.front(), "1");
  EXPECT_EQ(irrational.back(), "10");
  EXPECT_NEAR(ExactNumber(std::string_view(irrational[1])).to_double(), 3.1622776601683795, 1e-15);
}

TEST(SweepValues, AreThoseOfAListAsTheyAreWritten) {
  EXPECT_EQ(of("a.b=list:1/3,0.50,pi/4"), (Values{"1/3", "0.50", "pi/4"}));
  EXPECT_EQ(of("a.b=list:7"), (Values{"7"}));
}

TEST(SweepValues, WithoutNumbersAreRefused) {
  for (const char* bad :
       {"field.B", "=lin:0:1:3", "field.B=", "field.B=0.5", "field.B=linear:0:1:3",
        "field.B=lin:0:1", "field.B=lin:0:1:3:4", "field.B=lin:a:b:3", "field.B=lin:0:1:1",
        "field.B=lin:0:1:2.5", "field.B=lin:0:1:1e9", "field.B=log:0:1:3", "field.B=log:-1:1:3",
        "field.B=list:", "field.B=list:1,,2", "table.shape=list:circle,stadium",
        "field.B=list:1,1.0", "field.B=lin:2:2:3", "field.B=list:1e999"}) {
    try {
      files::swept_key(bad);
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(error.place().file, "command line") << bad;
      EXPECT_EQ(error.place().key.rfind("--sweep", 0), 0u) << bad;
      EXPECT_NE(error.expected(), "") << bad;
    }
  }
  try {
    files::swept_key("field.B=lim:0:1:3");
  } catch (const InputError& error) {
    EXPECT_EQ(error.nearest(), "lin");
  }
}

}  // namespace
}  // namespace carom::tests
