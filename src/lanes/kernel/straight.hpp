// Straight flights in lanes: which piece comes first, by signs with margins, and the hit there.
//
// Every number that shows in an orbit comes from the operations of the scalar engine in their
// order; only the choice of the piece is made otherwise, and a choice is either certain or left
// to that engine. docs/developer/lanes.md derives the margins.
#pragma once

#include "lanes/kernel/met.hpp"

namespace carom::lanes {
namespace {

/// The line of each flight: on which side of it a point lies.
struct Line {
  const View& f;
  Real x, minus_y, offset;  ///< of the velocity, and -(v x origin)
  CAROM_INLINE explicit Line(const View& view)
      : f(view),
        x(f.velocity.x),
        minus_y(-f.velocity.y),
        offset(-geometry::fused_cross(f.velocity, f.origin)) {}
  /// v x (point - origin).
  CAROM_INLINE Real side(double px, double py) const {
    return fused(x, Real(py), fused(minus_y, Real(px), offset));
  }
  /// v . (point - origin).
  CAROM_INLINE Real ahead(double px, double py) const {
    return fused(x, Real(px),
                 fused(f.velocity.y, Real(py), -geometry::fused_dot(f.velocity, f.origin)));
  }
  /// (A - origin) x (B - origin), the ends of a piece with joints.
  CAROM_INLINE Real cross_of_ends(const LaneTable& t, int i) const {
    return fused(f.origin.y, Real(t.along_x[i]),
                 fused(f.origin.x, Real(t.back_y[i]), Real(t.turn[i])));
  }
};

constexpr double half_bits[LaneTable::most_signs] = {0.5,  1.0,  2.0,  4.0,   8.0,
                                                     16.0, 32.0, 64.0, 128.0, 256.0};

/// The pieces at these entries. One by one, through memory: the units for it have nothing else to
/// do.
CAROM_INLINE void look_up_exits(const LaneTable& t, double* pieces, int used) {
  for (int i = 0; i < used || i % width != 0; ++i) {  // whole registers
    unsigned short entry;
    __builtin_memcpy(&entry, pieces + i, sizeof entry);
    pieces[i] = counted[t.exit[entry]];
  }
}

/// The exit of a flight from a wall, where the sides of the joints tell. Of a convex loop: along
/// the walls, to the left of which the table lies, come first the joints on the right of the
/// flight, then its exit. So that lies as many pieces on as there are joints on the right; with
/// none or all of them, on the piece itself, which is an arc then. Else an entry of a table; its
/// answer may be that it is not known yet.
template <Kind kind>
CAROM_INLINE Mask exit_by_joints(const View& f, double* pieces) {
  const LaneTable& t = f.table;
  if constexpr (kind.single) return Mask(true);
  const Line line(f);
  // Of each joint a half, less on the left, more on the right.
  Real sum = fused(f.start_piece, Real(t.start_step), Real(t.from_start)),
       least(__builtin_huge_val());
  const auto ask = [&](int i, const Real& half) {
    const Real side = line.side(t.joint_x[i], t.joint_y[i]);
    least = least_size(least, side);
    sum = sum - signed_like(half, side);
  };
  if (t.by_signs) {
    for (int i = 0; i < t.pieces; ++i) ask(i, Real(half_bits[i]));
    store(sum + 0x1p52, pieces);  // the lowest bits are the entry
  } else {
    for (int i = 0; i < t.pieces; ++i) ask(i, Real(0.5));
    const Real all(t.pieces);
    where(sum >= all, sum) = sum - all;
    store(sum, pieces);
  }
  return least > f.sides;
}

/// Any table: the earliest of all exits, and whether it comes certainly first and later than now.
class Earliest {
 public:
  CAROM_INLINE explicit Earliest(const View& f)
      : decided_(true), piece_(-1.0), best_(never), second_(never), margin_(f.order) {}

  CAROM_INLINE void add(int piece, const Mask& leaves, const Real& when) {
    const Real at = choose(leaves && when > -margin_, when, Real(never));
    second_ = min(second_, max(best_, at));
    where(at < best_, piece_) = Real(counted[piece]);
    best_ = min(best_, at);
  }
  CAROM_INLINE void doubt(const Mask& where_not) { decided_ = decided_ && !where_not; }
  CAROM_INLINE Choice choice() const {  // below 0: none
    return {piece_, decided_ && !(best_ <= margin_) && !(second_ - best_ <= margin_), Real(0.0)};
  }

