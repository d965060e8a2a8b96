// Doubles of decimal texts: the nearest ones.
#include "carom/base/decimal.hpp"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace carom {
namespace {

// The middle between a number and the next one, with all its digits.
std::string middle_after(double x) {
  mpfr_t exact;
  mpfr_init2(exact, 2000);
  mpfr_set_d(exact, x, MPFR_RNDN);
  mpfr_t next;
  mpfr_init2(next, 2000);
  mpfr_set_d(next, std::nextafter(x, std::numeric_limits<double>::infinity()), MPFR_RNDN);
  mpfr_add(exact, exact, next, MPFR_RNDN);
  mpfr_div_2ui(exact, exact, 1, MPFR_RNDN);
  char* text = nullptr;
  mpfr_asprintf(&text, "%.1100Re", exact);
  std::string digits = text;
  mpfr_free_str(text);
  mpfr_clears(exact, next, mpfr_ptr(nullptr));
  return digits;
}

TEST(Decimal, IsRoundedToTheNearest) {
  std::mt19937_64 random(31);
  for (int i = 0; i < 2000; ++i) {
    const double x = std::fabs(std::bit_cast<double>(random()));
    if (!std::isfinite(x) || x >= std::numeric_limits<double>::max()) continue;
    const double next = std::nextafter(x, std::numeric_limits<double>::infinity());
    const bool even = (std::bit_cast<std::uint64_t>(x) & 1) == 0;
    std::string middle = middle_after(x);
    EXPECT_EQ(nearest_double(middle), even ? x : next) << middle;
    EXPECT_EQ(nearest_double("-" + middle), even ? -x : -next) << middle;
    // A digit far behind decides.
    middle.insert(middle.find('e'), "1");
    EXPECT_EQ(nearest_double(middle), next) << middle;
  }
}

TEST(Decimal, ReadsWhatIsWritten) {
  EXPECT_EQ(nearest_double("0"), 0.0);
  EXPECT_TRUE(std::signbit(nearest_double("-0.0").value()));
  EXPECT_EQ(nearest_double("0e999"), 0.0);
  EXPECT_EQ(nearest_double(".5"), 0.5);
  EXPECT_EQ(nearest_double("5e-324"), 0x1p-1074);
  EXPECT_EQ(nearest_double("1.7976931348623157e308"), 0x1.fffffffffffffp1023);
  EXPECT_EQ(nearest_double("-inf"), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(nearest_double("nan").value()));
}

TEST(Decimal, RefusesTheRest) {
  for (const char* text : {"", " 1", "1 ", "+1", "1,5", "1e", "--1", "0x1", "one", "1.8e308",
                           "-1e400", "1e-400", "2e-324", "1e999999999999"})
    EXPECT_FALSE(nearest_double(text)) << text;
}

}  // namespace
}  // namespace carom
