#include "algebraic_root.hpp"

// GCC 12 sees a use after free in the reference counts of CGAL's handles at -O3; there is none.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif

#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/CORE_BigInt.h>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <sstream>
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

/// The coefficients times a positive integer.
std::vector<CORE::BigInt> integers_of(const Polynomial& polynomial) {
  mpz_class denominator = 1;
  std::vector<mpq_class> rational;
  for (const Dyadic& c : polynomial) {
    rational.push_back(c.rational());
    mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), rational.back().get_den_mpz_t());
  }
  std::vector<CORE::BigInt> integers;
  for (const mpq_class& c : rational)
    integers.push_back(big(mpz_class(c.get_num() * (denominator / c.get_den()))));
  return integers;
}
IntegerPolynomial integer_polynomial(const Polynomial& polynomial) {
  const std::vector<CORE::BigInt> integers = integers_of(polynomial);
  return IntegerPolynomial(integers.begin(), integers.end());
}

}  // namespace

struct AlgebraicRoot::Data {
  Kernel::Algebraic_real_1 value;
};

namespace {
std::vector<RealRoot> real_roots(const IntegerPolynomial& p) {
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

}  // namespace
std::vector<RealRoot> real_roots(const Polynomial& polynomial) {
  const auto turn = alone();
  return real_roots(integer_polynomial(polynomial));
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

namespace {

mpq_class rational(const Kernel::Bound& bound) {
  std::ostringstream text;
  text << CGAL::Rational_traits<Kernel::Bound>().numerator(bound) << '/'
       << CGAL::Rational_traits<Kernel::Bound>().denominator(bound);
  mpq_class q(text.str());
  q.canonicalize();
  return q;
}

struct RationalRange {
  mpq_class low, high;
};
RationalRange range_of(const Polynomial& p, const mpq_class& low, const mpq_class& high) {
  RationalRange sum{0, 0};
  for (std::size_t k = p.size(); k-- > 0;) {
    const mpq_class products[] = {sum.low * low, sum.low * high, sum.high * low, sum.high * high};
    const mpq_class c = p[k].rational();
    sum = {*std::min_element(products, products + 4) + c,
           *std::max_element(products, products + 4) + c};
  }
  return sum;
}

}  // namespace

AlgebraicRoot quotient_at(const Polynomial& p, const Polynomial& q, const AlgebraicRoot& x) {
  // k q(u) - p(u), a polynomial in u with coefficients in k, has a root in common with x's
  // polynomial exactly where their resultant vanishes. Roots of q are divided out of x's polynomial
  // before: where p had them, too, the resultant would vanish for every k.
  using Two = CGAL::Polynomial_type_generator<CORE::BigInt, 2>::Type;
  std::vector<RealRoot> candidates;
  {
    const auto turn = alone();
    Polynomial all = p;
    all.insert(all.end(), q.begin(), q.end());
    const std::vector<CORE::BigInt> integers = integers_of(all);
    const auto coefficient = [&](std::size_t first, std::size_t count, std::size_t i) {
      return i < count ? integers[first + i] : CORE::BigInt(0);
    };
    std::vector<IntegerPolynomial> left, right;
    for (std::size_t i = 0; i < std::max(p.size(), q.size()); ++i)
      left.emplace_back(-coefficient(0, p.size(), i), coefficient(p.size(), q.size(), i));
    IntegerPolynomial f = x.data().value.polynomial();
    const IntegerPolynomial common = CommonFactor{}(f, integer_polynomial(q));
    if (CGAL::degree(common) > 0) f = CGAL::integral_division_up_to_constant_factor(f, common);
    for (auto c = f.begin(); c != f.end(); ++c) right.emplace_back(*c);
    candidates =
        real_roots(CGAL::resultant(Two(left.begin(), left.end()), Two(right.begin(), right.end())));
  }
  for (;;) {
    mpq_class low, high;
    {
      const auto turn = alone();
      x.data().value.refine();
      low = rational(x.data().value.low());
      high = rational(x.data().value.high());
    }
    const RationalRange above = range_of(p, low, high), below = range_of(q, low, high);
    if (sgn(below.low) * sgn(below.high) <= 0) continue;
    const mpq_class quotients[] = {above.low / below.low, above.low / below.high,
                                   above.high / below.low, above.high / below.high};
    const mpq_class first = *std::min_element(quotients, quotients + 4),
                    last = *std::max_element(quotients, quotients + 4);
    const RealRoot* found = nullptr;
    int count = 0;
    for (const RealRoot& candidate : candidates)
      if (compare(candidate.value, first) >= 0 && compare(candidate.value, last) <= 0) {
        found = &candidate;
        ++count;
      }
    if (count == 1) return found->value;
  }
}

double approximate(const AlgebraicRoot& root) {
  const auto turn = alone();
  return CGAL::to_double(root.data().value);
}

}  // namespace carom::geometry
