// Enclosures of an expression between two numbers of any precision: signs and correct rounding by
// raising the precision until the answer is certain (Ziv 1991).
#include <cmath>

#include "expression.hpp"

namespace carom::base::expression {
namespace {

class Real {
 public:
  explicit Real(mpfr_prec_t precision) { mpfr_init2(value_, precision); }
  Real(const Real& other) : Real(mpfr_get_prec(other.value_)) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
  }
  Real& operator=(const Real& other) {
    if (this == &other) return *this;
    mpfr_set_prec(value_, mpfr_get_prec(other.value_));
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~Real() { mpfr_clear(value_); }
  int sign() const { return mpfr_sgn(&value_[0]); }
  operator mpfr_ptr() { return value_; }
  operator mpfr_srcptr() const { return value_; }

 private:
  mpfr_t value_;
};

// low <= the number <= high. Out of range the ends grow to infinity, and a NaN becomes that too.
struct Enclosure {
  Real low, high;
  explicit Enclosure(mpfr_prec_t precision) : low(precision), high(precision) {}
};

using Binary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

// The least and the greatest of the four values that `f` takes at the ends.
Enclosure of_ends(Binary f, const Enclosure& a, const Enclosure& b, mpfr_prec_t precision) {
  Enclosure result(precision);
  Real value(precision);
  bool first = true, undefined = false;
  for (const Real* x : {&a.low, &a.high}) {
    for (const Real* y : {&b.low, &b.high}) {
      f(value, *x, *y, MPFR_RNDD);
      undefined = undefined || mpfr_nan_p(value) != 0;
      if (first || mpfr_less_p(value, result.low) != 0) mpfr_set(result.low, value, MPFR_RNDD);
      f(value, *x, *y, MPFR_RNDU);
      if (first || mpfr_greater_p(value, result.high) != 0) mpfr_set(result.high, value, MPFR_RNDU);
      first = false;
    }
  }
  if (undefined) {
    mpfr_set_inf(result.low, -1);
    mpfr_set_inf(result.high, 1);
  }
  return result;
}

Enclosure times(const Enclosure& a, const Enclosure& b, mpfr_prec_t precision) {
  return of_ends(mpfr_mul, a, b, precision);
}

Enclosure over(const Enclosure& a, const Enclosure& b, mpfr_prec_t precision) {
  if (b.low.sign() > 0 || b.high.sign() < 0) return of_ends(mpfr_div, a, b, precision);
  Enclosure everything(precision);
  mpfr_set_inf(everything.low, -1);
  mpfr_set_inf(everything.high, 1);
  return everything;
}

Enclosure exactly(const mpq_class& q, mpfr_prec_t precision) {
  Enclosure result(precision);
  mpfr_set_q(result.low, q.get_mpq_t(), MPFR_RNDD);
  mpfr_set_q(result.high, q.get_mpq_t(), MPFR_RNDU);
  return result;
}

Enclosure square_root(const Enclosure& x, mpfr_prec_t precision) {
  Enclosure result(precision);
  // The number itself is not negative; only its enclosure may begin below zero.
  if (x.low.sign() > 0) {
    mpfr_sqrt(result.low, x.low, MPFR_RNDD);
  } else {
    mpfr_set_zero(result.low, 1);
  }
  mpfr_sqrt(result.high, x.high, MPFR_RNDU);
  return result;
}

Enclosure raised(Enclosure factor, long exponent, mpfr_prec_t precision) {
  Enclosure result = exactly(1, precision);
  for (auto n = static_cast<unsigned long>(std::labs(exponent)); n != 0; n >>= 1) {
    if ((n & 1u) != 0) result = times(result, factor, precision);
    if (n > 1) factor = times(factor, factor, precision);
  }
  return exponent < 0 ? over(exactly(1, precision), result, precision) : result;
}

Enclosure pi(mpfr_prec_t precision) {
  Enclosure result(precision);
  mpfr_const_pi(result.low, MPFR_RNDD);
  mpfr_const_pi(result.high, MPFR_RNDU);
  return result;
}

Enclosure enclose(const ClosedForm& x, mpfr_prec_t precision) {
  Enclosure result = exactly(x.coefficient, precision);
  if (x.radicand != 1) {
    result = times(result, square_root(exactly(x.radicand, precision), precision), precision);
  }
  if (x.power != 0) result = times(result, raised(pi(precision), x.power, precision), precision);
  return result;
}

Enclosure enclose(const Node& x, mpfr_prec_t precision) {
  if (x.operation == Node::Operation::leaf) return enclose(x.closed, precision);
  const Enclosure a = enclose(*x.first, precision);
  if (x.operation == Node::Operation::root) return square_root(a, precision);
  if (x.operation == Node::Operation::power) return raised(a, x.exponent, precision);
  const Enclosure b = enclose(*x.second, precision);
  switch (x.operation) {
    case Node::Operation::sum:
    case Node::Operation::difference: {
      const bool plus = x.operation == Node::Operation::sum;
      Enclosure result(precision);
      (plus ? mpfr_add : mpfr_sub)(result.low, a.low, plus ? b.low : b.high, MPFR_RNDD);
      (plus ? mpfr_add : mpfr_sub)(result.high, a.high, plus ? b.high : b.low, MPFR_RNDU);
      if (mpfr_nan_p(result.low) != 0) mpfr_set_inf(result.low, -1);
      if (mpfr_nan_p(result.high) != 0) mpfr_set_inf(result.high, 1);
      return result;
    }
    case Node::Operation::product:
      return times(a, b, precision);
    default:
      return over(a, b, precision);
  }
}

}  // namespace

int sign(const Node& x) {
  if (x.operation == Node::Operation::leaf) return sgn(x.closed.coefficient);
  for (mpfr_prec_t precision = 96; precision <= most_precision; precision *= 2) {
    const Enclosure e = enclose(x, precision);
    if (e.low.sign() > 0) return 1;
    if (e.high.sign() < 0) return -1;
  }
  return 0;
}

std::optional<double> nearest_double(const Node& x) {
  // Some finite precision distinguishes a rational number from every tie: a tie has at most 1076
  // bits.
  const bool rational = x.operation == Node::Operation::leaf && x.closed.is_rational();
  const mpfr_prec_t most =
      rational ? static_cast<mpfr_prec_t>(2 * most_bits + 4096) : most_precision;
  for (mpfr_prec_t precision = 96;; precision *= 2) {
    const Enclosure e = enclose(x, precision);
    const double low = mpfr_get_d(e.low, MPFR_RNDN);
    const double high = mpfr_get_d(e.high, MPFR_RNDN);
    if (low == high) return std::isfinite(low) ? std::optional(low + 0.0) : std::nullopt;
    if (precision < most) continue;
    if (!std::isfinite(low) || !std::isfinite(high)) return std::nullopt;
    if (std::nextafter(low, high) != high) throw NoValue("the number cancels too many digits");
    // The ends round to neighbours: the number is taken as the tie between them.
    Real middle(precision);
    mpfr_set_d(middle, low, MPFR_RNDN);
    mpfr_add_d(middle, middle, high, MPFR_RNDN);
    mpfr_div_2ui(middle, middle, 1, MPFR_RNDN);
    return mpfr_get_d(middle, MPFR_RNDN);
  }
}

}  // namespace carom::base::expression
