#include "certify/number/exact_value.hpp"

#include <flint/fmpq.h>

#include "base/expression.hpp"
#include "table/numbers.hpp"

namespace carom::certify {
namespace {

Ball rational(const mpq_class& q) {
  fmpq_t value;
  fmpq_init(value);
  fmpq_set_mpq(value, q.get_mpq_t());
  Ball result;
  arb_set_fmpq(result.raw(), value, Precision::bits());
  fmpq_clear(value);
  return result;
}

Ball power_of(const Ball& x, long exponent) {
  Ball result;
  fmpz_t n;
  fmpz_init_set_si(n, exponent);
  arb_pow_fmpz(result.raw(), x.raw(), n, Precision::bits());
  fmpz_clear(n);
  return result;
}

Ball closed(const base::ClosedForm& x) {
  Ball result = rational(x.coefficient);
  if (x.radicand != 1) result = result * sqrt(rational(x.radicand));
  if (x.power != 0) {
    Ball pi;
    arb_const_pi(pi.raw(), Precision::bits());
    result = result * power_of(pi, x.power);
  }
  return result;
}

Ball evaluate(const ExactNumber::Node& x) {
  using Operation = ExactNumber::Node::Operation;
  switch (x.operation) {
    case Operation::leaf:
      return closed(x.closed);
    case Operation::root:
      return sqrt(evaluate(*x.first));
    case Operation::sum:
      return evaluate(*x.first) + evaluate(*x.second);
    case Operation::difference:
      return evaluate(*x.first) - evaluate(*x.second);
    case Operation::product:
      return evaluate(*x.first) * evaluate(*x.second);
    case Operation::quotient:
      return evaluate(*x.first) / evaluate(*x.second);
    case Operation::power:
      break;
  }
  return power_of(evaluate(*x.first), x.exponent);
}

}  // namespace

Ball value_of(const ExactNumber& number) {
  // A few more bits for what the operations of an expression lose.
  const Precision more(Precision::bits() + 32);
  return number.expression() ? evaluate(*number.expression()) : Ball(0);
}

Sign sign_of(const ExactNumber& number) {
  if (const auto rational = number.to_rational())
    return rational->numerator == "0"      ? Sign::zero
           : rational->numerator[0] == '-' ? Sign::negative
                                           : Sign::positive;
  for (const slong bits : {bits_of_a_first_look, slong{1024}, most_bits_of_a_sign}) {
    const Precision precision(bits);
    if (const Sign s = sign(value_of(number)); s != Sign::undecided) return s;
  }
  return Sign::undecided;
}

CosSin direction_of(const ExactNumber& angle, long part, long whole) {
  CosSin result;
  const std::string turns = "(" + table::shapes::quoted(angle) + "/(2*pi)+" + std::to_string(part) +
                            "/" + std::to_string(whole) + ")";
  const ExactNumber halves(turns + "*2", angle.place());  // in units of pi
  if (const auto exact = halves.to_rational()) {
    fmpq_t q;
    fmpq_init(q);
    fmpq_set_str(q, (exact->numerator + "/" + exact->denominator).c_str(), 10);
    arb_sin_cos_pi_fmpq(result.sin.raw(), result.cos.raw(), q, Precision::bits());
    fmpq_clear(q);
  } else {
    arb_sin_cos_pi(result.sin.raw(), result.cos.raw(), value_of(halves).raw(), Precision::bits());
  }
  return result;
}

}  // namespace carom::certify
