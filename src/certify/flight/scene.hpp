// All walls in one arithmetic, and which of them a flight meets first.
#pragma once

#include <optional>
#include <vector>

#include "carom/geometry/lattice.hpp"
#include "certify/flight/larmor_wall.hpp"
#include "certify/wall/ball_table.hpp"
#include "certify/wall/hole.hpp"

namespace carom::certify {

/// A wall of the cell that is displaced by lattice vectors.
struct Copy {
  int wall = -1;
  geometry::Cell cell;
  friend bool operator==(const Copy&, const Copy&) = default;
};

/// What comes next.
struct Choice {
  enum Answer : unsigned char {
    wall,       ///< `first`
    nothing,    ///< no wall follows, ever
    undecided,  ///< `first` and `second` could not be ordered, or whether `first` is met
    too_far,    ///< no wall within the longest flight that is followed; `first` may have been met
    last_time   ///< comes before all walls
  } answer = nothing;  // undecided without a `first`: the enclosure is too wide to look for walls
  Copy first, second;
};

/// Where walls are, in doubles: a disc around each that contains it, whichever numbers of its balls
/// the true ones are.
struct Whereabouts {
  struct Disc {
    geometry::Vector centre;
    double radius = 0.0;
  };
  std::vector<Disc> discs;
  geometry::Vector first, second;        ///< lattice vectors
  geometry::Vector to_first, to_second;  ///< coordinates of a point by them
  double stretch = 0.0;  ///< length of pieces in which flights are followed on a lattice
  double size = 0.0;     ///< of the coordinates of all these
  double widest = 0.0;   ///< radius of a circle or ellipse, or half a segment
  double skew = 0.0;     ///< of the lattice vectors: 2 where they are at right angles

  /// 32 u, u = 2^-53: the share of `skew` and of all lengths that the roundings of the search stay
  /// below (1). Infinite where lattice, walls or field are not known well enough for that; then no
  /// wall is looked for.
  double rounding = 0x1p-48;
  /// How far the roundings of coordinates may carry the middle of piece k, and what is seen from
  /// it, off.
  double rounded_off(double from, double k) const {
    return rounding * skew * (from + size + (k + 2.0) * stretch);
  }
};
/// `omega`: of flights.
Whereabouts whereabouts_of(const BallTable&, const Ball& omega = Ball(0));
// (1) u = 2^-53. Of a piece with middle q, and a disc, let d be q seen from the disc's centre, R
// the reach, and L = from + size + (k + 2) stretch: |d| + R <= L, since |q| <= from + (k + 1/2)
// stretch, |centre| + radius + stretch <= size and off <= stretch. Let a, b be the lattice vectors
// and A, B their duals. The skew is s = |A||a| + |B||b| = 2 |a||b|/area >= 2. Vectors are known to
// u/8 of themselves, and rounded: 1.13 u.
// - q. On a Larmor circle the angle errs by 6 u of itself, sine and cosine by 2 u each, and
// products,
//   quotients and sums, in both components, by 10 u: less than 21 u L, which is 10.5 u s L. What
//   the width of omega adds is pi/8 u L. On a line it is 7 u L. The sum that is `off` errs by 6 u
//   stretch. Together: less than 14 u s L.
// - The range of m (and of n). The area errs by 3.3 u |a||b| + u of itself, so A by (1.7 s + 3.2)
// u,
//   A . d by (1.7 s + 6.2) u |A||d|, and c_reach by (1.7 s + 6.2) u |A| R, both at most
//   4.8 s u |A| L together. The ends of the range and R itself are rounded: 1.5 s u |A| L. So a
//   disc seems displaced by less than 7 u s L.
// - The distance. |m||a| + |n||b| <= s L, so the copy's place errs by 2.2 u s L, the differences by
//   2 u s L, d by u s L/2, and the squares by 1.8 u s L: less than 7 u s L.
// A copy is found if q and the larger one of the other two are allowed for: 21 u s L.

/// Calls try_copy(copy) for every copy of a wall that comes near a piece of a flight with that
/// middle; `off`: how far the piece may be from there.
void near_piece(const Whereabouts& w, geometry::Vector q, double off, auto try_copy) {
  for (std::size_t i = 0; i < w.discs.size(); ++i) {
    const geometry::Vector d = q - w.discs[i].centre;
    const double reach = 0.5 * w.stretch + w.discs[i].radius + off;
    const double c = dot(w.to_first, d), s = dot(w.to_second, d);
    const double c_reach = reach * std::sqrt(dot(w.to_first, w.to_first));
    const double s_reach = reach * std::sqrt(dot(w.to_second, w.to_second));
    for (double m = std::ceil(c - c_reach); m <= c + c_reach; ++m) {
      for (double n = std::ceil(s - s_reach); n <= s + s_reach; ++n) {
        const geometry::Vector there = d - m * w.first - n * w.second;
        if (dot(there, there) > reach * reach) continue;
        try_copy(Copy{static_cast<int>(i),
                      {static_cast<std::int64_t>(m), static_cast<std::int64_t>(n)}});
      }
    }
  }
}

/// At most how far an enclosure reaches from a point of doubles. Numbers that are taken at their
/// word are that point, except for rounding.
inline double off_by(const VectorOf<Interval>& v, geometry::Vector v0) {
  return (v.x - Interval(v0.x)).size() + (v.y - Interval(v0.y)).size();
}
inline double off_by(const BallVector& v, geometry::Vector v0) {
  return off_by(VectorOf<Interval>{interval_of(v.x), interval_of(v.y)}, v0);
}
template <class N>
double off_by(const VectorOf<N>&, geometry::Vector) {
  return 0.0;
}

template <class N>
class SceneOf {
 public:
  static constexpr double most_pieces = 1e5;

