#include "carom/base/exact_sum.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "carom/base/error.hpp"

// Bit 0 of digit 0 weighs 2^-1074, the smallest double. The largest double reaches bit 2097, in
// digit 65; four digits more take the carries of 2^142 additions. Between normalisations a digit
// grows by less than 2^33 an addition, so 2^29 of them fit into its 63 bits.
namespace carom {
namespace {

constexpr std::uint32_t pending_limit = 1u << 29;
constexpr std::int64_t base = std::int64_t{1} << 32;
constexpr std::uint64_t low_mask = 0xffffffffu;
// A term of 53 bits is shifted by up to 63 into the 128 bits; the first one lies in the middle.
constexpr std::uint64_t widest_shift = 63, first_shift = 31;
// The 128 bits are emptied before they reach 2^126.
constexpr std::uint64_t near_limit = std::uint64_t{1} << 62;

// All digits but the highest into [0, 2^32): this form of a number is unique.
void normalise(auto& digits) {
  std::int64_t carry = 0;
  for (std::size_t i = 0; i + 1 < digits.size(); ++i) {
    const std::int64_t sum = digits[i] + carry;
    carry = sum >> 32;
    digits[i] = sum - carry * base;
  }
  digits.back() += carry;
}

// Adds a number of 128 bits in two's complement times 2^lowest, not normalised.
void add_words(auto& digits, std::uint64_t low, std::uint64_t high, std::uint64_t lowest) {
  const bool negative = (high >> 63) != 0;
  if (negative) {
    low = 0 - low;
    high = ~high + (low == 0 ? 1 : 0);
  }
  const std::int64_t sign = negative ? -1 : 1;
  const std::uint64_t shift = lowest % 32;
  auto digit = static_cast<std::size_t>(lowest / 32);
  std::uint64_t carry = 0;
  for (const std::uint64_t word : {low & low_mask, low >> 32, high & low_mask, high >> 32}) {
    const std::uint64_t here = (word << shift) + carry;
    digits[digit++] += sign * static_cast<std::int64_t>(here & low_mask);
    carry = here >> 32;
  }
  digits[digit] += sign * static_cast<std::int64_t>(carry);
}

bool fits(std::uint64_t high) { return high + near_limit < 2 * near_limit; }

}  // namespace

void ExactSum::add(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t exponent = (bits >> 52) & 0x7ffu;
  if (exponent == 0x7ffu) throw InternalError("an exact sum was given a number that is not finite");
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
  const std::uint64_t mantissa = exponent == 0 ? fraction : fraction | (std::uint64_t{1} << 52);
  const std::uint64_t position = exponent == 0 ? 0 : exponent - 1;
  const bool negative = (bits >> 63) != 0;
  const std::uint64_t shift = position - lowest_;  // below lowest_ it wraps round
  if (shift > widest_shift) return add_far(position, mantissa, negative);
  const std::uint64_t low = mantissa << shift, high = (mantissa >> 1) >> (63 - shift);
  if (negative)
    add_near(0 - low, ~high + (low == 0 ? 1 : 0));
  else
    add_near(low, high);
}

void ExactSum::add_near(std::uint64_t low, std::uint64_t high) {
  low_ += low;
  high_ += high + (low_ < low ? 1 : 0);
  if (!fits(high_)) spill();
}

// A term that is too large for the 128 bits moves them; one that is too small goes to the digits.
void ExactSum::add_far(std::uint64_t position, std::uint64_t mantissa, bool negative) {
  if (mantissa == 0) return;
  if (lowest_ == none || position > lowest_) {
    spill();
    lowest_ = position > first_shift ? position - first_shift : 0;
    const std::uint64_t shift = position - lowest_;
    const std::uint64_t low = mantissa << shift, high = (mantissa >> 1) >> (63 - shift);
    low_ = negative ? 0 - low : low;
    high_ = negative ? ~high + (low == 0 ? 1 : 0) : high;
    return;
  }
  far_.resize(digits);
  add_words(far_, negative ? 0 - mantissa : mantissa, negative ? ~std::uint64_t{0} : 0, position);
  spilled();
}

// Empties the 128 bits into the digits.
void ExactSum::spill() {
  if ((low_ | high_) == 0) return;
  far_.resize(digits);
  add_words(far_, low_, high_, lowest_);
  low_ = high_ = 0;
  spilled();
}

void ExactSum::spilled() {
  if (++pending_ != pending_limit) return;
  normalise(far_);
  pending_ = 0;
}

// The 128 bits count from `lower` on, if the number fits; else they are emptied.
void ExactSum::shift_near(std::uint64_t lower) {
  const std::uint64_t shift = lowest_ - lower;
  if (shift >= 32 || !fits(high_ << shift) ||
      static_cast<std::int64_t>(high_ << shift) >> shift != static_cast<std::int64_t>(high_)) {
    spill();
  } else if (shift > 0) {
    high_ = (high_ << shift) | (low_ >> (64 - shift));
    low_ <<= shift;
  }
  lowest_ = lower;
}

void ExactSum::merge(const ExactSum& other) {
  ExactSum addend = other;
  if (!addend.far_.empty()) {
    normalise(addend.far_);
    far_.resize(digits);
    normalise(far_);
    for (std::size_t i = 0; i < digits; ++i) far_[i] += addend.far_[i];
    pending_ = 1;
    addend.far_.clear();
  }
  if (addend.lowest_ == none) return;
  if (lowest_ == none) {
    lowest_ = addend.lowest_;
  } else if (lowest_ > addend.lowest_) {
    shift_near(addend.lowest_);
  } else if (lowest_ < addend.lowest_) {
    addend.shift_near(lowest_);
    if (!addend.far_.empty()) merge(addend);  // it did not fit: its digits
  }
  add_near(addend.low_, addend.high_);
}

ExactSum::Digits ExactSum::all() const {
  Digits all{};
  std::copy(far_.begin(), far_.end(), all.begin());
  if ((low_ | high_) != 0) add_words(all, low_, high_, lowest_);
  normalise(all);
  return all;
}

double ExactSum::value() const {
  Digits magnitude = all();
  const bool negative = magnitude.back() < 0;
  if (negative) {
    for (std::int64_t& digit : magnitude) digit = -digit;
    normalise(magnitude);
  }
  int top = digits - 1;
  while (top >= 0 && magnitude[static_cast<std::size_t>(top)] == 0) --top;
  if (top < 0) return 0.0;
  const auto word = [&magnitude](int i) {
    return i < 0 ? 0u : static_cast<std::uint64_t>(magnitude[static_cast<std::size_t>(i)]);
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

std::array<std::int64_t, ExactSum::digits> ExactSum::state() const { return all(); }

ExactSum ExactSum::from_state(const std::array<std::int64_t, digits>& state) {
  for (std::size_t i = 0; i + 1 < digits; ++i) {
    if (state[i] < 0 || state[i] >= base) throw InputError("a stored sum has a digit out of range");
  }
  ExactSum sum;
  if (state != Digits{}) sum.far_.assign(state.begin(), state.end());
  return sum;
}

}  // namespace carom
