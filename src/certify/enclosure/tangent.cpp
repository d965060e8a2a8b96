#include "certify/enclosure/tangent.hpp"

namespace carom::certify {
namespace {

Ball ball_around(const Interval& x) {
  const Ball low(x.low), high(x.high);
  return x.low == x.high ? low : union_of(low, high);
}
VectorOf<Ball> ball_around(const VectorOf<Interval>& v) {
  return {ball_around(v.x), ball_around(v.y)};
}
FrameOf<Ball> ball_around(const FrameOf<Interval>& f) {
  return {ball_around(f.tangent), ball_around(f.velocity), f.unit};
}

}  // namespace

TangentMap<Interval> tangent_map_in_balls(const WallOf<Ball>& w, const VectorOf<Ball>& P,
                                          const VectorOf<Ball>& v, const MotionOf<Ball>& motion,
                                          bool standing, const FrameOf<Interval>& before,
                                          const FrameOf<Interval>& after) {
  const TangentMap<Ball> map =
      tangent_map(w, P, v, motion, standing, ball_around(before), ball_around(after));
  TangentMap<Interval> result;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) result.rows[i][j] = interval_of(map.rows[i][j]);
    result.times[i] = interval_of(map.times[i]);
  }
  return result;
}

}  // namespace carom::certify
