#include "forces/lattice_bumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "carom/base/elementary.hpp"
#include "forces/bumps.hpp"
#include "forces/central_bounds.hpp"

namespace carom::forces {

using geometry::Vector;

namespace {

struct Sums {
  double value = 0.0, x = 0.0, y = 0.0;
};
/// Eight near copies.
struct Eight {
  alignas(64) std::array<double, 8> dx, dy, r, e;
};

/// The exponents of the first n copies. The compiler must not know n: it would unroll the loop and
/// make no vectors.
CAROM_INLINE void find_exponents(const LatticeSum& t, const GridPoint<double>& p, const double* x,
                                 std::size_t n, Eight& to) {
  const double* y = x + t.padded_near;
  for (std::size_t k = 0; k < n; ++k) {
    to.dx[k] = p.dx + x[k];
    to.dy[k] = p.dy + y[k];
  }
  if (t.fermi) {
    for (std::size_t k = 0; k < n; ++k)
      lattice_sum::fermi_exponent(t, to.dx[k], to.dy[k], to.r[k], to.e[k]);
  } else {
    for (std::size_t k = 0; k < n; ++k)
      to.e[k] = lattice_sum::gaussian_exponent(t, to.dx[k], to.dy[k]);
  }
}

/// Eight running sums, in registers of W numbers.
template <int W>
struct Running {
  using Numbers = typename Register<W>::Type;
  Numbers value[8 / W] = {}, x[8 / W] = {}, y[8 / W] = {};

  /// Adds the first `count` copies.
  CAROM_INLINE void add(const LatticeSum& t, const Eight& n, int count) {
#pragma GCC unroll 4
    for (int p = 0; p < 8 / W; ++p) {
      Numbers dx, dy, r, e, v, f;
      const auto at = static_cast<std::size_t>(W * p);
      lattice_sum::load(dx, n.dx.data() + at);
      lattice_sum::load(dy, n.dy.data() + at);
      lattice_sum::load(e, n.e.data() + at);
      v = f = e;
      if (t.fermi) {
        lattice_sum::load(r, n.r.data() + at);
        lattice_sum::fermi_bump(r, e, v, f);
      }
      typename Register<W>::Masks real;
      std::memcpy(&real, lattice_sum::first_masks + (8 - count) + W * p, sizeof real);
      const Numbers zero{};
      value[p] += real ? v : zero;
      x[p] += real ? f * dx : zero;
      y[p] += real ? f * dy : zero;
    }
  }
};

template <int W>
CAROM_INLINE Sums sums_at(const LatticeField& field, Vector x, elementary::ExpOfMany exponentials) {
  const LatticeSum& t = field.sum;
  const GridPoint<double> p = lattice_sum::locate(t, x.x, x.y);
  const double* node = lattice_sum::node_at(t, p.i, p.j);
  lattice_sum::Slopes slopes{};
  if (t.degree >= 0)
    slopes = lattice_sum::polynomial<W>(node + 2 * t.padded_near, t.degree, p.X, p.Y);
  Running<W> running;
  Eight n{};
  for (int from = 0; from < t.near; from += 8) {
    const int count = std::min(8, t.near - from);
    const auto whole = static_cast<std::size_t>((count + W - 1) / W * W);
    find_exponents(t, p, node + from, whole, n);
    exponentials(n.e.data(), whole);
    running.add(t, n, count);
  }
  Sums sums;
  double unused;
  lattice_sum::totals<W>(running.x, running.y, sums.x, sums.y);
  lattice_sum::totals<W>(running.value, running.value, sums.value, unused);
  sums.x *= field.steepness;
  sums.y *= field.steepness;
  if (t.degree >= 0) {
    sums.value += slopes.value;
    lattice_sum::add_slopes(t, slopes.X, slopes.Y, sums.x, sums.y);
  }
  return sums;
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
[[gnu::target("avx512f,prefer-vector-width=512")]] Sums sums_by_eight(const LatticeField& field,
                                                                      Vector x) {
  return sums_at<8>(field, x, elementary::exp_by(8));
}
[[gnu::target("avx2")]] Sums sums_by_four(const LatticeField& field, Vector x) {
  return sums_at<4>(field, x, elementary::exp_by(4));
}
#endif
Sums sums_by_two(const LatticeField& field, Vector x) {
  return sums_at<2>(field, x, elementary::exp_by(2));
}

using SumsAt = Sums (*)(const LatticeField&, Vector);
SumsAt widest() {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
  if (__builtin_cpu_supports("avx512f")) return sums_by_eight;
  if (__builtin_cpu_supports("avx2")) return sums_by_four;
#endif
  return sums_by_two;
}

class LatticeBumps final : public Potential {
 public:
  LatticeBumps(const BumpShape& shape, double height, const std::vector<Vector>& centers,
               const geometry::Lattice& lattice, double reach)
      : shape_(shape),
        centers_(centers),
        lattice_(lattice),
        table_(shape, centers, lattice, reach),
        sum_reach_(reach),
        sums_at_(widest()) {
    const bool fermi = shape.kind == BumpShape::Kind::fermi;
    reach_ = fermi ? shape.radius + tail_exponent * shape.softness
                   : std::sqrt(2.0 * tail_exponent) * shape.width;
    field_ = {table_.sum(), height,
              fermi ? 1.0 / shape.softness : 1.0 / (shape.width * shape.width)};
  }

  double add_force(const Particle&, Vector x, Vector& force) const override {
    const Sums sums = sums_at_(field_, x);
    force.x += field_.height * sums.x;
    force.y += field_.height * sums.y;
    return field_.height * sums.value;
  }
  /// Copies that a complex displacement leaves below tail_share are left out, as in the sum itself.
  ForceBound bound(const Particle&, const Neighbourhood& n) const override {
    constexpr double most = 4096.0;
    const Vector middle = 0.5 * (n.low + n.high), half = n.high - middle;
    const auto seen = seen_from_copies(middle, centers_, lattice_,
                                       reach_ + 3.0 * n.rho + std::sqrt(dot(half, half)), most);
    if (!seen) return {central::none, 0.0};
    ForceBound sum;
    for (const Vector& d : *seen) {
      const central::Distances from = central::distances({d - half, d + half, n.rho}, {});
      if (shape_.kind == BumpShape::Kind::fermi)
        sum += central::fermi(field_.height, shape_.radius, shape_.softness, from);
      else
        sum.force += central::gaussian(field_.height, shape_.width, from);
    }
    return sum;
  }
  // The sum of all copies itself: a table of forces has no second derivatives to the last digits.
  void add_hessian(const Particle&, Vector x, Hessian& hessian) const override {
    const auto seen = seen_from_copies(x, centers_, lattice_, sum_reach_,
                                       std::numeric_limits<double>::infinity());
    for (const Vector& d : *seen) add_bump_hessian(shape_, field_.height, d, hessian);
  }
  double reach() const override { return reach_; }
  double tail() const override { return tail_share * std::fabs(field_.height); }
  const LatticeField* lattice_field() const override { return &field_; }

 private:
  BumpShape shape_;
  std::vector<Vector> centers_;
  geometry::Lattice lattice_;
  LatticeTable table_;
  LatticeField field_;
  double reach_ = 0.0, sum_reach_;
  SumsAt sums_at_;
};

}  // namespace

std::unique_ptr<const Potential> make_lattice_bumps(const BumpShape& shape, double height,
                                                    const std::vector<Vector>& centers,
                                                    const geometry::Lattice& lattice,
                                                    double reach) {
  return std::make_unique<LatticeBumps>(shape, height, centers, lattice, reach);
}

}  // namespace carom::forces
