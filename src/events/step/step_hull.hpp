// What contains a step's path, from positions and velocities at its ends alone, and whether that
// keeps it off a barrier: for one particle, or for those in the lanes of a register.
#pragma once

#include <type_traits>

#include "base/inline.hpp"
#include "events/step/barrier.hpp"

namespace carom::events {

namespace step_hull {

/// Numbers whose comparison is a bool. A comparison of lanes is a mask: no code can branch on it.
template <class Number>
concept Plain = requires(const Number& a) {
  a < a ? a : a;
};

template <class Number>
CAROM_INLINE Number smaller(const Number& a, const Number& b) {
  if constexpr (Plain<Number>) {
    return b < a ? b : a;
  } else {
    Number result = a;
    where(b < a, result) = b;
    return result;
  }
}
template <class Number>
CAROM_INLINE Number larger(const Number& a, const Number& b) {
  if constexpr (Plain<Number>) {
    return a < b ? b : a;
  } else {
    Number result = a;
    where(a < b, result) = b;
    return result;
  }
}
template <class Number>
CAROM_INLINE Number norm(const geometry::BasicVector<Number>& a) {
  return larger(a.x, -a.x) + larger(a.y, -a.y);
}
template <class Truth>
CAROM_INLINE bool everywhere(const Truth& t) {
  if constexpr (std::is_same_v<Truth, bool>)
    return t;
  else
    return all_of(t);
}

}  // namespace step_hull

/// The hull of the control points of the cubic through both ends, widened by their second
/// differences. These are of the order h^2 |a|, the cubic errs by h^4 / 384 times the fourth
/// derivative.
template <class Number>
struct StepHull {
  using Vector = geometry::BasicVector<Number>;
  Vector points[4];
  Number margin;
  Vector low, high;  ///< the box of the points, widened

  StepHull() = default;
  /// `third` of the step's duration.
  CAROM_INLINE StepHull(const Vector& x0, const Vector& v0, const Vector& x1, const Vector& v1,
                        const Number& third)
      : points{x0, x0 + third * v0, x1 - third * v1, x1} {
    using namespace step_hull;
    const Vector first = (points[2] - points[1]) - (points[1] - points[0]);
    const Vector second = (points[3] - points[2]) - (points[2] - points[1]);
    margin = larger(norm(first), norm(second));
    low = high = points[0];
    for (int k = 1; k < 4; ++k) {
      low = {smaller(low.x, points[k].x), smaller(low.y, points[k].y)};
      high = {larger(high.x, points[k].x), larger(high.y, points[k].y)};
    }
    low = low - Vector{margin, margin};
    high = high + Vector{margin, margin};
  }
};

/// Can the path not meet the barrier from its positive side, or from a start on it? Of
/// lanes: a mask.
template <class Number, class Real>
CAROM_INLINE auto stays_off(const Barrier<Real>& b, const StepHull<Number>& hull) {
  using namespace step_hull;
  using Vector = geometry::BasicVector<Number>;
  const auto number = [](const Real& a) { return Number(a); };
  // The piece itself out of reach, wherever the path lies to its curve.
  auto off = hull.high.x < number(b.low.x) || hull.high.y < number(b.low.y) ||
             number(b.high.x) < hull.low.x || number(b.high.y) < hull.low.y;
  if (everywhere(off)) return off;
  const Vector origin{number(b.origin.x), number(b.origin.y)},
      along{number(b.first.x), number(b.first.y)};
  if (!b.conic) {
    Number low = dot(along, hull.points[0] - origin), high = low;
    for (int k = 1; k < 4; ++k) {
      const Number gap = dot(along, hull.points[k] - origin);
      low = smaller(low, gap);
      high = larger(high, gap);
    }
    const Number margin = hull.margin + number(b.slack);
    off = off || low > number(b.highest) + margin || high < number(b.lowest) - margin;
    return off;
  }
  const Vector across{number(b.second.x), number(b.second.y)};
  Vector y[4], sum{Number(0), Number(0)};
  for (int k = 0; k < 4; ++k) {
    const Vector e = hull.points[k] - origin;
    y[k] = {dot(along, e), dot(across, e)};
    sum = sum + y[k];
  }
  const Number one(1), margin = (norm(along) + norm(across)) * hull.margin + number(b.slack);
  // Inside the conic: all points are. Outside: all lie beyond a tangent of it.
  Number farthest = dot(y[0], y[0]), lowest = dot(sum, y[0]);
  for (int k = 1; k < 4; ++k) {
    farthest = larger(farthest, dot(y[k], y[k]));
    lowest = smaller(lowest, dot(sum, y[k]));
  }
  off = off || (margin < one && farthest < (one - margin) * (one - margin));
  off = off ||
        (lowest > Number(0) && lowest * lowest > (one + margin) * (one + margin) * dot(sum, sum));
  return off;
}

}  // namespace carom::events
