// Holes as they were written: intervals of arc length, in any arithmetic.
#pragma once

#include <vector>

#include "carom/certify/exact_system.hpp"
#include "certify/flight/next_wall.hpp"

namespace carom::certify {

/// A hole where no root and no angle is needed to ask for it: on a segment two values of (P - from)
/// . chord, on a circle or ellipse two directions from the centre, in the frame where an ellipse is
/// a circle.
template <class Number>
struct HoleOf {
  int hole = -1;  ///< in Table::holes
  int wall = -1;
  bool whole = false;          ///< all of the wall
  Verdict wide = Verdict::no;  ///< more than half a turn?
  Number low{}, high{};
  VectorOf<Number> first, last;
};

template <class To, class From, class Convert>
HoleOf<To> converted(const HoleOf<From>& h, const Convert& convert) {
  const auto vector = [&](const VectorOf<From>& v) {
    return VectorOf<To>{convert(v.x), convert(v.y)};
  };
  return {h.hole,         h.wall,          h.whole,         h.wide,
          convert(h.low), convert(h.high), vector(h.first), vector(h.last)};
}

inline Verdict both(Verdict a, Verdict b) {
  if (a == Verdict::no || b == Verdict::no) return Verdict::no;
  return a == Verdict::undecided || b == Verdict::undecided ? Verdict::undecided : Verdict::yes;
}
inline Verdict opposite(Verdict v) {
  return v == Verdict::yes ? Verdict::no : v == Verdict::no ? Verdict::yes : v;
}
inline Verdict at_least_zero(Sign s) {
  return s == Sign::undecided  ? Verdict::undecided
         : s == Sign::negative ? Verdict::no
                               : Verdict::yes;
}
inline Verdict above_zero(Sign s) {
  return s == Sign::undecided  ? Verdict::undecided
         : s == Sign::positive ? Verdict::yes
                               : Verdict::no;
}

/// Does the point P of the wall lie in the hole (its start included, its end not)?
template <class N>
Verdict in_hole(const HoleOf<N>& hole, const WallOf<N>& w, const VectorOf<N>& P) {
  if (hole.whole) return Verdict::yes;
  if (w.form == Form::segment) {
    const N s = dot(P - w.from, w.chord);
    return both(at_least_zero(sign(s - hole.low)), above_zero(sign(hole.high - s)));
  }
  const VectorOf<N> e = in_round_frame(w, P - w.centre);
  // From `from` on and before `to`, which is less than half a turn later.
  const auto within = [&](const VectorOf<N>& from, const VectorOf<N>& to) {
    const N behind = cross(from, e), before = cross(e, to);
    return both(at_least_zero(sign(w.turn > 0 ? behind : -behind)),
                above_zero(sign(w.turn > 0 ? before : -before)));
  };
  if (hole.wide == Verdict::no) return within(hole.first, hole.last);
  const Verdict wide = opposite(within(hole.last, hole.first));
  if (hole.wide == Verdict::yes) return wide;
  return within(hole.first, hole.last) == wide ? wide : Verdict::undecided;
}

/// By how much a circle or ellipse turns, in the frame where it is a circle, and the length of a
/// wall; to the present precision.
Ball angle_of(const WallOf<Ball>&);
Ball arc_length(const WallOf<Ball>&);

/// Signs of numbers as written, undecided where neither balls of 2^14 bits nor rational numbers
/// tell: of the arc length at which a hole starts, and of that at which it ends less the length of
/// its wall.
Sign before_start(const HoleSpec&);
Sign past_end(const ExactSystem&, const HoleSpec&);

/// To the present precision.
std::vector<HoleOf<Ball>> ball_holes(const ExactSystem&, const std::vector<WallOf<Ball>>& walls);

/// The hole of a wall that a point of it lies in.
struct Passage {
  Verdict verdict = Verdict::no;
  int hole = -1;  ///< in Table::holes: the one that is passed, or is undecided
};
template <class N>
Passage passage(const std::vector<HoleOf<N>>& holes, int wall, const WallOf<N>& w,
                const VectorOf<N>& P) {
  Passage unknown;
  for (const HoleOf<N>& hole : holes) {
    if (hole.wall != wall) continue;
    const Verdict verdict = in_hole(hole, w, P);
    if (verdict == Verdict::yes) return {verdict, hole.hole};
    if (verdict == Verdict::undecided) unknown = {verdict, hole.hole};
  }
  return unknown;
}

}  // namespace carom::certify
