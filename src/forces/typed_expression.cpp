#include "carom/forces/typed_expression.hpp"

#include "forces/dual.hpp"
#include "forces/formula.hpp"
#include "forces/formula_evaluation.hpp"

namespace carom {

using namespace forces;
using forces::formula::run;

namespace {

template <std::size_t n>
double gradient_of(const TypedExpression::Formula& f, const double* at, double* gradient) {
  Dual<n> x[n];
  for (std::size_t k = 0; k < n; ++k) x[k] = Dual<n>::variable(at[k], k);
  const Dual<n> result = run(f, x);
  for (std::size_t k = 0; k < n; ++k) gradient[k] = result.d[k];
  return result.v;
}

template <std::size_t n>
double hessian_of(const TypedExpression::Formula& f, const double* at, double* gradient,
                  double* hessian) {
  Dual<n, Dual<n>> x[n];
  for (std::size_t k = 0; k < n; ++k)
    x[k] = Dual<n, Dual<n>>::variable(Dual<n>::variable(at[k], k), k);
  const Dual<n, Dual<n>> result = run(f, x);
  for (std::size_t k = 0; k < n; ++k) {
    gradient[k] = result.d[k].v;
    for (std::size_t l = 0; l < n; ++l) hessian[n * k + l] = result.d[k].d[l];
  }
  return result.v.v;
}

}  // namespace

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
  Dual<0> x[formula::most_variables];
  for (std::size_t k = 0; k < at.size(); ++k) x[k] = at[k];
  return run(*formula_, x).v;
}

double TypedExpression::value_and_gradient(std::span<const double> at,
                                           std::span<double> gradient) const {
  if (at.size() != formula_->variables || gradient.size() != at.size())
    throw InternalError("a formula needs one number a variable, and gives one derivative");
  const auto of = at.size() == 1   ? gradient_of<1>
                  : at.size() == 2 ? gradient_of<2>
                                   : gradient_of<3>;
  return of(*formula_, at.data(), gradient.data());
}

double TypedExpression::value_gradient_and_hessian(std::span<const double> at,
                                                   std::span<double> gradient,
                                                   std::span<double> hessian) const {
  if (at.size() != formula_->variables || gradient.size() != at.size() ||
      hessian.size() != at.size() * at.size())
    throw InternalError("a formula needs one number a variable, and gives all second derivatives");
  const auto of = at.size() == 1 ? hessian_of<1> : at.size() == 2 ? hessian_of<2> : hessian_of<3>;
  return of(*formula_, at.data(), gradient.data(), hessian.data());
}

}  // namespace carom
