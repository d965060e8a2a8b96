#include "certify/enclosure/point_enclosure.hpp"

#include <algorithm>

namespace carom::certify {
namespace {

constexpr double point_guard_bits = 40.0;  ///< what rounding may stay below the error that is there

Interval point(const Ball& x) { return interval_of(x.midpoint()); }
VectorOf<Interval> point(const BallVector& v) { return {point(v.x), point(v.y)}; }

}  // namespace

double least_radius(const WallOf<Interval>& w) {
  if (w.form == Form::circle) return sqrt(w.radius2).low;
  // The rows have the lengths 1/a and 1/b, and the least radius is b^2/a for a >= b.
  const Interval u = square(w.along.x) + square(w.along.y),
                 v = square(w.across.x) + square(w.across.y);
  const Interval least =
      sqrt(Interval(std::min(u.low, v.low))) / Interval(std::max(u.high, v.high));
  return least.low;
}

PointEnclosure::PointEnclosure(const Arena& arena, const BallState& start) : arena_(&arena) {
  const Bound of_position = radius(start.position) * inverse_of(arena.unit);
  state_.position = middle(start.position);
  state_.velocity = middle(start.velocity);
  frame_ = {{Interval(1.0), Interval(0.0)}, point(state_.velocity), arena.unit};
  const Bound of_velocity = radius(start.velocity) * inverse_of(length(frame_.velocity));
  errors_.round(of_position + of_velocity, Bound());
}

void PointEnclosure::fly(const Copy& copy, bool same, long bits) {
  const SceneOf<Ball>& scene = arena_->scene;
  const WallOf<Ball>& wall = arena_->wall(copy.wall);
  const WallOf<Interval>& fast_wall = arena_->fast_wall(copy.wall);
  const double unit = arena_->unit;
  const Bound per_unit = inverse_of(unit), per_time = inverse_of(arena_->time_unit);
  if (!(copy.cell == geometry::Cell{})) {
    const BallVector seen = state_.position - scene.translation(copy.cell);
    errors_.round(radius(seen) * per_unit, Bound());
    state_.position = middle(seen);
  }
  LandingOf<Ball> landing =
      flight_to<Ball, Ball>(wall, state_.position, state_.velocity, scene.motion, same);
  // The tangent map over all states that the true one may be.
  const VectorOf<Interval> P = position(), v = velocity();
  const bool settles = settles_now(bits);
  const Bound settled = settles ? settle(landing, wall, same) : Bound();
  const BallVector there = middle(landing.position), onwards = middle(landing.velocity);
  const FrameOf<Interval> after{tangent_of(fast_wall, point(there)), point(onwards), unit};
  const Bound per_speed = inverse_of(length(after.velocity));
  TangentMap<Interval> map = tangent_map(fast_wall, P, v, arena_->fast.motion, same, frame_, after);
  if (!is_known(map)) {
    const BallState s = state(bits);
    map = tangent_map_in_balls(wall, s.position, s.velocity, scene.motion, same, frame_, after);
  }
  for (Interval& t : map.times) t = t / Interval(arena_->time_unit);
  errors_.move(map.rows, map.times);
  const Ball time = state_.time + landing.time;
  const Bound rounding =
      settled + radius(landing.position) * per_unit + radius(landing.velocity) * per_speed;
  errors_.round(rounding, time.radius() * per_time);
  state_ = {there, onwards, time.midpoint()};
  frame_ = after;
  // After settling the state has its speed to first order; a turn by b takes b^2/2 of the component
  // along the midpoint's velocity.
  const Bound turned = errors_.size(turning);
  if (settles) errors_.constrain(speed, rounding + turned * turned);
  if (same && wall.form == Form::segment) {
    // It is on the wall, so as far off as the midpoint is from the wall.
    errors_.constrain(off, size_of(dot(there - wall.from, wall.normal)) * per_unit *
                               inverse_of(length(fast_wall.normal)));
  }
  if (settles && same && wall.form != Form::segment) {
    // It is on the curve, too: a point near it, a along its tangent, is at most a^2/r off it
    // (for a < r/2), where r is the least radius of curvature.
    const Interval least = Interval(least_radius(fast_wall)) / Interval(unit);
    const double radius_below = least.low;
    const Bound moved = errors_.size(along);
    if (moved.to_double() < 0.5 * radius_below &&
        errors_.size(off).to_double() < 0.5 * radius_below)
      errors_.constrain(off, rounding + moved * moved * inverse_of(radius_below));
  }
  ++hits_;
}

// With many bits a few of them are cheaper than the squares: then every fourth hit suffices.
bool PointEnclosure::settles_now(long bits) const {
  return arena_->scene.motion.turns || bits < 2000 || hits_ % 4 == 3;
}

// The true state lies on the wall and has the true speed: the computed one is put back there to
// first order in what it has left them by, and what is changed counts as rounding. Without this the
// errors off the wall and of the speed would feed each other, for their motion is unstable.
Bound PointEnclosure::settle(LandingOf<Ball>& landing, const WallOf<Ball>& w, bool same) const {
  const MotionOf<Ball>& motion = arena_->scene.motion;
  BallVector& v = landing.velocity;
  const Ball slow = (motion.speed2 - (square(v.x) + square(v.y))) * motion.inverse_speed2;
  const Ball half(0.5);
  const Ball stretch = half * first_bits(slow);
  v = {v.x + stretch * v.x, v.y + stretch * v.y};
  const Bound changed = size_of(slow);
  if (!same || w.form == Form::segment) return changed;
  BallVector& P = landing.position;
  const BallVector e = P - w.centre;
  if (w.form == Form::ellipse) {
    // Down the gradient of X^2 + Y^2 - 1, which is twice the normal.
    const Ball X = dot(e, w.along), Y = dot(e, w.across);
    const BallVector normal = X * w.along + Y * w.across;
    const Ball length2 = square(normal.x) + square(normal.y);
    const Ball low = (Ball(1) - (square(X) + square(Y))) / length2;
    const Ball lift = half * first_bits(low);
    P = {P.x + lift * normal.x, P.y + lift * normal.y};
    return changed + size_of(low) * size_of(sqrt(length2)) * inverse_of(arena_->unit);
  }
  const Ball low = (w.radius2 - (square(e.x) + square(e.y))) * w.double_inverse;
  const Ball lift = half * half * first_bits(low);  // (r^2 - e^2)/(2 r^2)
  P = {P.x + lift * e.x, P.y + lift * e.y};
  return changed + size_of(low) * size_of(sqrt(w.radius2)) * inverse_of(arena_->unit);
}

BallState PointEnclosure::state(long) const {
  const Bound dP = position_error(), dv = velocity_error();
  return {{state_.position.x.widened(dP), state_.position.y.widened(dP)},
          {state_.velocity.x.widened(dv), state_.velocity.y.widened(dv)},
          time()};
}

// In a field the time has a precision of its own.
Bound PointEnclosure::error() const {
  const Bound error = errors_.of_position() + errors_.of_velocity();
  return arena_->scene.motion.turns ? error : error + errors_.of_time();
}

double PointEnclosure::useful_bits() const {
  const geometry::Vector P = near(state_.position);
  const double size = std::max({1.0, std::fabs(P.x) / arena_->unit, std::fabs(P.y) / arena_->unit,
                                std::fabs(state_.time.to_double()) / arena_->time_unit});
  return -error().log2() + point_guard_bits + std::log2(size);
}

}  // namespace carom::certify
