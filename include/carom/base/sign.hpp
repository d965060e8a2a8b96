// The answer of one stage of an exact decision (docs/physics/exactness.md).
#pragma once

namespace carom {

/// Sign of an expression. `undecided` is what a stage of limited precision answers when the
/// value is smaller than its own error bound; the exact stage never answers it.
enum class Sign : signed char { negative = -1, zero = 0, positive = 1, undecided = 2 };

constexpr Sign operator-(Sign s) {
  return s == Sign::negative ? Sign::positive : s == Sign::positive ? Sign::negative : s;
}

/// Sign of `value` when its absolute error is at most `bound`; a NaN is undecided.
constexpr Sign sign_within(double value, double bound) {
  if (value > bound) return Sign::positive;
  if (value < -bound) return Sign::negative;
  return Sign::undecided;
}

}  // namespace carom
