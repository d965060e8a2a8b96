// The flight to a wall with its tangent map, in the coordinates of ErrorSet.
#pragma once

#include "certify/enclosure/error_set.hpp"
#include "certify/flight/larmor_flight.hpp"

namespace carom::certify {

/// A unit vector along the wall at a point on it.
template <class N>
VectorOf<N> tangent_of(const WallOf<N>& w, const VectorOf<N>& P) {
  using std::sqrt;
  const VectorOf<N> normal = w.form == Form::segment ? w.normal : normal_at<N, N>(w, P);
  const N length = sqrt(square(normal.x) + square(normal.y));
  return {-(normal.y / length), normal.x / length};
}

/// Where a state's errors are measured: along `tangent` and left of it in units of `unit`; the
/// velocity across and along itself.
template <class N>
struct FrameOf {
  VectorOf<N> tangent, velocity;
  double unit = 1.0;
};

template <class N>
struct TangentMap {
  std::array<std::array<N, 4>, 4> rows;
  std::array<N, 4> times;
};

/// Derivative of the flight from all states in the enclosures P, v, between two frames.
template <class N>
TangentMap<N> tangent_map(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                          const MotionOf<N>& motion, bool standing, const FrameOf<N>& before,
                          const FrameOf<N>& after) {
  using D = Dual<N>;
  const N unit(before.unit);
  const VectorOf<N> t{unit * before.tangent.x, unit * before.tangent.y}, n = left(t);
  const VectorOf<N> ahead = before.velocity, across = left(ahead);
  const N zero{};
  // In the order of Direction: along, turning, off, speed.
  const VectorOf<D> position{D{P.x, {t.x, zero, n.x, zero}}, D{P.y, {t.y, zero, n.y, zero}}};
  const VectorOf<D> velocity{D{v.x, {zero, across.x, zero, ahead.x}},
                             D{v.y, {zero, across.y, zero, ahead.y}}};
  const LandingOf<D> landing = flight_to<D, N>(w, position, velocity, motion, standing);
  const VectorOf<N> t2 = after.tangent, n2 = left(t2), across2 = left(after.velocity);
  const N unit2(after.unit), speed2 = square(after.velocity.x) + square(after.velocity.y);
  TangentMap<N> map;
  for (std::size_t j = 0; j < 4; ++j) {
    const VectorOf<N> dP{landing.position.x.slope[j], landing.position.y.slope[j]};
    const VectorOf<N> dv{landing.velocity.x.slope[j], landing.velocity.y.slope[j]};
    map.rows[along][j] = dot(dP, t2) / unit2;
    map.rows[off][j] = dot(dP, n2) / unit2;
    map.rows[turning][j] = dot(dv, across2) / speed2;
    map.rows[speed][j] = dot(dv, after.velocity) / speed2;
    map.times[j] = landing.time.slope[j];
  }
  return map;
}

/// Intervals of doubles do not know which exit of an ellipse lies on an arc that ends beside it;
/// balls may.
inline bool is_known(const TangentMap<Interval>& map) {
  for (const auto& row : map.rows)
    for (const Interval& x : row)
      if (!std::isfinite(x.size())) return false;
  return true;
}
TangentMap<Interval> tangent_map_in_balls(const WallOf<Ball>& w, const VectorOf<Ball>& P,
                                          const VectorOf<Ball>& v, const MotionOf<Ball>& motion,
                                          bool standing, const FrameOf<Interval>& before,
                                          const FrameOf<Interval>& after);

}  // namespace carom::certify
