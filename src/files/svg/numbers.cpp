#include "files/svg/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::files {
namespace {

constexpr std::size_t longest = 100;  // digits of a number in a drawing
constexpr long largest_exponent = 100;

bool digit(char c) { return c >= '0' && c <= '9'; }
bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

mpz_class power_of_ten(long exponent) {
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(exponent));
  return power;
}

/// "-12.5" of a rational number with a denominator that divides a power of ten; "" of others and
/// of long ones.
std::string as_decimal(const Rational& value) {
  constexpr long most = 30;
  mpz_class rest = value.get_den();
  long twos = 0, fives = 0;
  for (; twos < most && mpz_divisible_ui_p(rest.get_mpz_t(), 2) != 0; ++twos) rest /= 2;
  for (; fives < most && mpz_divisible_ui_p(rest.get_mpz_t(), 5) != 0; ++fives) rest /= 5;
  if (rest != 1) return "";
  const long places = std::max(twos, fives);
  const mpz_class scaled = value.get_num() * (power_of_ten(places) / value.get_den());
  std::string digits = mpz_class(abs(scaled)).get_str();
  const auto behind = static_cast<std::size_t>(places);
  if (digits.size() > static_cast<std::size_t>(most)) return "";
  if (digits.size() <= behind) digits.insert(0, behind + 1 - digits.size(), '0');
  if (behind > 0) digits.insert(digits.size() - behind, ".");
  return (scaled < 0 ? "-" : "") + digits;
}

std::string as_ratio(const Rational& value) {
  return value.get_den() == 1 ? value.get_num().get_str()
                              : value.get_num().get_str() + "/" + value.get_den().get_str();
}

bool is_long(const Rational& value) {
  constexpr std::size_t most = 100;  // bits, some 30 digits
  return mpz_sizeinbase(value.get_num_mpz_t(), 2) > most ||
         mpz_sizeinbase(value.get_den_mpz_t(), 2) > most;
}

}  // namespace

void Scanner::fail(const std::string& problem, const std::string& expected) const {
  throw InputError(place(), problem, expected);
}

void Scanner::skip_spaces() {
  while (!at_end() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' ||
                       text_[at_] == '\r' || text_[at_] == '\f'))
    ++at_;
}

void Scanner::skip_separator() {
  skip_spaces();
  if (!take(',')) return;
  skip_spaces();
  if (!at_number()) fail("no number follows the comma", "a number");
}

bool Scanner::take(char c) {
  if (at_end() || text_[at_] != c) return false;
  ++at_;
  return true;
}

bool Scanner::at_number() const {
  return !at_end() && (digit(peek()) || peek() == '+' || peek() == '-' || peek() == '.');
}

Rational Scanner::number(const char* what) {
  std::size_t end = at_;
  const auto at = [&](std::size_t i) { return i < text_.size() ? text_[i] : '\0'; };
  const bool negative = at(end) == '-';
  if (at(end) == '-' || at(end) == '+') ++end;
  std::string digits;
  while (digit(at(end))) digits += text_[end++];
  long behind = 0;
  if (at(end) == '.') {
    ++end;
    for (; digit(at(end)); ++behind) digits += text_[end++];
  }
  if (digits.empty()) fail(std::string(what) + " is missing", "a number");
  long exponent = 0;
  const char e = at(end), sign = at(end + 1);
  if ((e == 'e' || e == 'E') &&
      (digit(sign) || ((sign == '-' || sign == '+') && digit(at(end + 2))))) {
    end += digit(sign) ? 1U : 2U;
    for (; digit(at(end)); ++end)
      exponent = std::min(10 * exponent + (text_[end] - '0'), 10 * largest_exponent);
    if (sign == '-') exponent = -exponent;
  }
  if (digits.size() > longest || std::max(exponent, -exponent) > largest_exponent)
    fail("the number is too long", "at most " + std::to_string(longest) +
                                       " digits, and powers of ten up to " +
                                       std::to_string(largest_exponent));
  at_ = end;
  exponent -= behind;
  decimals_ = std::max(decimals_, -exponent);
  Rational value(mpz_class(digits, 10));
  if (exponent >= 0) {
    value *= power_of_ten(exponent);
  } else {
    value /= power_of_ten(-exponent);
  }
  return negative ? Rational(-value) : value;
}

bool Scanner::flag() {
  skip_separator();
  if (take('0')) return false;
  if (take('1')) return true;
  fail("a flag of an arc is missing", "0 or 1");
}

std::string_view Scanner::word() {
  const std::size_t begin = at_;
  while (!at_end() && letter(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

Rational Scanner::length(const char* what) {
  static const std::pair<const char*, Rational> units[] = {{"", 1},
                                                           {"px", 1},
                                                           {"in", 96},
                                                           {"cm", Rational(9600, 254)},
                                                           {"mm", Rational(960, 254)},
                                                           {"pt", Rational(4, 3)},
                                                           {"pc", 16}};
  skip_spaces();
  const Rational value = number(what);
  const std::size_t behind = at_;
  const std::string_view unit = word();
  for (const auto& [name, factor] : units)
    if (unit == name && peek() != '%') {
      skip_spaces();
      if (!at_end()) fail("something follows " + std::string(what), "one number");
      Rational known = factor;
      known.canonicalize();
      return value * known;
    }
  at_ = behind;
  fail("a length in '" + std::string(peek() == '%' ? "%" : unit) +
           "' depends on the page or the font",
       "a number, or one in px, mm, cm, in, pt or pc");
}

double nearest(const Rational& value) {
  if (mpz_sizeinbase(value.get_num_mpz_t(), 2) > 1000 + mpz_sizeinbase(value.get_den_mpz_t(), 2))
    return value > 0 ? HUGE_VAL : -HUGE_VAL;
  const double down = value.get_d();  // towards 0
  if (Rational(down) == value) return down;
  return ExactNumber(as_ratio(value)).to_double();
}

ExactNumber written(const Rational& value, const Place& place) {
  if (abs(value) > power_of_ten(30))
    throw InputError(place, "a number of the drawing is out of range", "lengths below 1e30");
  const std::string decimal = as_decimal(value);
  if (!decimal.empty()) return {decimal, place};
  if (is_long(value)) return {ExactNumber(nearest(value)).text(), place};
  return {as_ratio(value), place};
}

ExactNumber written_root(const Rational& square, const Place& place) {
  const mpz_class above = sqrt(square.get_num()), below = sqrt(square.get_den());
  const Rational root(above, below);
  if (root * root == square) return written(root, place);
  const ExactNumber exact("sqrt(" + as_ratio(square) + ")", place);
  if (!is_long(square)) return exact;
  return {ExactNumber(exact.to_double()).text(), place};
}

}  // namespace carom::files
