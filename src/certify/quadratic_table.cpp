#include "certify/quadratic_table.hpp"

namespace carom::certify {
namespace {

Quadratic cosine(long k) {  // of k times 15 degrees, 0 <= k < 24
  if (k > 12) k = 24 - k;
  if (k > 6) return -cosine(12 - k);
  const Quadratic half = Quadratic(1) / Quadratic(2);
  switch (k) {
    case 0:
      return Quadratic(1);
    case 2:
      return half * sqrt(Quadratic(3));
    case 3:
      return half * sqrt(Quadratic(2));
    case 4:
      return half;
    case 6:
      return Quadratic(0);
    default:
      throw NotQuadratic("a root of a root");
  }
}

}  // namespace

VectorOf<Quadratic> twenty_fourth(long k) {
  k = (k % 24 + 24) % 24;
  return {cosine(k), cosine((k + 18) % 24)};
}

VectorOf<Quadratic> Source<Quadratic>::direction(const ExactNumber& angle, long part, long whole) {
  const std::string parts =
      "(" + exact_text(angle) + ")/(2*pi)+" + std::to_string(part) + "/" + std::to_string(whole);
  const auto turns = ExactNumber("(" + parts + ")*24", angle.place()).to_rational();
  if (!turns || turns->denominator != "1") throw NotQuadratic("an angle that is no multiple of pi/12");
  const mpz_class turned(turns->numerator);
  return twenty_fourth(static_cast<long>(mpz_fdiv_ui(turned.get_mpz_t(), 24)));
}

}  // namespace carom::certify
