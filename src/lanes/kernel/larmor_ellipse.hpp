// Larmor flights against ellipses in lanes: where they leave first, and whether that is certain.
// docs/developer/lanes.md derives the margins.
#pragma once

#include "carom/geometry/first_root.hpp"
#include "carom/geometry/formulas.hpp"
#include "lanes/kernel/flight.hpp"

namespace carom::lanes {
namespace {

/// geometry::RoughCubeRoot.
struct CubeRoots {
  CAROM_INLINE Real operator()(const Real& x) const {
    if constexpr (avx512) {
      const hn::RebindToSigned<Doubles> words;
      const Real bits = hn::ConvertTo(doubles, hn::BitCast(words, x.lanes));
      const auto part = hn::ConvertTo(words, (geometry::RoughCubeRoot::third * bits).lanes);
      return hn::BitCast(doubles, hn::Add(part, hn::Set(words, geometry::RoughCubeRoot::offset)));
    } else {
      alignas(64) double roots[width];
      store(x, roots);
      for (double& each : roots) each = geometry::RoughCubeRoot{}(each);
      return load(roots);
    }
  }
};

/// Where a Larmor circle first leaves through an ellipse, all of it.
struct RootOnEllipse {
  Real kappa;
  Mask certain{false};  ///< there, and nowhere before
  Mask only{false};     ///< there, and nowhere else
  Mask none{false};     ///< certain to leave nowhere
  Real spread{0.0};     ///< bounds the error of kappa
};

/// An ellipse as it is met by a circle.
struct EllipseInField {
  Vector centre, first, second;
  Real orientation, stretch;
};

CAROM_INLINE geometry::Quartic<Real> quartic_of_ellipse(const View& f,
                                                        const EllipseInField& ellipse,
                                                        const Mask& on_wall) {
  const auto image = [&](const Vector& x) {
    return Vector{dot(ellipse.first, x), dot(ellipse.second, x)};
  };
  const Vector e = image(f.origin - ellipse.centre);
  auto q = geometry::ellipse_quartic(e, choose(on_wall, dot(e, e), Real(1.0)), image(f.velocity),
                                     image(geometry::right(f.velocity)), f.omega, Real(0.5));
  for (Real& x : q.q) x = -ellipse.orientation * x;
  return q;
}

/// From a point of it: the largest root of a cubic. `q[4]` is not looked at.
CAROM_INLINE RootOnEllipse root_from_ellipse(const View& f, const geometry::Quartic<Real>& quartic,
                                             const Real& stretch) {
  const auto& q = quartic.q;
  const Real x = geometry::largest_root(q[3], q[2], q[1], q[0], CubeRoots{});
  const Real third = fused(q[3], x, q[2]), fourth = fused(third, x, q[1]);
  const Real value = fused(fourth, x, q[0]);
  const Real second = fused(q[3], x + x, third), first = fused(x, second, fourth);
  const Real y = abs(x) + abs(f.omega);  // beyond |x| + |omega|/2
  const Real bend =
      (stretch * f.speed) * fused(y, Real(2.0 * f.table.size), f.speed);  // size of f''
  const Real size = bend * (y * y);                                       // of f
  const Mask there = q[3] > 0.0 && first > 0.0 && abs(value) <= 0x1p-44 * size &&
                     first * first > (0x1p-38 * size) * abs(second) &&
                     (first * first) * first > ((0x1p-54 * size) * size) * q[3];
  const Real product = q[3] * first;
  const Mask only = second * second < (4.0 - 0x1p-8) * product && product > (0x1p-58 * bend) * bend;
  return {x, there && (second > 0x1p-38 * bend || only), there && only, Mask(false),
          0x1p-41 * size / first};
}

/// From beside it: a quartic.
CAROM_INLINE RootOnEllipse root_to_ellipse(const View& f, const geometry::Quartic<Real>& quartic,
                                           const Real& stretch) {
  const auto& q = quartic.q;
  const Real x = geometry::first_rising_root(quartic, CubeRoots{});
  const Real c3 = fused(q[4], x, q[3]), c2 = fused(c3, x, q[2]), c1 = fused(c2, x, q[1]),
             value = fused(c1, x, q[0]);
  const Real d3 = fused(q[4], x, c3), d2 = fused(d3, x, c2), first = fused(d2, x, c1);
  const Real e3 = fused(q[4], x, d3), second = fused(e3, x, d2), third = fused(q[4], x, e3);
  const Real h = abs(f.omega), y = abs(x) + h, reach = fused(y, Real(f.table.size), f.speed);
  const Real size = stretch * (y * y) * (reach * reach), inverse = 1.0 / size;
  // All of the size 1 at most, and certain to 2^-40.
  const Real b1 = first * y * inverse, b2 = second * (y * y) * inverse,
             b3 = third * (y * y * y) * inverse, b4 = q[4] * (y * y) * (y * y) * inverse;
  const Real spread = 0x1p-41 / b1;  // of the root, in y
  const Mask there = b1 > 0.0 && abs(value) <= 0x1p-44 * size && spread * abs(b2) < 0.125 * b1 &&
                     spread * spread * max(abs(b3), abs(b4)) < 0.125 * b1 && spread < 1.0;
  // Of what is left when the root is taken out: below zero if it has one real root, also with all
  // that its numbers err and change from the root to the end of its spread.
  const Real s2 = b2 * b2, s3 = b3 * b3, p14 = b1 * b4, p23 = b2 * b3;
  const Real discriminant =
      s2 * s3 - 4.0 * (b1 * b3 * s3 + b2 * s2 * b4) + p14 * (18.0 * p23 - 27.0 * p14);
  const Real t4(0x1p-40), t3 = t4 + 4.0 * spread * abs(b4),
                          t2 = t4 + spread * (3.0 * abs(b3) + 6.0 * abs(b4)),
                          t1 = t4 + spread * (2.0 * abs(b2) + 3.0 * abs(b3) + 4.0 * abs(b4));
  const Real a1 = abs(b1) + t1, a2 = abs(b2) + t2, a3 = abs(b3) + t3, a4 = abs(b4) + t4,
             a23 = 18.0 * a2 * a3, a14 = 54.0 * a1 * a4;
  const Real change = t1 * (4.0 * a3 * a3 * a3 + a4 * (a23 + a14)) +
                      t2 * (a2 * (2.0 * a3 * a3 + 12.0 * a2 * a4) + a14 * a3) +
                      t3 * (a3 * (2.0 * a2 * a2 + 12.0 * a1 * a3) + a14 * a2) +
                      t4 * (4.0 * a2 * a2 * a2 + a1 * (a23 + a14));
  const Mask only = there && discriminant < -1.01 * change;
  const Mask grows = b2 > 0x1p-38 && b3 > 0x1p-38 && b4 > 0x1p-38;
  RootOnEllipse root{x, only || (there && grows), only, Mask(false), spread * y};
  // No root at all if q or -q is a positive form of (1, x, x^2). Of the square of x, 2l may be
  // given to the product of the other two; all in units of what these are at most, and the best l
  // is the root of a quadratic.
  const Real half = 0.5 * h, wide = fused(half, Real(f.table.size), f.speed),
             share = choose(q[4] < 0.0, Real(-1.0), Real(1.0)) / stretch;
  const Real u4(1.0 / f.table.size), u2 = 1.0 / wide, u0 = u2 / half;
  const Real k4 = q[4] * u4 * u4 * share, k3 = 0.5 * q[3] * u4 * u2 * share,
             k2 = q[2] * u2 * u2 * share, k1 = 0.5 * q[1] * u2 * u0 * share,
             k0 = q[0] * u0 * u0 * share;
  const Real ratio = f.table.size * half * u2, twist = k1 * k3 - ratio * k4 * k0;
  const Real l = 2.0 * twist / (k2 + sqrt(max(k2 * k2 - 12.0 * ratio * twist, Real(0.0)))),
             middle = k2 - 2.0 * ratio * l;
  const Real minor = k4 * middle - k3 * k3;
  const Real determinant = k0 * minor - k4 * k1 * k1 + l * (2.0 * k1 * k3 - l * middle);
  const Real row4 = abs(k4) + abs(k3) + abs(l), row2 = abs(k3) + abs(middle) + abs(k1),
             row0 = abs(l) + abs(k1) + abs(k0);
  root.none = k4 > 0x1p-38 && minor > 0x1p-38 * (row4 + row2) &&
              determinant > 0x1p-38 * (row4 * row2 + row2 * row0 + row0 * row4);
  return root;
}

/// From wherever the particles are.
CAROM_INLINE RootOnEllipse root_on_ellipse(const View& f, const EllipseInField& ellipse,
                                           const Mask& on_wall) {
  const auto q = quartic_of_ellipse(f, ellipse, on_wall);
  if (!any_of(!on_wall)) return root_from_ellipse(f, q, ellipse.stretch);
  const RootOnEllipse to = root_to_ellipse(f, q, ellipse.stretch);
  if (!any_of(on_wall)) return to;
  const RootOnEllipse from = root_from_ellipse(f, q, ellipse.stretch);
  return {choose(on_wall, from.kappa, to.kappa),
          (on_wall && from.certain) || (!on_wall && to.certain),
          (on_wall && from.only) || (!on_wall && to.only), !on_wall && to.none,
          choose(on_wall, from.spread, to.spread)};
}
CAROM_INLINE EllipseInField ellipse_in_field(const LaneTable& t, int i) {
  const auto& all = t.ellipses;
  return {{Real(t.point_x[i]), Real(t.point_y[i])},
          {Real(all.first_x[i]), Real(all.first_y[i])},
          {Real(all.second_x[i]), Real(all.second_y[i])},
          Real(t.orientation[i]),
          Real(all.stretch[i])};
}

/// The exit through pieces that are of one ellipse, one piece after the other.
class ExitThroughEllipse {
 public:
  template <class Earliest>
  CAROM_INLINE void begin(Earliest& best, const View& f, int i, const Mask& on_wall) {
    const LaneTable& t = f.table;
    root_ = root_on_ellipse(f, ellipse_in_field(t, i), on_wall);
    left_ = root_.certain && !root_.only;
    best.doubt(!root_.certain && !root_.none);
    if (t.closed[i]) return;
    const auto factors = geometry::flight_factors(root_.kappa, f.omega, Real(0.5));
    point_ = f.origin + geometry::displacement(factors, f.velocity);
    // It must be known well enough to be seen from a chord.
    const Real n = root_.kappa * root_.kappa + 0.25 * (f.omega * f.omega);
    best.doubt(root_.certain && root_.spread * f.speed > (0x1p-31 * t.size) * n);
  }
  template <class Earliest>
  CAROM_INLINE void add(Earliest& best, const View& f, int i) {
    const LaneTable& t = f.table;
    Mask leaves = root_.certain;
    if (!t.closed[i]) {
      const Vector chord{Real(t.chord_x[i]), Real(t.chord_y[i])},
          from{Real(t.joint_x[i]), Real(t.joint_y[i])};
      const Real side = Real(-t.orientation[i]) * cross(chord, point_ - from),
                 margin(0x1p-30 * t.size);
      best.doubt(leaves && abs(side) <= margin);
      leaves = leaves && side > margin;
    }
    left_ = left_ && !leaves;
    best.add_root(i, leaves, root_.kappa, root_.spread);
  }
  /// Off all pieces: there may be another exit.
  template <class Earliest>
  CAROM_INLINE void end(Earliest& best) const {
    best.doubt(left_);
  }

 private:
  RootOnEllipse root_{};
  Vector point_{};
  Mask left_{false};
};

}  // namespace
}  // namespace carom::lanes
