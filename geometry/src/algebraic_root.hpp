// Real roots of polynomials with exact coefficients, beyond quadratics. CGAL finds them; this
// header is free of it.
#pragma once

#include <memory>
#include <vector>

#include "dyadic.hpp"

namespace carom::geometry {

/// Coefficients of kappa^0, kappa^1, …; any positive factor is immaterial.
using Polynomial = std::vector<Dyadic>;

class AlgebraicRoot {
 public:
  struct Data;
  explicit AlgebraicRoot(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

/// The real roots at which the polynomial rises through zero, from the largest to the smallest.
/// Roots of even multiplicity are touched, not passed, and are left out.
std::vector<AlgebraicRoot> rising_roots(const Polynomial& polynomial);
/// All real roots with their multiplicities, ascending. The polynomial must not vanish identically.
struct RealRoot {
  AlgebraicRoot value;
  int multiplicity;
};
std::vector<RealRoot> real_roots(const Polynomial& polynomial);
/// -1, 0, 1 as a < b, a = b, a > b.
int compare(const AlgebraicRoot& a, const AlgebraicRoot& b);
int compare(const AlgebraicRoot& a, const mpq_class& b);
/// Sign of another polynomial at the root.
int sign_at(const Polynomial& polynomial, const AlgebraicRoot& root);
/// p(x) / q(x) at a root x, q(x) != 0.
AlgebraicRoot quotient_at(const Polynomial& p, const Polynomial& q, const AlgebraicRoot& x);
/// The nearest double, or nearly.
double approximate(const AlgebraicRoot& root);

}  // namespace carom::geometry
