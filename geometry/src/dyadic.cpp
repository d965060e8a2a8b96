#include "dyadic.hpp"

#include <cmath>

#include "carom/base/error.hpp"

namespace carom::geometry {

Dyadic::Dyadic(double value) {
  if (!std::isfinite(value)) throw InternalError("exact decision on a number that is not finite");
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  mantissa_ = std::ldexp(fraction, 53);  // an integer below 2^53: mpz takes it exactly
  exponent_ = exponent - 53;
  // Short mantissas keep the products short: most table numbers have few bits.
  if (sgn(mantissa_) != 0) {
    const unsigned long zeros = mpz_scan1(mantissa_.get_mpz_t(), 0);
    mpz_fdiv_q_2exp(mantissa_.get_mpz_t(), mantissa_.get_mpz_t(), zeros);
    exponent_ += static_cast<long>(zeros);
  } else {
    exponent_ = 0;
  }
}

Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  if (sgn(a.mantissa_) == 0) return b;
  if (sgn(b.mantissa_) == 0) return a;
  if (a.exponent_ == b.exponent_) return {mpz_class(a.mantissa_ + b.mantissa_), a.exponent_};
  const Dyadic& low = a.exponent_ < b.exponent_ ? a : b;
  const Dyadic& high = a.exponent_ < b.exponent_ ? b : a;
  mpz_class m;
  mpz_mul_2exp(m.get_mpz_t(), high.mantissa_.get_mpz_t(),
               static_cast<unsigned long>(high.exponent_ - low.exponent_));
  m += low.mantissa_;
  return {std::move(m), low.exponent_};
}

Dyadic operator-(const Dyadic& a) { return {mpz_class(-a.mantissa_), a.exponent_}; }
Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + (-b); }
Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  return {mpz_class(a.mantissa_ * b.mantissa_), a.exponent_ + b.exponent_};
}

double Dyadic::approximate() const {
  long exponent = 0;
  const double fraction = mpz_get_d_2exp(&exponent, mantissa_.get_mpz_t());
  const long total = exponent + exponent_;
  if (total > 1100) return sign() * HUGE_VAL;
  if (total < -1200) return 0.0;
  return std::ldexp(fraction, static_cast<int>(total));
}

mpq_class Dyadic::rational() const {
  mpq_class q(mantissa_);
  if (exponent_ >= 0)
    mpq_mul_2exp(q.get_mpq_t(), q.get_mpq_t(), static_cast<unsigned long>(exponent_));
  else
    mpq_div_2exp(q.get_mpq_t(), q.get_mpq_t(), static_cast<unsigned long>(-exponent_));
  return q;
}

int sign_with_root(const Dyadic& a, const Dyadic& b, const Dyadic& d) {
  const int left = a.sign();
  const int right = d.sign() == 0 ? 0 : b.sign();
  if (left == 0) return right;
  if (right == 0 || left == right) return left;
  return left * (a * a - b * b * d).sign();
}

int sign_with_two_roots(const Dyadic& a, const Dyadic& b, const Dyadic& d, const Dyadic& c,
                        const Dyadic& e) {
  const int left = sign_with_root(a, b, d);
  const int right = e.sign() == 0 ? 0 : c.sign();
  if (left == 0) return right;
  if (right == 0 || left == right) return left;
  // |a + b sqrt(d)| against |c sqrt(e)|, by their squares.
  return left * sign_with_root(a * a + b * b * d - c * c * e, Dyadic(2) * a * b, d);
}

}  // namespace carom::geometry
