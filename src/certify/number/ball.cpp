#include "certify/number/ball.hpp"

namespace carom::certify {

std::string Ball::decimals(long digits) const {
  // Scaled to an integer, rounded to nearest, and the point put back: always that many digits
  // behind it.
  const slong bits = arb_rel_accuracy_bits(x_) > 0 ? static_cast<slong>(arb_bits(x_)) + 64 : 64;
  arb_t scale, scaled;
  arb_init(scale);
  arb_init(scaled);
  arb_ui_pow_ui(scale, 10, static_cast<ulong>(digits), 4 * digits + 64);
  arb_mul(scaled, x_, scale, bits + 4 * digits + 64);
  fmpz_t whole;
  fmpz_init(whole);
  arf_get_fmpz(whole, arb_midref(scaled), ARF_RND_NEAR);
  arb_clear(scaled);
  arb_clear(scale);
  const bool negative = fmpz_sgn(whole) < 0;
  fmpz_abs(whole, whole);
  std::string text(fmpz_sizeinbase(whole, 10) + 2, '\0');
  fmpz_get_str(text.data(), 10, whole);
  fmpz_clear(whole);
  text.resize(text.find('\0'));
  const auto behind = static_cast<std::size_t>(digits);
  if (text.size() <= behind) text.insert(0, behind + 1 - text.size(), '0');
  if (behind > 0) text.insert(text.size() - behind, ".");
  return negative ? "-" + text : text;
}

}  // namespace carom::certify
