// Larmor flights in lanes: which piece comes first, by signs with margins, and the hit there.
// docs/developer/lanes.md derives the margins.
//
// Signs are taken from the centre Z of the Larmor circle, seen from a joint or from the centre
// of an arc and times |omega|: c = |omega| (Z - J), which is |omega| (P - J) + Jv for a
// clockwise flight. J lies inside the circle if |c| is below the speed.
#pragma once

#include "base/angle.hpp"
#include "lanes/kernel/larmor_ellipse.hpp"
#include "lanes/kernel/met.hpp"

namespace carom::lanes {
namespace {

struct CircleView {
  Vector centre;    ///< |omega| Z
  Real rate, back;  ///< |omega|, -|omega|
  Real minus_square_speed;
  Real lengths;  ///< margin of all lengths times |omega| ...
  Real squares;  ///< ... and of their squares
  Real joints;   ///< of |c|^2 - v^2
};
CAROM_INLINE CircleView circle_of(const View& f) {
  const Real rate = abs(f.omega);
  return {{fused(rate, f.origin.x, turned_by(f.velocity.y, f.omega)),
           fused(rate, f.origin.y, -turned_by(f.velocity.x, f.omega))},
          rate,
          -rate,
          -f.square_speed,
          0x1p-40 * f.pace,
          (0x1p-40 * f.pace) * f.pace,
          f.joint_margin};
}

struct JointOfCircle {
  Vector centre;
  Real side;  ///< |c|^2 - v^2: below zero inside
  Mask inside;
};
CAROM_INLINE JointOfCircle joint_at(const View& f, const CircleView& z, int i, Real& least) {
  const LaneTable& t = f.table;
  const Vector c{fused(z.back, Real(t.joint_x[i]), z.centre.x),
                 fused(z.back, Real(t.joint_y[i]), z.centre.y)};
  const Real side = fused(c.x, c.x, fused(c.y, c.y, z.minus_square_speed));
  least = least_size(least, side);
  return {c, side, side < 0.0};
}

/// Positive if a segment whose ends lie outside the circle is cut twice: if the foot of the centre
/// lies between them, nearer than the radius. Of its first end: `c` seen from it, `side` = |c|^2 -
/// v^2.
CAROM_INLINE Real cut_of_segment(const View& f, const CircleView& z, int i,
                                 const JointOfCircle& end) {
  const LaneTable& t = f.table;
  const Real foot = fused(end.centre.x, Real(t.chord_x[i]), end.centre.y * t.chord_y[i]),
             square = foot * foot;
  return min(fused(foot, z.rate * t.length[i], -square), square - end.side);
}

/// Positive if the whole circle of an arc is cut.
CAROM_INLINE Real cut_of_circle(const View& f, const CircleView& z, int i, const Real& distance) {
  const Real radius = z.rate * f.table.radius[i];
  return min(f.speed + radius - distance, distance - abs(radius - f.speed));
}
/// Positive if an arc whose joints lie on one side of the Larmor circle is cut twice: if its circle
/// is, and the middle of the part on the other side lies on the arc's side of its chord.
CAROM_INLINE Real cut_of_arc(const View& f, const CircleView& z, int i, const Mask& inside) {
  const LaneTable& t = f.table;
  const Vector c{fused(z.back, Real(t.point_x[i]), z.centre.x),
                 fused(z.back, Real(t.point_y[i]), z.centre.y)};
  const Real distance = sqrt(fused(c.x, c.x, c.y * c.y));
  const Real towards = cross(Vector{Real(t.chord_x[i]), Real(t.chord_y[i])}, c);
  const Real middle = fused(distance, Real(t.chord_offset[i]), choose(inside, -towards, towards));
  return min(cut_of_circle(f, z, i, distance), -t.orientation[i] * middle);
}

/// A convex loop alone, from one of its walls: the first wall, backwards for a clockwise flight,
/// whose joint there lies inside the circle or that is cut twice; or the start.
template <bool clockwise, Kind kind>
CAROM_INLINE Choice exit_of_loop_by_circle(const View& f) {
  const LaneTable& t = f.table;
  if (t.pieces == 1) return {Real(0.0), Mask(true), Real(0.0)};
  const CircleView z = circle_of(f);
  // The start comes last in the flight's order; `behind`: of the walls from it on, `any`: of all.
  Real behind(-1.0), any = f.start_piece;
  Real least(__builtin_huge_val()), least_cut = least;
  Mask certain(true);
  JointOfCircle before = joint_at(f, z, 0, least);
  const JointOfCircle first = before;
  for (int k = 0; k < t.pieces; ++k) {
    const int i = clockwise ? k : t.pieces - 1 - k;
    const int joint = clockwise ? i + 1 : i;
    const JointOfCircle after = k + 1 == t.pieces ? first : joint_at(f, z, joint, least);
    Real cut;
    if (kind.circles && t.bent[i]) {
      cut = cut_of_arc(f, z, i, Mask(false));
      certain = certain && (before.inside || after.inside || abs(cut) > z.lengths);
    } else {
      cut = cut_of_segment(f, z, i, clockwise ? before : after);
      least_cut = least_size(least_cut, cut);
    }
    const Real piece(counted[i]);
    const Mask leaves = before.inside || (cut > 0.0 && !after.inside && f.start_piece != piece);
    where(leaves, any) = piece;
    where(leaves && (clockwise ? f.start_piece >= piece : f.start_piece <= piece), behind) = piece;
    before = after;
  }
  certain = certain && least > z.joints && least_cut > z.squares && any >= 0.0;
  return {choose(behind >= 0.0, behind, any), certain, Real(0.0)};
}

template <Kind kind>
CAROM_INLINE Choice exit_of_loop_by_circle(const View& f) {
  return f.table.clockwise ? exit_of_loop_by_circle<true, kind>(f)
                           : exit_of_loop_by_circle<false, kind>(f);
}

/// Where a flight leaves through a piece: kappa = p / q.
struct Fraction {
  Real p, q;
  Mask decided;
  Real root;  ///< of the discriminant
};
/// The rising root of the quadratic of a segment or circle, whose sizes are powers of two.
CAROM_INLINE Fraction rising_root(const View& f, const geometry::Quadratic<Real>& quadratic,
                                  const Mask& on_wall, const Real& length) {
  const auto& [a, b, c] = quadratic;
  const Real discriminant = geometry::discriminant_of(quadratic);
  const Real root = sqrt(max(discriminant, Real(0.0)));
  const Real n = abs(b) + root;
  const Mask falls = b <= 0.0;
  const Real size = length * f.pace;
  const Mask decided = (on_wall && b > sign_margin * size) ||
                       (!on_wall && discriminant > (sign_margin * size) * size &&
                        (!falls || abs(a) > (sign_margin * f.table.size) * length));
  return {choose(falls, n, -c), choose(falls, a, n), decided, root};
}

/// Any table: the earliest of all exits. `finely`: each fraction is known as well as its own root,
/// for tables that are far larger than the flights there.
template <bool finely>
class EarliestOnCircle {
 public:
  explicit EarliestOnCircle(const View& f)
      : f_(f), decided_(true), piece_(-1.0), p_(-1.0), q_(0.0) {}

