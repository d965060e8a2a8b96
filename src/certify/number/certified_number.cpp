// The output of certified orbits: numbers with their balls, how many digits, and the names of
// fates.
#include <algorithm>
#include <memory>
#include <utility>

#include "base/name_among.hpp"
#include "carom/base/error.hpp"
#include "certify/number/enclosure_of.hpp"

namespace carom {

struct CertifiedNumber::Enclosure {
  certify::Ball ball;
};

namespace certify {

const Ball& ball_of(const CertifiedNumber& number) { return number.enclosure().ball; }

CertifiedNumber number_of(Ball ball) {
  return CertifiedNumber(std::make_shared<const CertifiedNumber::Enclosure>(
      CertifiedNumber::Enclosure{std::move(ball)}));
}

}  // namespace certify

CertifiedNumber CertifiedNumber::of_text(const std::string& decimals, int digits,
                                         const Place& place) {
  const auto bits = static_cast<slong>(4 * decimals.size() + 64);  // a digit has 3.33
  const bool plain = decimals.find_first_not_of("-.0123456789") == std::string::npos;
  certify::Ball ball, error;
  arb_ui_pow_ui(error.raw(), 10, static_cast<ulong>(digits), bits);
  arb_inv(error.raw(), error.raw(), bits);
  if (!plain || arb_set_str(ball.raw(), decimals.c_str(), bits) != 0)
    throw InputError(place, "'" + decimals + "' is not a number", "decimals");
  arb_add_error(ball.raw(), error.raw());
  return certify::number_of(std::move(ball));
}

std::string CertifiedNumber::text(int digits) const { return value_->ball.decimals(digits); }
double CertifiedNumber::to_double() const { return value_->ball.to_double(); }
double CertifiedNumber::log2_error() const { return value_->ball.radius().log2(); }

const char* name_of(CertifiedFate fate) {
  return base::name_among<CertifiedFate::interrupted>(
      {"completed", "escaped", "unbounded", "pinned", "singular", "undecided", "interrupted"},
      fate);
}

void check_digits(std::uint64_t digits, const Table& table, const Place& place) {
  // Numbers of the walls and of the state, 3.33 bits a digit.
  const auto numbers = static_cast<double>(16 * table.walls.size() + 60);
  const double bytes = 0.416 * numbers, most_bytes = 4e9;
  const auto by_memory = static_cast<std::uint64_t>(most_bytes / bytes);
  const std::uint64_t at_most = std::min(most_digits, by_memory);
  const auto refuse = [&](const std::string& problem, const std::string& expected) {
    throw InputError(place, problem, expected);
  };
  if (digits < 1) refuse("no digits are requested", "at least 1");
  if (digits <= at_most) return;
  std::string problem = std::to_string(digits) + " digits are more than certified orbits have";
  if (by_memory < most_digits) {
    const double gigabytes = bytes * static_cast<double>(digits) * 1e-9;
    problem = std::to_string(digits) + " digits of the numbers of " +
              std::to_string(table.walls.size()) + " walls take " +
              std::to_string(static_cast<std::uint64_t>(std::min(gigabytes + 0.999, 1e18))) +
              " GB of memory";
  }
  refuse(problem, "at most " + std::to_string(at_most));
}

}  // namespace carom
