#include "algebraic_root.hpp"

// GCC 12 sees a use after free in the reference counts of CGAL's handles at -O3; there is none.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/CORE_BigInt.h>

#include <iterator>
#include <mutex>
#include <utility>

namespace carom::geometry {

namespace {

using Kernel = CGAL::Algebraic_kernel_d_1<CORE::BigInt>;
using IntegerPolynomial = Kernel::Polynomial_1;
using CommonFactor = CGAL::Polynomial_traits_d<IntegerPolynomial>::Gcd_up_to_constant_factor;

/// CGAL's numbers (CORE) take their precision from variables of the whole process, which it changes
/// and sets back on the way: another thread at the same time would get other digits.
std::unique_lock<std::mutex> alone() {
  static std::mutex mutex;
  return std::unique_lock(mutex);
}

const Kernel& kernel() {
  static const Kernel instance;
  return instance;
}

// By its digits: CGAL 5's is a class of its own, CGAL 6's is Boost's.
CORE::BigInt big(const mpz_class& z) { return CORE::BigInt(z.get_str()); }

/// The polynomial times a positive integer.
IntegerPolynomial integer_polynomial(const Polynomial& polynomial) {
  mpz_class denominator = 1;
  std::vector<mpq_class> rational;
  for (const Dyadic& c : polynomial) {
    rational.push_back(c.rational());
    mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), rational.back().get_den_mpz_t());
  }
  std::vector<CORE::BigInt> integers;
  for (const mpq_class& c : rational)
    integers.push_back(big(mpz_class(c.get_num() * (denominator / c.get_den()))));
  return IntegerPolynomial(integers.begin(), integers.end());
}

}  // namespace

struct AlgebraicRoot::Data {
  Kernel::Algebraic_real_1 value;
};

std::vector<RealRoot> real_roots(const Polynomial& polynomial) {
  const auto turn = alone();
  const IntegerPolynomial p = integer_polynomial(polynomial);
  std::vector<RealRoot> result;
  if (p.degree() < 1) return result;
  std::vector<std::pair<Kernel::Algebraic_real_1, Kernel::Multiplicity_type>> roots;
  kernel().solve_1_object()(p, std::back_inserter(roots));
  for (const auto& [value, multiplicity] : roots)
    result.push_back(
        {AlgebraicRoot(std::make_shared<const AlgebraicRoot::Data>(AlgebraicRoot::Data{value})),
         static_cast<int>(multiplicity)});
  return result;
}

std::vector<AlgebraicRoot> rising_roots(const Polynomial& polynomial) {
  std::size_t degree = polynomial.size();
  while (degree > 0 && polynomial[degree - 1].sign() == 0) --degree;
  if (degree-- < 2) return {};
  std::vector<AlgebraicRoot> rising;
  int sign = polynomial[degree].sign() * (degree % 2 == 0 ? 1 : -1);  // at -infinity
  for (const RealRoot& root : real_roots(polynomial)) {
    if (root.multiplicity % 2 == 0) continue;
    if (sign < 0) rising.push_back(root.value);
    sign = -sign;
  }
  return {rising.rbegin(), rising.rend()};
}

int compare(const AlgebraicRoot& a, const AlgebraicRoot& b) {
  const auto turn = alone();
  return static_cast<int>(kernel().compare_1_object()(a.data().value, b.data().value));
}

int compare(const AlgebraicRoot& a, const mpq_class& b) {
  const auto turn = alone();
  const Kernel::Bound bound(big(b.get_num()), big(b.get_den()));
  return static_cast<int>(kernel().compare_1_object()(a.data().value, bound));
}

int sign_at(const Polynomial& polynomial, const AlgebraicRoot& root) {
  const auto turn = alone();
  // The kernel's own Sign_at_1 (5.5.1) fails when its refinement happens to hit a rational root
  // exactly: its interval is then a point, which its next step does not allow.
  const IntegerPolynomial p = integer_polynomial(polynomial);
  const Kernel::Algebraic_real_1& value = root.data().value;
  if (CGAL::is_zero(p)) return 0;
  if (CGAL::degree(p) == 0) return static_cast<int>(CGAL::sign(p.lcoeff()));
  if (value.low() != value.high()) {
    const IntegerPolynomial common = CommonFactor{}(p, value.polynomial());
    if (common.sign_at(value.low()) != common.sign_at(value.high())) return 0;
  }
  while (value.low() != value.high()) {
    const auto low = p.sign_at(value.low()), high = p.sign_at(value.high());
    IntegerPolynomial copy = p;
    if (low != CGAL::ZERO && high != CGAL::ZERO &&
        CGAL::internal::descartes(copy, value.low(), value.high()) == 0)
      return static_cast<int>(low);
    value.refine();
  }
  return static_cast<int>(p.sign_at(value.low()));
}

double approximate(const AlgebraicRoot& root) {
  const auto turn = alone();
  return CGAL::to_double(root.data().value);
}

}  // namespace carom::geometry
