#include "geometry/bezier_oracle.hpp"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/CORE_BigInt.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace carom::tests {
namespace {

using geometry::Bezier;
using Algebra = CGAL::Algebraic_kernel_d_1<CORE::BigInt>;
using Rational = geometry::BasicVector<mpq_class>;
using Powers = std::vector<mpq_class>;

Rational rational(geometry::Vector v) { return {mpq_class(v.x), mpq_class(v.y)}; }

/// Coefficients of the curve's points, from the start of the flight.
std::pair<Powers, Powers> powers(const Bezier& curve) {
  Powers x, y;
  mpq_class outer = 1;  // n over k
  for (int k = 0; k <= curve.degree; ++k) {
    Rational sum{0, 0};
    mpq_class inner = 1;  // k over i
    for (int i = 0; i <= k; ++i) {
      const mpq_class weight = (k - i) % 2 == 0 ? inner : mpq_class(-inner);
      sum = sum + weight * rational(curve.control(i));
      inner = inner * (k - i) / (i + 1);
    }
    x.push_back(outer * sum.x);
    y.push_back(outer * sum.y);
    outer = outer * (curve.degree - k) / (k + 1);
  }
  return {x, y};
}
mpq_class value(const Powers& p, const mpq_class& u) {
  mpq_class sum = 0;
  for (std::size_t k = p.size(); k-- > 0;) sum = sum * u + p[k];
  return sum;
}

}  // namespace

std::optional<double> first_exit_by_kernel(const Bezier& curve, geometry::Vector start,
                                           geometry::Vector velocity, double omega, double on) {
  auto [x, y] = powers(curve);
  const Rational from =
      on < 0.0 ? rational(start) : Rational{value(x, mpq_class(on)), value(y, mpq_class(on))};
  x[0] -= from.x;
  y[0] -= from.y;
  const Rational v = rational(velocity);
  Powers side(omega == 0.0 ? x.size() : 2 * x.size() - 1);
  for (std::size_t k = 0; k < x.size(); ++k) side[k] += 2 * (v.x * y[k] - v.y * x[k]);
  for (std::size_t i = 0; omega != 0.0 && i < x.size(); ++i)
    for (std::size_t k = 0; k < x.size(); ++k)
      side[i + k] += mpq_class(omega) * (x[i] * x[k] + y[i] * y[k]);

  mpz_class denominator = 1;
  for (const mpq_class& q : side)
    mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), q.get_den_mpz_t());
  const auto big = [](const mpz_class& z) { return CORE::BigInt(z.get_str()); };
  std::vector<CORE::BigInt> integers;
  for (const mpq_class& q : side)
    integers.push_back(big(mpz_class(q.get_num() * (denominator / q.get_den()))));
  const Algebra::Polynomial_1 polynomial(integers.begin(), integers.end());
  if (polynomial.degree() < 1) return {};
  const Algebra algebra;
  std::vector<std::pair<Algebra::Algebraic_real_1, Algebra::Multiplicity_type>> roots;
  algebra.solve_1_object()(polynomial, std::back_inserter(roots));
  // Before the first of all real roots the sign is the leading one's, or the other.
  bool below = (sgn(side[static_cast<std::size_t>(polynomial.degree())]) < 0) !=
               (polynomial.degree() % 2 == 1);
  std::optional<std::pair<mpq_class, mpq_class>> first;  // kappa and u
  for (const auto& [root, multiplicity] : roots) {
    if (multiplicity % 2 == 0) continue;
    const bool rises = below;
    below = !below;
    const auto against = [&](const mpq_class& q) {
      return static_cast<int>(
          algebra.compare_1_object()(root, Algebra::Bound(big(q.get_num()), big(q.get_den()))));
    };
    if (!rises || against(0) < 0 || against(1) > 0) continue;
    if (on >= 0.0 && against(mpq_class(on)) == 0) continue;
    const auto bounds = algebra.approximate_relative_1_object()(root, 900);
    const auto number = [](const Algebra::Bound& b) {
      std::ostringstream digits;
      digits << b;
      return mpq_class(digits.str());
    };
    const mpq_class u = (number(bounds.first) + number(bounds.second)) / 2;
    const mpq_class dx = value(x, u), dy = value(y, u);
    const mpq_class kappa = (v.x * dx + v.y * dy) / (dx * dx + dy * dy);
    if ((omega != 0.0 || kappa > 0) && (!first || kappa > first->first)) first = {kappa, u};
  }
  if (!first) return {};
  return first->second.get_d();
}

}  // namespace carom::tests