  CAROM_INLINE void doubt(const Mask& where_not) { decided_ = decided_ && !where_not; }
  /// `length`: the size of the quadratic's leading coefficient in sizes.
  CAROM_INLINE void add(int i, const Mask& leaves, const geometry::Quadratic<Real>& quadratic,
                        const Mask& on_wall, double length) {
    const Fraction r = rising_root(f_, quadratic, on_wall, Real(length));
    doubt(leaves && !r.decided);
    // Both brought to the sizes pace and size by powers of two, the divisor positive.
    const Real falling = Real(1.0 / length), rising = f_.table.size / (length * f_.pace);
    Real scale = choose(quadratic.b <= 0.0, falling, rising);
    where(r.q < 0.0, scale) = -scale;
    const Real p = r.p * scale, q = r.q * scale;
    const Real gap = fused(p, q_, -(p_ * q));
    Real unsure = (0x1p-20 * f_.table.size) * f_.pace, off_p, off_q;
    if constexpr (finely) {
      const Mask falls = quadratic.b <= 0.0;
      const Real of_root = (0x1p-41 * length) * f_.pace / r.root, least(0x1p-43);
      off_p = f_.pace * choose(falls, of_root, least);
      off_q = f_.table.size * choose(falls, least, of_root);
      unsure = fused(abs(q_), off_p, fused(abs(p_), off_q, fused(abs(q), off_p_, abs(p) * off_q_)));
    }
    doubt(leaves && piece_ >= 0.0 && abs(gap) <= unsure);
    const Mask better = leaves && gap > 0.0;
    where(better, p_) = p;
    where(better, q_) = q;
    if constexpr (finely) {
      where(better, off_p_) = off_p;
      where(better, off_q_) = off_q;
    }
    where(better, piece_) = Real(counted[i]);
    of_root_ = of_root_ && !better;
  }
  /// A root as computed, which errs by less than `spread`.
  CAROM_INLINE void add_root(int i, const Mask& leaves, const Real& kappa, const Real& spread) {
    const Real size(f_.table.size), far = abs(kappa);
    const Real q = choose(far * size <= f_.pace, size, f_.pace / far), p = kappa * q;
    const Real gap = fused(p, q_, -(p_ * q));
    doubt(leaves && ((piece_ >= 0.0 && abs(gap) <= (0x1p-20 * size) * f_.pace) ||
                     spread * q > 0x1p-21 * f_.pace));
    const Mask better = leaves && gap > 0.0;
    where(better, p_) = p;
    where(better, q_) = q;
    where(better, kappa_) = kappa;
    where(better, piece_) = Real(counted[i]);
    of_root_ = of_root_ || better;
  }
  CAROM_INLINE Choice choice() const {
    return {piece_, decided_ && piece_ >= 0.0, choose(of_root_, kappa_, p_ / q_)};
  }

