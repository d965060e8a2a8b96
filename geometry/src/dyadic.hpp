// Exact numbers m 2^e: closed under + - *, which is all that the exact decisions need.
#pragma once

#include <gmpxx.h>

#include "carom/base/sign.hpp"

namespace carom::geometry {

class Dyadic {
 public:
  Dyadic() = default;
  Dyadic(int value) : mantissa_(value) {}  // NOLINT: integers are dyadic
  /// Exactly the double, which must be finite.
  Dyadic(double value);  // NOLINT: doubles are dyadic
  explicit Dyadic(mpz_class whole) : mantissa_(std::move(whole)) {}

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b);
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b);
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);
  friend Dyadic operator-(const Dyadic& a);

  int sign() const { return sgn(mantissa_); }
  /// Nearest double, or nearly: for reports only.
  double approximate() const;
  mpq_class rational() const;

 private:
  Dyadic(mpz_class m, long e) : mantissa_(std::move(m)), exponent_(e) {}
  mpz_class mantissa_;
  long exponent_ = 0;
};

inline Sign sign_of(const Dyadic& a) { return static_cast<Sign>(a.sign()); }

/// Sign of a + b sqrt(d), d >= 0.
int sign_with_root(const Dyadic& a, const Dyadic& b, const Dyadic& d);
/// Sign of a + b sqrt(d) + c sqrt(e), d, e >= 0.
int sign_with_two_roots(const Dyadic& a, const Dyadic& b, const Dyadic& d, const Dyadic& c,
                        const Dyadic& e);

}  // namespace carom::geometry
