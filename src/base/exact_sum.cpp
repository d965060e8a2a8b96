#include "carom/base/exact_sum.hpp"

#include <bit>
#include <cstddef>

#include "carom/base/error.hpp"

// Bit 0 of digit 0 weighs 2^-1074, the smallest double. The largest double reaches bit 2097, in
// digit 65; four digits more take the carries of 2^142 additions. Between normalisations a digit
// grows by less than 2^32 an addition, so 2^30 of them fit into its 63 bits.
namespace carom {
namespace {

constexpr std::uint32_t pending_limit = 1u << 30;
constexpr std::int64_t base = std::int64_t{1} << 32;
constexpr std::uint64_t low_mask = 0xffffffffu;

}  // namespace

void ExactSum::add(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t exponent = (bits >> 52) & 0x7ffu;
  if (exponent == 0x7ffu) throw InternalError("an exact sum was given a number that is not finite");
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
  const std::uint64_t mantissa = exponent == 0 ? fraction : fraction | (std::uint64_t{1} << 52);
  const std::uint64_t position = exponent == 0 ? 0 : exponent - 1;
  const auto digit = static_cast<std::size_t>(position / 32);
  const std::uint64_t shift = position % 32;
  // 53 bits shifted by at most 31 touch three digits.
  const std::uint64_t low = (mantissa & low_mask) << shift;
  const std::uint64_t high = ((mantissa >> 32) << shift) + (low >> 32);
  const std::int64_t sign = (bits >> 63) != 0 ? -1 : 1;
  digits_[digit] += sign * static_cast<std::int64_t>(low & low_mask);
  digits_[digit + 1] += sign * static_cast<std::int64_t>(high & low_mask);
  digits_[digit + 2] += sign * static_cast<std::int64_t>(high >> 32);
  if (++pending_ == pending_limit) normalise();
}

void ExactSum::merge(const ExactSum& other) {
  ExactSum addend = other;
  addend.normalise();
  normalise();
  for (std::size_t i = 0; i < digits; ++i) digits_[i] += addend.digits_[i];
  pending_ = 1;
}

// All digits but the highest into [0, 2^32): this form of a number is unique.
void ExactSum::normalise() {
  std::int64_t carry = 0;
  for (std::size_t i = 0; i + 1 < digits; ++i) {
    const std::int64_t sum = digits_[i] + carry;
    carry = sum >> 32;
    digits_[i] = sum - carry * base;
  }
  digits_[digits - 1] += carry;
  pending_ = 0;
}

double ExactSum::value() const {
  ExactSum magnitude = *this;
  magnitude.normalise();
  const bool negative = magnitude.digits_[digits - 1] < 0;
  if (negative) {
    for (std::int64_t& digit : magnitude.digits_) digit = -digit;
    magnitude.normalise();
  }
  int top = digits - 1;
  while (top >= 0 && magnitude.digits_[static_cast<std::size_t>(top)] == 0) --top;
  if (top < 0) return 0.0;
  const auto word = [&magnitude](int i) {
    return i < 0 ? 0u : static_cast<std::uint64_t>(magnitude.digits_[static_cast<std::size_t>(i)]);
  };
  const int highest =
      32 * top + static_cast<int>(std::bit_width(word(top))) - 1;  // index of the highest bit
  const std::uint64_t sign = negative ? std::uint64_t{1} << 63 : 0u;
  if (highest > 2097) return std::bit_cast<double>(sign | (std::uint64_t{0x7ff} << 52));
  // Up to bit 52 the number is a multiple of the smallest double that fits into 53 bits.
  if (highest <= 52) return std::bit_cast<double>(sign | (word(1) << 32) | word(0));

  const int lowest = highest - 52;  // index of the last bit kept
  std::uint64_t mantissa = 0;
  for (int i = 0; i <= 52; ++i) {
    const int bit = highest - i;
    mantissa = (mantissa << 1) | ((word(bit / 32) >> (bit % 32)) & 1u);
  }
  const int half = lowest - 1;
  const bool upper_half = ((word(half / 32) >> (half % 32)) & 1u) != 0;
  bool more = (word(half / 32) & ((std::uint64_t{1} << (half % 32)) - 1)) != 0;
  for (int i = half / 32 - 1; i >= 0 && !more; --i) more = word(i) != 0;
  const bool up = upper_half && (more || (mantissa & 1u) != 0);
  // A carry out of the mantissa raises the exponent, at the end to infinity, as it should.
  const auto exponent = static_cast<std::uint64_t>(lowest);
  return std::bit_cast<double>(sign | ((exponent << 52) + mantissa + (up ? 1u : 0u)));
}

std::array<std::int64_t, ExactSum::digits> ExactSum::state() const {
  ExactSum copy = *this;
  copy.normalise();
  return copy.digits_;
}

ExactSum ExactSum::from_state(const std::array<std::int64_t, digits>& state) {
  for (std::size_t i = 0; i + 1 < digits; ++i) {
    if (state[i] < 0 || state[i] >= base) throw InputError("a stored sum has a digit out of range");
  }
  ExactSum sum;
  sum.digits_ = state;
  return sum;
}

}  // namespace carom