 private:
  const View& f_;
  Mask decided_;
  Real piece_, p_, q_;
  Real off_p_{0.0}, off_q_{0.0};  ///< what they err by at most
  Real kappa_{0.0};
  Mask of_root_{false};
};

/// The quadratic of a piece for flights from this start.
CAROM_INLINE geometry::Quadratic<Real> quadratic_of_segment(const View& f, const Vector& point,
                                                            const Vector& tangent,
                                                            const Mask& on_wall) {
  Vector e = f.origin - point;
  where(on_wall, e.x) = Real(0.0);
  where(on_wall, e.y) = Real(0.0);
  return geometry::line_quadratic(e, tangent, f.velocity, f.omega, Real(0.5));
}
CAROM_INLINE geometry::Quadratic<Real> quadratic_of_circle(const View& f, const Vector& point,
                                                           const Real& square,
                                                           const Real& orientation,
                                                           const Mask& on_wall) {
  const Vector e = f.origin - point;
  const auto q = geometry::circle_quadratic(e, choose(on_wall, dot(e, e), square), f.velocity,
                                            f.square_speed, f.omega, Real(0.5));
  return {-orientation * q.a, -orientation * q.b, -orientation * q.c};
}

template <Kind kind>
CAROM_INLINE Choice first_of_all_by_circle(const View& f) {
  const LaneTable& t = f.table;
  const double* const wall = wall_numbers<kind>(t);
  const CircleView z = circle_of(f);
  EarliestOnCircle<kind.cells> best(f);
  Real least(__builtin_huge_val());
  ExitThroughEllipse exit;
  for (int loop = 0; loop < t.loops; ++loop) {
    const int first = t.first[loop], last = first + t.count[loop] - 1;
    const bool closed = t.closed[first];
    JointOfCircle start{}, a{};
    if (!closed) a = start = joint_at(f, z, first, least);
    for (int i = first; i <= last; ++i) {
      const Real piece(counted[i]);
      const Mask on_wall = f.start_wall == Real(wall[i]), own = f.start_piece == piece;
      if constexpr (kind.ellipses) {
        if (t.ellipses.of[i]) {
          if (i == first || wall[i] != wall[i - 1]) exit.begin(best, f, i, on_wall);
          exit.add(best, f, i);
          if (i == last || wall[i] != wall[i + 1]) exit.end(best);
          if (!closed && i != last) a = joint_at(f, z, i + 1, least);
          continue;
        }
      }
      const bool bent = kind.circles && t.bent[i];
      JointOfCircle b{};
      Mask leaves;
      if (closed) {
        const Vector c{z.centre.x - z.rate * t.point_x[i], z.centre.y - z.rate * t.point_y[i]};
        const Real cut = cut_of_circle(f, z, i, sqrt(dot(c, c)));
        best.doubt(!on_wall && abs(cut) <= z.lengths);
        leaves = on_wall || cut > 0.0;
      } else {
        b = i == last ? start : joint_at(f, z, i + 1, least);
        const Mask out = t.clockwise ? a.inside && !b.inside : b.inside && !a.inside;
        const Mask same = a.inside == b.inside,
                   open = bent ? same && !on_wall : same && !on_wall && !a.inside;
        const Real cut = bent ? cut_of_arc(f, z, i, a.inside) : cut_of_segment(f, z, i, a);
        best.doubt(open && abs(cut) <= (bent ? z.lengths : z.squares));
        leaves = out || (same && own) || (open && cut > 0.0);
        a = b;
      }
      if (!any_of(leaves)) continue;
      const Vector point{Real(t.point_x[i]), Real(t.point_y[i])};
      if (bent) {
        best.add(i, leaves,
                 quadratic_of_circle(f, point, Real(t.second_number[i]), Real(t.orientation[i]),
                                     on_wall),
                 on_wall, t.size);
      } else {
        best.add(i, leaves,
                 quadratic_of_segment(
                     f, point, {Real(-t.second_number[i]), Real(t.first_number[i])}, on_wall),
                 on_wall, 1.0);
      }
    }
  }
  best.doubt(least <= z.joints);
  return best.choice();
}

// Tangents of the angles by which a direction is turned back, as y/x.
alignas(64) constexpr double back_x[16] = {1, 2, 1, 1, 0}, back_y[16] = {0, 1, 1, 2, 1};

/// base::angle: the same operations in the same order, and products with 0, 1 and 2.
CAROM_INLINE Real angle(const Real& x, const Real& y) {
  using namespace base::detail;
  const Real far = abs(x);
  const Mask back = x < 0.0;
  const Real one(1.0);
  Real steps(0.0);
  for (const double step : angle_steps) where(far * step < y, steps) = steps + one;
  const Real bx = look_up<Reach::eight>(back_x, steps), by = look_up<Reach::eight>(back_y, steps);
  const Real quotient = (y * bx - far * by) / (far * bx + y * by),
             q = choose(back, -quotient, quotient);
  where(back, steps) = steps + Real(1.0 * angle_from_pi);
  const Real z = q * q, square = z * z, fourth = square * square;
  return angle_beyond(look_up<Reach::few>(angle_high, steps), look_up<Reach::few>(angle_low, steps),
                      q, z, powers(angle_even, square, fourth), powers(angle_odd, square, fourth));
}

/// Where the flight meets it: kappa, or without field the duration.
struct Where {
  Real kappa;
  Mask decided;
};

/// Kappa at the piece that was chosen.
template <Kind kind>
CAROM_INLINE Where meet_by_circle(const View& f, const Met& met) {
  if constexpr (kind.alone) {
    const EllipseInField ellipse = ellipse_in_field(f.table, 0);
    const RootOnEllipse root =
        root_from_ellipse(f, quartic_of_ellipse(f, ellipse, Mask(true)), ellipse.stretch);
    return {root.kappa, root.certain};
  }
  geometry::Quadratic<Real> quadratic;
  Real length(1.0);
  if constexpr (kind.segments)
    quadratic = quadratic_of_segment(f, met.point, {-met.second, met.first}, met.on_wall);
  if constexpr (kind.circles) {
    const auto other = quadratic_of_circle(f, met.point, met.second, met.orientation, met.on_wall);
    if constexpr (kind.segments) {
      quadratic = {choose(met.bent, other.a, quadratic.a), choose(met.bent, other.b, quadratic.b),
                   choose(met.bent, other.c, quadratic.c)};
      where(met.bent, length) = Real(f.table.size);
    } else {
      quadratic = other;
      length = Real(f.table.size);
    }
  }
  const Fraction r = rising_root(f, quadratic, met.on_wall, length);
  return {r.p / r.q, r.decided};
}

}  // namespace
}  // namespace carom::lanes