 private:
  static constexpr double never = __builtin_huge_val();
  Mask decided_;
  Real piece_, best_, second_;
  Real margin_;  // of two times
};

CAROM_INLINE Cut cut_of_circle(const View& f, const Line& line, const Real& inverse, int i) {
  const LaneTable& t = f.table;
  const Real aside = line.side(t.point_x[i], t.point_y[i]);
  return {-line.ahead(t.point_x[i], t.point_y[i]), f.square_speed,
          fused(aside, -aside, t.second_number[i] * f.square_speed), inverse};
}

/// A closed conic, or an arc of one between joints on these sides of the line (below 0: on its
/// right). A particle leaves by the later cut if the domain is inside, else by the earlier one.
template <bool inside>
CAROM_INLINE void add_cut(Earliest& best, const View& f, int i, const Mask& leaves,
                          const Cut& cut) {
  best.doubt(leaves && abs(cut.discriminant) <= f.roots);
  const Real root = sqrt(max(cut.discriminant, Real(0.0)));
  best.add(i, leaves && cut.discriminant > f.roots,
           ((inside ? root : -root) - cut.along) * cut.inverse);
}
template <bool inside>
CAROM_INLINE void add_closed(Earliest& best, const View& f, int i, const Cut& cut) {
  add_cut<inside>(best, f, i, inside ? Mask(true) : f.start_wall != Real(f.table.wall[i]), cut);
}
template <bool inside>
CAROM_INLINE void add_arc(Earliest& best, const View& f, int i, const Real& cross_of_ends,
                          const Real& a, const Real& b, const Cut& cut) {
  // With both joints on one side: if the foot of the centre lies beyond the chord, on the arc's
  // side; or from the arc.
  const Real foot = fused(cut.square, cross_of_ends, cut.along * (b - a));
  const Mask crosses = a < 0.0 && b >= 0.0, away = f.start_wall != Real(f.table.wall[i]);
  const Mask same = (a < 0.0) == (b < 0.0), open = same && away;
  best.doubt(open && abs(foot) <= f.roots && cut.discriminant > -f.roots);
  if constexpr (inside) {
    const Mask own = f.start_piece == Real(counted[i]);
    add_cut<inside>(best, f, i, crosses || (same && own) || (open && foot < 0.0), cut);
  } else {
    add_cut<inside>(best, f, i, (crosses && away) || (open && foot > 0.0), cut);
  }
}

template <bool ellipses = false>
CAROM_INLINE Choice first_of_all(const View& f) {
  const LaneTable& t = f.table;
  Earliest best(f);
  const Line line(f);
  const Real inverse = 1.0 / f.square_speed;
  const auto cut_of = [&](int i) {
    return ellipses && t.ellipses.of[i] ? cut_of_ellipse(f, i) : cut_of_circle(f, line, inverse, i);
  };
  Real least(__builtin_huge_val());
  for (int loop = 0; loop < t.loops; ++loop) {
    const int first = t.first[loop], last = first + t.count[loop] - 1;
    if (t.closed[first]) {
      if (t.orientation[first] > 0.0)
        add_closed<true>(best, f, first, cut_of(first));
      else
        add_closed<false>(best, f, first, cut_of(first));
      continue;
    }
    const auto joint = [&](int i) {
      const Real side = line.side(t.joint_x[i], t.joint_y[i]);
      least = least_size(least, side);
      return side;
    };
    const Real start = joint(first);
    Real a = start;
    for (int i = first; i <= last; ++i) {
      const Real b = i == last ? start : joint(i + 1);
      const Real cross_of_ends = line.cross_of_ends(t, i);
      if (!t.bent[i])
        best.add(i, a < 0.0 && b >= 0.0, nearly_quotient(cross_of_ends, b - a));
      else if (t.orientation[i] > 0.0)
        add_arc<true>(best, f, i, cross_of_ends, a, b, cut_of(i));
      else
        add_arc<false>(best, f, i, cross_of_ends, a, b, cut_of(i));
      a = b;
    }
  }
  best.doubt(least <= joint_margin / sign_margin * f.sides);
  return best.choice();
}

/// The normal of a piece out of the domain, or of a conic's what leads from its centre; d leads
/// from the piece's point.
template <Kind kind>
CAROM_INLINE Vector normal_of(const Met& met, const Vector& d) {
  if constexpr (!kind.segments) return d;
  const Vector normal{met.first, met.second};
  if constexpr (!kind.circles && !kind.ellipses) return normal;
  return {choose(met.bent, d.x, normal.x), choose(met.bent, d.y, normal.y)};
}

/// The duration of the flight to the piece that was chosen: a fraction for either kind of wall.
template <Kind kind>
CAROM_INLINE FractionOfTime meet_by_line(const View& f, const Met& met) {
  const Vector e = f.origin - met.point, v = f.velocity;
  Real time, unit;
  Mask decided(true);
  if constexpr (kind.segments || kind.circles) {
    // With the normal m out of the domain, which is e for a circle about it: m.v grows to the wall,
    // and a segment is left like a circle from inside whose root is 0.
    const Vector m = normal_of<kind>(met, e);
    const Real b = geometry::fused_dot(m, v);
    // r^2 - e.e of a circle, -m.e of a segment.
    Real within(0.0);
    if constexpr (kind.circles) where(met.bent, within) = met.second;
    Real gap = geometry::less_dot(within, m, e), n = abs(b);
    Mask away(true);
    if constexpr (kind.circles) {
      const Real discriminant = fused_product(gap, f.square_speed, b * b);
      where(met.on_wall, gap) = Real(0.0);
      // In a convex table the line between two joints cuts the arc.
      Real root = sqrt(kind.convex || kind.next_disc ? discriminant : max(discriminant, Real(0.0)));
      where(met.on_wall, root) = n;
      if constexpr (kind.segments) where(!met.bent, root) = Real(0.0);
      n = n + root;
      away = met.orientation * b >= 0.0;
      // Discs of a lattice that were chosen are cut and lie ahead.
      if constexpr (kind.next_disc) return {-gap, n, Mask(true)};
      if constexpr (!kind.convex) decided = met.on_wall || discriminant > f.roots || !met.bent;
    }
    time = choose(away, met.orientation * gap, n);
    unit = choose(away, n, met.orientation * f.square_speed);
  }
  if constexpr (kind.ellipses) {
    const FractionOfTime to =
        time_to_ellipse<kind>(f, e, met.ellipse, met.orientation, met.on_wall);
    const Mask is = met.ellipse.is;
    if constexpr (kind.segments || kind.circles) {
      time = choose(is, to.time, time);
      unit = choose(is, to.unit, unit);
      decided = (is && to.decided) || (!is && decided);
    } else {
      time = to.time;
      unit = to.unit;
      decided = to.decided;
    }
  }
  return {time, unit, decided};
}

}  // namespace
}  // namespace carom::lanes
