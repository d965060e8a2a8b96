#include "carom/forces/typed_expression.hpp"

#include "forces/formula.hpp"

namespace carom {

using namespace forces;

TypedExpression TypedExpression::parse(std::string_view text,
                                       std::span<const std::string> variables,
                                       const std::map<std::string, double>& parameters,
                                       const Place& place) {
  return TypedExpression(
      std::make_shared<const Formula>(formula::parse(text, variables, parameters, place)));
}

double TypedExpression::value(std::span<const double> at) const {
  if (at.size() != formula_->variables)
    throw InternalError("a formula needs one number a variable");
  return formula_->value(at.data());
}

double TypedExpression::value_and_gradient(std::span<const double> at,
                                           std::span<double> gradient) const {
  if (at.size() != formula_->variables || gradient.size() != at.size())
    throw InternalError("a formula needs one number a variable, and gives one derivative");
  return formula_->value_and_gradient(at.data(), gradient.data());
}

double TypedExpression::value_gradient_and_hessian(std::span<const double> at,
                                                   std::span<double> gradient,
                                                   std::span<double> hessian) const {
  if (at.size() != formula_->variables || gradient.size() != at.size() ||
      hessian.size() != at.size() * at.size())
    throw InternalError("a formula needs one number a variable, and gives all second derivatives");
  return formula_->value_gradient_and_hessian(at.data(), gradient.data(), hessian.data());
}

}  // namespace carom
