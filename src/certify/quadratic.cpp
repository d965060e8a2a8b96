#include "certify/quadratic.hpp"

#include "certify/evaluate.hpp"

namespace carom::certify {
namespace {

bool is_square(const mpq_class& q) {
  return mpz_perfect_square_p(q.get_num_mpz_t()) != 0 && mpz_perfect_square_p(q.get_den_mpz_t()) != 0;
}
mpq_class root_of_square(const mpq_class& q) {
  mpq_class root;
  mpz_sqrt(root.get_num_mpz_t(), q.get_num_mpz_t());
  mpz_sqrt(root.get_den_mpz_t(), q.get_den_mpz_t());
  return root;
}

Quadratic leaf_of(const ClosedForm& x) {
  if (x.power != 0) throw NotQuadratic("pi is no root");
  const Quadratic coefficient{x.coefficient};
  return x.radicand == 1 ? coefficient : coefficient * sqrt(Quadratic{x.radicand});
}

Quadratic power_of(const Quadratic& base, long exponent) {
  const long times = exponent < 0 ? -exponent : exponent;
  if (times > 1000) throw NotQuadratic("a high power");
  Quadratic result(1);
  for (long i = 0; i < times; ++i) result = result * base;
  return exponent < 0 ? Quadratic(1) / result : result;
}

}  // namespace

Quadratic::Quadratic(const ExactNumber& number) {
  if (number.expression()) *this = evaluate<Quadratic>(*number.expression(), leaf_of, power_of);
}

Quadratic operator*(const Quadratic& a, const Quadratic& b) {
  if (sgn(a.root_) == 0 && sgn(b.root_) == 0) return Quadratic(mpq_class(a.rational_ * b.rational_));
  return {a.rational_ * b.rational_ + a.root_ * b.root_ * QuadraticField::radicand(),
          a.rational_ * b.root_ + a.root_ * b.rational_};
}

Quadratic operator/(const Quadratic& a, const Quadratic& b) {
  if (sgn(b.root_) == 0) {
    if (sgn(b.rational_) == 0) throw NotQuadratic("a division by zero");
    return {a.rational_ / b.rational_, a.root_ / b.rational_};
  }
  // The norm is not zero, for the radicand is no square.
  const mpq_class norm = b.rational_ * b.rational_ - b.root_ * b.root_ * QuadraticField::radicand();
  const Quadratic above = a * Quadratic(b.rational_, -b.root_);
  return {above.rational_ / norm, above.root_ / norm};
}

Sign sign(const Quadratic& a) {
  const int p = sgn(a.rational_), q = sgn(a.root_);
  int s = p;
  if (q != 0 && p != q) {  // otherwise both point the same way
    const mpq_class p2 = a.rational_ * a.rational_, q2 = a.root_ * a.root_ * QuadraticField::radicand();
    s = cmp(p2, q2) > 0 ? p : q;
  }
  return s > 0 ? Sign::positive : s < 0 ? Sign::negative : Sign::zero;
}

Quadratic sqrt(const Quadratic& a) {
  if (sign(a) == Sign::negative) throw NotQuadratic("the root of a negative number");
  const mpz_class& d = QuadraticField::radicand();
  if (sgn(a.root_) == 0) {
    if (is_square(a.rational_)) return Quadratic(root_of_square(a.rational_));
    if (d == 0) QuadraticField::radicand() = mpz_class(a.rational_.get_num() * a.rational_.get_den());
    const mpq_class share = a.rational_ / d;  // sqrt(a) = sqrt(a/d) sqrt(d)
    if (is_square(share)) return {mpq_class(0), root_of_square(share)};
    throw NotQuadratic("a second root");
  }
  // (x + y sqrt d)^2 = a: x^2 is half of the rational part plus or minus the root of the norm.
  const mpq_class norm = a.rational_ * a.rational_ - a.root_ * a.root_ * d;
  if (sgn(norm) >= 0 && is_square(norm)) {
    const mpq_class n = root_of_square(norm);
    for (const mpq_class& x2 : {mpq_class((a.rational_ + n) / 2), mpq_class((a.rational_ - n) / 2)}) {
      if (sgn(x2) <= 0 || !is_square(x2)) continue;
      const mpq_class x = root_of_square(x2);
      const Quadratic root(x, mpq_class(a.root_ / (2 * x)));
      return sign(root) == Sign::negative ? -root : root;
    }
  }
  throw NotQuadratic("a root of a root");
}

std::size_t Quadratic::bits() const {
  std::size_t sum = 0;
  for (const mpq_class* q : {&rational_, &root_})
    sum += mpz_sizeinbase(q->get_num_mpz_t(), 2) + mpz_sizeinbase(q->get_den_mpz_t(), 2);
  return sum;
}

}  // namespace carom::certify