  std::vector<WallOf<N>> walls;
  std::optional<LatticeOf<N>> lattice;
  std::vector<HoleOf<N>> holes;
  std::vector<Copy> passed_by;  ///< touched by the present flight, which is no hit
  MotionOf<N> motion;

  /// Does a point of the wall lie in a hole?
  Passage hole_at(int wall, const VectorOf<N>& P) const {
    return passage(holes, wall, walls[static_cast<std::size_t>(wall)], P);
  }

  VectorOf<N> translation(const geometry::Cell& c) const { return lattice->at(c); }

  /// The first wall ahead of P, which lies on the wall `standing` of cell 0 (-1: on none). `P0` and
  /// `v0`: the same in doubles, nearly. `last`: the flight's last time (in a field: -kappa there),
  /// if it is asked whether that comes before all walls.
  Choice next(const Whereabouts& where, const VectorOf<N>& P, const VectorOf<N>& v, int standing,
              geometry::Vector P0, geometry::Vector v0, const N* last = nullptr) const {
    First<N, Copy> first(passed_by, last);
    if (!lattice) {
      for (std::size_t i = 0; i < walls.size(); ++i) {
        const int wall = static_cast<int>(i);
        first.offer(meeting_with(walls[i], P, v, motion, wall == standing), {wall, {}});
      }
      return answer(first);
    }
    if (walls.empty()) return {};
    const double speed = std::sqrt(dot(v0, v0)), from = std::sqrt(dot(P0, P0));
    // The flight starts near P0 and may turn aside from v0; also on Larmor circles, where a time
    // only rotates the latter.
    const double off_start = off_by(P, P0), turned = off_by(v, v0) / speed;
    const auto off = [&](double k) {
      return off_start + (k + 1.0) * where.stretch * turned + where.rounded_off(from, k);
    };
    const auto try_copy = [&](const Copy& copy) {
      if (first.knows(copy)) return;
      const bool here = copy.cell == geometry::Cell{};
      const VectorOf<N> seen = here ? P : P - translation(copy.cell);
      first.offer(meeting_with(walls[static_cast<std::size_t>(copy.wall)], seen, v, motion,
                               here && copy.wall == standing),
                  copy);
    };
    const Choice unknown{Choice::undecided, {}, {}};  // too wide an enclosure
    // Everything up to the end of a piece has been looked at.
    const auto seen_to = [&](double end) {
      return first.found() && sign(first.time() - N(end)) == Sign::negative;
    };
    const auto seen_to_last = [&](double end) {
      return last != nullptr && sign(*last - N(end)) == Sign::negative;
    };
    if (motion.turns) {
      const LarmorPieces pieces(P0, v0, middle_of(motion.half_omega), where.stretch);
      for (double k = 0.0; k < most_pieces; ++k) {
        if (!(off(k) <= where.stretch)) return unknown;
        near_piece(where, pieces.middle(k), off(k), try_copy);
        const std::optional<double> end = pieces.seen_to(k);
        if (pieces.last(k) || (end && seen_to(*end))) return answer(first);
        if (end && seen_to_last(*end)) return answer(first, true);
      }
    } else {
      const geometry::Vector step = (where.stretch / speed) * v0;
      for (double k = 0.0; k < most_pieces; ++k) {
        if (!(off(k) <= where.stretch)) return unknown;
        near_piece(where, P0 + (k + 0.5) * step, off(k), try_copy);
        const double end = (k + 1.0) * where.stretch / speed * (1.0 - where.rounding);
        if (seen_to(end)) return answer(first);
        if (seen_to_last(end)) return answer(first, true);
      }
    }
    Choice none;
    none.answer = Choice::too_far;
    if (const Copy* rival = first.rival()) none.first = *rival;
    return none;
  }

 private:
  /// `later`: the search stopped at the last time. A wall that was found may lie beyond it, and
  /// need not be the first there: the caller checks the time.
  static Choice answer(const First<N, Copy>& first, bool later = false) {
    Choice choice;
    const Copy* rival = first.rival();
    if (first.found()) choice.first = first.key();
    if (rival != nullptr) {
      choice.answer = Choice::undecided;
      (first.found() ? choice.second : choice.first) = *rival;
    } else if (first.found()) {
      choice.answer = Choice::wall;
    } else if (later || first.later()) {
      choice.answer = Choice::last_time;
    }
    return choice;
  }
};

/// The same scene in another arithmetic.
template <class To, class From, class Convert>
SceneOf<To> converted(const SceneOf<From>& scene, const Convert& convert) {
  SceneOf<To> r;
  for (const WallOf<From>& w : scene.walls) r.walls.push_back(converted<To>(w, convert));
  if (scene.lattice) {
    const auto vector = [&](const VectorOf<From>& v) {
      return VectorOf<To>{convert(v.x), convert(v.y)};
    };
    r.lattice = LatticeOf<To>{vector(scene.lattice->first), vector(scene.lattice->second)};
  }
  for (const HoleOf<From>& h : scene.holes) r.holes.push_back(converted<To>(h, convert));
  const MotionOf<From>& m = scene.motion;
  r.motion = {convert(m.speed2), convert(m.inverse_speed2), m.turns, convert(m.half_omega),
              m.time_bits};
  return r;
}

}  // namespace carom::certify
