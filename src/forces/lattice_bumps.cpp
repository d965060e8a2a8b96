#include "forces/lattice_bumps.hpp"

#include <array>
#include <span>

#include "carom/base/elementary.hpp"
#include "forces/bumps.hpp"

namespace carom {

using geometry::Vector;

namespace {

class LatticeBumps final : public Potential {
 public:
  LatticeBumps(const BumpShape& shape, double height, const std::vector<Vector>& centers,
               const geometry::Lattice& lattice, double reach)
      : table_(shape, centers, lattice, reach), height_(height) {
    const bool fermi = shape.kind == BumpShape::Kind::fermi;
    reach_ = fermi ? shape.radius + tail_exponent * shape.softness : std::sqrt(2.0 * tail_exponent) * shape.width;
    steepness_ = fermi ? 1.0 / shape.softness : 1.0 / (shape.width * shape.width);
  }

  double add_force(const Particle&, Vector x, Vector& force) const override {
    Sums sums;
    const LatticeSum& t = table_.sum();
    const GridPoint p = lattice_sum::locate(t, x.x, x.y);
    add_near(p, sums);
    if (t.degree >= 0) add_polynomial(p, sums);
    force.x += height_ * sums.x;
    force.y += height_ * sums.y;
    return height_ * sums.value;
  }
  double reach() const override { return reach_; }
  double tail() const override { return tail_share * std::fabs(height_); }

 private:
  struct Sums {
    double value = 0.0, x = 0.0, y = 0.0;
  };
  struct Eights {
    alignas(64) std::array<double, 8> dx, dy, r, e;
  };

  void add_near(const GridPoint& p, Sums& sums) const {
    const LatticeSum& t = table_.sum();
    Eight value{}, fx{}, fy{};
    Eights n;
    for (int from = 0; from < t.near; from += 8) {
      exponents(p, from, n);
      elementary::exp(std::span<double>(n.e));
      add_eight(n, t.near - from, value, fx, fy);
    }
    sums.value = lattice_sum::total(value);
    sums.x = steepness_ * lattice_sum::total(fx);
    sums.y = steepness_ * lattice_sum::total(fy);
  }
  CAROM_VECTORISED void exponents(const GridPoint& p, int from, Eights& n) const {
    const LatticeSum& t = table_.sum();
    const double* x = t.nodes + p.node * t.stride + from;
    const double* y = x + t.padded_near;
    for (std::size_t k = 0; k < 8; ++k) {
      n.dx[k] = p.dx + x[k];
      n.dy[k] = p.dy + y[k];
      if (t.fermi)
        lattice_sum::fermi_exponent(t, n.dx[k], n.dy[k], n.r[k], n.e[k]);
      else
        n.e[k] = lattice_sum::gaussian_exponent(t, n.dx[k], n.dy[k]);
    }
  }
  /// The first `count` of eight copies.
  CAROM_VECTORISED void add_eight(const Eights& n, int count, Eight& value, Eight& fx, Eight& fy) const {
    Eight dx, dy, r, e, v, f;
    lattice_sum::load(dx, n.dx.data());
    lattice_sum::load(dy, n.dy.data());
    lattice_sum::load(e, n.e.data());
    v = f = e;
    if (table_.sum().fermi) {
      lattice_sum::load(r, n.r.data());
      lattice_sum::fermi_bump(r, e, v, f);
    }
    const Eight zero{};
    const EightMasks index = {0, 1, 2, 3, 4, 5, 6, 7};
    const EightMasks real = index < std::int64_t{count};
    value += real ? v : zero;
    fx += real ? f * dx : zero;
    fy += real ? f * dy : zero;
  }
  CAROM_VECTORISED void add_polynomial(const GridPoint& p, Sums& sums) const {
    const LatticeSum& t = table_.sum();
    const lattice_sum::Slopes s = lattice_sum::polynomial(t.rows(p.node), t.degree, p.X, p.Y);
    sums.value += s.value;
    lattice_sum::add_slopes(t, s.X, s.Y, sums.x, sums.y);
  }

  LatticeTable table_;
  double height_, reach_ = 0.0, steepness_ = 0.0;
};

}  // namespace

std::unique_ptr<const Potential> make_lattice_bumps(const BumpShape& shape, double height,
                                                    const std::vector<Vector>& centers,
                                                    const geometry::Lattice& lattice, double reach) {
  return std::make_unique<LatticeBumps>(shape, height, centers, lattice, reach);
}

}  // namespace carom
