// The Voronoi cell of a lattice, exact on a binary grid.
#include "carom/geometry/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "rational.hpp"

namespace carom::geometry {

namespace {

using Whole = BasicVector<mpz_class>;  // in units of the grid
using Fraction = BasicVector<mpq_class>;

/// A lattice vector and its coefficients in the basis as given.
struct Member {
  Whole vector, coefficients;
  Member operator-() const { return {-vector, -coefficients}; }
  Member operator+(const Member& o) const {
    return {vector + o.vector, coefficients + o.coefficients};
  }
};

Cell cell_of(const Member& m) {
  if (!m.coefficients.x.fits_slong_p() || !m.coefficients.y.fits_slong_p())
    throw std::invalid_argument("lattice vectors that are nearly parallel");
  return {m.coefficients.x.get_si(), m.coefficients.y.get_si()};
}

mpz_class nearest_integer(const mpq_class& q) {
  mpz_class result;
  const mpz_class twice_den = 2 * q.get_den(), numerator = 2 * q.get_num() + q.get_den();
  mpz_fdiv_q(result.get_mpz_t(), numerator.get_mpz_t(), twice_den.get_mpz_t());
  return result;
}

/// Lagrange and Gauss: afterwards 2 |a.b| <= a.a <= b.b. Turned so that a.b <= 0 and b is to the
/// left.
void reduce(Member& a, Member& b) {
  for (;;) {
    if (dot(a.vector, a.vector) > dot(b.vector, b.vector)) std::swap(a, b);
    const mpz_class product = dot(a.vector, b.vector), square = dot(a.vector, a.vector);
    if (2 * abs(product) <= square) break;
    const mpz_class times = nearest_integer(mpq_class(product) / mpq_class(square));
    b.vector = b.vector - times * a.vector;
    b.coefficients = b.coefficients - times * a.coefficients;
  }
  if (dot(a.vector, b.vector) > 0) b = -b;
  if (cross(a.vector, b.vector) < 0) std::swap(a, b);
}

/// The point at equal distance from 0, p and q, displaced by `centre`, on the grid.
Whole corner(const Whole& p, const Whole& q, const Fraction& centre) {
  const mpz_class pp = dot(p, p), qq = dot(q, q), twice = 2 * cross(p, q);
  // c.p = p.p/2 and c.q = q.q/2.
  const mpq_class x(mpz_class(pp * q.y - qq * p.y)), y(mpz_class(qq * p.x - pp * q.x)), d(twice);
  return {nearest_integer(x / d + centre.x), nearest_integer(y / d + centre.y)};
}

bool strictly_convex(const std::vector<Whole>& corners) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Whole before = corners[(i + 1) % n] - corners[i],
                after = corners[(i + 2) % n] - corners[(i + 1) % n];
    if (cross(before, after) <= 0) return false;
  }
  return true;
}

class Grid {
 public:
  explicit Grid(double largest) {
    int exponent = 0;
    std::frexp(largest, &exponent);
    exponent_ = exponent - 52;
  }
  mpq_class scaled(double v) const {
    mpq_class q(v);
    if (exponent_ < 0)
      mpq_mul_2exp(q.get_mpq_t(), q.get_mpq_t(), static_cast<unsigned long>(-exponent_));
    if (exponent_ > 0)
      mpq_div_2exp(q.get_mpq_t(), q.get_mpq_t(), static_cast<unsigned long>(exponent_));
    return q;
  }
  Whole round(Vector v) const {
    return {nearest_integer(scaled(v.x)), nearest_integer(scaled(v.y))};
  }
  Vector position(const Whole& w) const { return {position(w.x), position(w.y)}; }

 private:
  double position(const mpz_class& w) const {
    if (mpz_sizeinbase(w.get_mpz_t(), 2) > 53)
      throw std::invalid_argument("lattice cell beyond its grid");
    return std::ldexp(w.get_d(), exponent_);
  }
  int exponent_ = 0;
};

/// Corners of the hexagon of the neighbours a, a + b, b, -a, -a - b, -b. Opposite edges are
/// translates by a neighbour, which leaves two corners free: the third and following are translates
/// of these.
std::vector<Whole> hexagon(const Member& a, const Member& b, const Fraction& centre) {
  const Whole sum = a.vector + b.vector;
  const Whole first = corner(a.vector, sum, centre), second = corner(sum, b.vector, centre);
  return {first, second, first - a.vector, second - sum, first - sum, second - b.vector};
}

/// The same where a and b are at a right angle: the neighbours are a, b, -a, -b.
std::vector<Whole> quadrilateral(const Member& a, const Member& b, const Fraction& centre) {
  const Whole first = corner(a.vector, b.vector, centre);
  return {first, first - a.vector, first - a.vector - b.vector, first - b.vector};
}

}  // namespace

Lattice make_lattice(Vector first, Vector second, Vector centre) {
  double largest = 0.0;
  for (const double v : {first.x, first.y, second.x, second.y, centre.x, centre.y}) {
    if (!std::isfinite(v)) throw std::invalid_argument("a lattice vector that is not finite");
    largest = std::max(largest, std::fabs(v));
  }
  const Grid grid(largest);
  Member a{grid.round(first), {1, 0}}, b{grid.round(second), {0, 1}};
  if (cross(a.vector, b.vector) == 0)
    throw std::invalid_argument("lattice vectors that are parallel or zero");
  Lattice lattice{grid.position(a.vector), grid.position(b.vector), {}};
  const Fraction middle{grid.scaled(centre.x), grid.scaled(centre.y)};
  reduce(a, b);

  std::vector<Whole> corners;
  std::vector<Member> beyond;
  if (dot(a.vector, b.vector) != 0) {
    corners = hexagon(a, b, middle);
    beyond = {a + b, b, -a, -(a + b), -b, a};
  }
  // Nearly a rectangle: two edges are shorter than the grid can show. The parallelogram of a and b
  // about the same centre has exact translates as well, and is as good a cell.
  if (corners.empty() || !strictly_convex(corners)) {
    corners = quadrilateral(a, b, middle);
    beyond = {b, -a, -b, a};
  }
  if (!strictly_convex(corners))
    throw std::invalid_argument("lattice vectors that are nearly parallel");
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Segment edge{grid.position(corners[i]), grid.position(corners[(i + 1) % corners.size()])};
    lattice.edges.push_back({edge, cell_of(beyond[i])});
  }
  return lattice;
}

}  // namespace carom::geometry
