// Formulas typed by the user: V(x, y), W(r).
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "carom/base/error.hpp"

namespace carom {

/// A function of one to three variables, parsed once. Immutable; copies share it, threads too.
///
/// Grammar: decimals (the double nearest to what is written), + - * / and ^, unary signs,
/// parentheses, pi, e, sqrt exp log sin cos tan sinh cosh tanh abs (one argument), min max atan2(y,
/// x) (two). -x^2 = -(x^2), 2^3^2 = 2^9. Operations are done in the order written, each rounded
/// once, so that a polynomial has the bits of the same line of C++. Powers:
///   whole exponents n <= 10000 in size  x * x^(n-1), the latter by repeated squaring: within n
///   ulp; half of an odd number               the same with sqrt(x); others exp(b log a): within 2
///   + 2 |b log a| ulp, NaN for a < 0.
/// sqrt is rounded once; exp, log, sin, cos and atan2 are within 1 ulp, tan within 3, sinh, cosh
/// and tanh within 4. The same bits on every machine.
///
/// Where a formula has no value (1/0, log(-1)) the result is not finite, and no error is
/// thrown: integration has to look. A constant part without a finite value is an InputError. At a
/// kink (abs at 0, min and max of equal numbers) the slope is 0 for abs, that of the first argument
/// for min and max.
class TypedExpression {
 public:
  /// `place` is that of the first character of `text`: errors point at the character to blame.
  static TypedExpression parse(std::string_view text, std::span<const std::string> variables,
                               const std::map<std::string, double>& parameters, const Place& place);

  double value(std::span<const double> at) const;
  /// The same value, and its exact derivatives (dual numbers, no differences).
  double value_and_gradient(std::span<const double> at, std::span<double> gradient) const;
  /// The second derivatives as well, row by row, by nested dual numbers. At a kink abs, min and max
  /// have those of one side.
  double value_gradient_and_hessian(std::span<const double> at, std::span<double> gradient,
                                    std::span<double> hessian) const;

  struct Formula;  ///< the operations, one after the other
  const Formula& formula() const { return *formula_; }

 private:
  explicit TypedExpression(std::shared_ptr<const Formula> formula) : formula_(std::move(formula)) {}
  std::shared_ptr<const Formula> formula_;
};

}  // namespace carom
