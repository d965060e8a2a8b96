#include "forces/formula.hpp"

#include "forces/dual.hpp"
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

double TypedExpression::Formula::value(const double* at) const {
  Dual<0> x[formula::most_variables];
  for (std::size_t k = 0; k < variables; ++k) x[k] = at[k];
  return run(*this, x).v;
}

double TypedExpression::Formula::value_and_gradient(const double* at, double* gradient) const {
  switch (variables) {
    case 1:
      return gradient_of<1>(*this, at, gradient);
    case 2:
      return gradient_of<2>(*this, at, gradient);
    default:
      return gradient_of<3>(*this, at, gradient);
  }
}

double TypedExpression::Formula::value_gradient_and_hessian(const double* at, double* gradient,
                                                            double* hessian) const {
  switch (variables) {
    case 1:
      return hessian_of<1>(*this, at, gradient, hessian);
    case 2:
      return hessian_of<2>(*this, at, gradient, hessian);
    default:
      return hessian_of<3>(*this, at, gradient, hessian);
  }
}

}  // namespace carom
