#include "certify/enclosure/line_enclosure.hpp"

namespace carom::certify {
namespace {

constexpr double line_guard_bits = 32.0;  ///< what rounding may stay below the error that is there

/// (x + iy)(c + is) by three products.
BallVector turned(const BallVector& v, const Ball& c, const Ball& s) {
  const Ball p = c * (v.x + v.y), q = v.x * (s - c), r = v.y * (c + s);
  return {p - r, p + q};
}

}  // namespace

LineEnclosure::LineEnclosure(const Arena& arena, const LineTable& lines, const BallState& start)
    : arena_(&arena),
      lines_(&lines),
      velocity_(middle(start.velocity)),
      anchor_(middle(start.position)) {
  start_error_ = radius(start.position);
  const Bound turned = radius(start.velocity) * Bound(1.001 / arena.speed);
  stretch_ = turned;
  box_.round(start_error_ * Bound(1.001 / arena.unit) + turned);
  const Precision few(lines.few_bits);
  few_ = seen({}, ahead_);
}

// The moment about the anchor of the next wall.
LineEnclosure::Shift LineEnclosure::move_anchor(const Copy& copy, bool same) {
  Shift shift;
  const LineWall& w = lines_->walls[static_cast<std::size_t>(copy.wall)];
  if (same && wall_ >= 0) return shift;
  BallVector a{Ball(0), Ball(0)};
  if (wall_ != copy.wall) a = w.anchor - anchor_;
  if (!(copy.cell == geometry::Cell{})) a = a + arena_->scene.translation(copy.cell);
  const Ball moved = moment_ - cross(velocity_, a);
  shift.rounding = moved.radius();
  moment_ = moved.midpoint();
  const VectorOf<Interval> v = velocity(), way = interval_of(a);
  const Interval unit(moment_unit());
  shift.along = dot(v, way) / unit;
  shift.across = cross(v, way) / unit;
  const Precision few(lines_->few_bits);
  shift.passed = dot(few_.velocity, rounded(a));
  turn_.reset();
  return shift;
}

// With h/(r |v|) = sin a the velocity turns by a half turn and 2a, to the side on which the wall
// is; and 2 h c = (h + c)^2 - (h^2 + c^2) takes a square only.
LineEnclosure::Turn LineEnclosure::turn_at(const LineWall& w) const {
  Turn turn;
  const Ball square_of_moment = square(moment_);
  turn.room = w.size2 - square_of_moment;
  const Ball outwards = sqrt(turn.room);
  turn.cosine = Ball(2) * w.inverse.times(square_of_moment) - Ball(1);
  const Ball sine = w.inverse.times(square(moment_ + outwards)) - Ball(1);
  turn.sine = w.side > 0.0 ? -sine : sine;
  return turn;
}

void LineEnclosure::fly(const Copy& copy, bool same, long bits) {
  const Precision precision(bits);
  const LineWall& w = lines_->walls[static_cast<std::size_t>(copy.wall)];
  const Shift shift = move_anchor(copy, same);
  const Interval lever = shift.along;
  const Bound fresh =
      size_of(shift.across) * stretch_ + shift.rounding * Bound(1.001 / moment_unit());
  BallVector onwards;
  Interval J[2][2] = {{Interval(1.0), lever}, {Interval(0.0), Interval(1.0)}};
  Bound gain;  // of the direction by the moment
  if (w.arc) {
    if (!turn_) turn_ = turn_at(w);
    onwards = turned(velocity_, turn_->cosine, turn_->sine);
    // Over all moments that may be: (h + d)^2 - h^2 = 2 h d + d^2.
    const Bound d =
        Bound(moment_unit()) * (box_.size(moment) + size_of(lever) * box_.size(direction) + fresh);
    const Interval outwards =
        sqrt(interval_of(turn_->room, Bound(2.0) * size_of(moment_) * d + d * d));
    const Interval slope = Interval(2.0 * w.side * moment_unit()) / outwards;
    J[1][0] = slope;
    J[1][1] = Interval(1.0) + slope * lever;
    gain = size_of(slope);
  } else {
    const Ball by_tangent = dot(velocity_, w.tangent);
    onwards = by_tangent * w.double_tangent - velocity_;
    J[0][0] = J[1][1] = Interval(-1.0);
    J[0][1] = -lever;
    moment_ = -moment_;
  }
  Bound turning = radius(onwards) * Bound(1.001 / arena_->speed);
  stretch_ = stretch_ + turning;
  velocity_ = middle(onwards);
  if (++hits_ % 16 == 0) settle(turning);
  box_.move(J, {fresh, gain * fresh + turning});
  anchor_ = w.anchor;
  wall_ = copy.wall;
  read(shift);
}

// The true velocity has the true speed: the computed one is given it to first order. Only the sum
// of its roundings had changed it.
void LineEnclosure::settle(Bound& turned) {
  const MotionOf<Ball>& motion = arena_->scene.motion;
  const Ball slow =
      (motion.speed2 - (square(velocity_.x) + square(velocity_.y))) * motion.inverse_speed2;
  const Bound size = size_of(slow);
  if (Bound(0.01) < size) return;
  const Ball stretch = Ball(0.5) * first_bits(slow);
  const BallVector v{velocity_.x + stretch * velocity_.x, velocity_.y + stretch * velocity_.y};
  const Bound rounding = radius(v) * Bound(1.001 / arena_->speed);
  velocity_ = middle(v);
  turned = turned + rounding;
  // sqrt(1 - s)(1 + s'/2) with s' = s except for its last bits.
  const Bound left = size * size + size * Bound(0x1p-60) + slow.radius() + rounding;
  if (left < stretch_) stretch_ = left;
}

// The state after the reflection in numbers of few bits, and the time of the flight to it.
void LineEnclosure::read(const Shift& shift) {
  const Precision few(lines_->few_bits);
  const LineWall& w = lines_->few_walls[static_cast<std::size_t>(wall_)];
  Ball ahead;
  BallState now = seen(w, ahead);
  // |v|^2 t = v . (P' - P); the component along the normal was the opposite before the reflection.
  const Ball way = (w.arc ? -ahead : ahead) + shift.passed - ahead_;
  now.time = few_.time + way * lines_->few_inverse_speed2;
  few_ = std::move(now);
  ahead_ = std::move(ahead);
  Bound gain;
  if (w.arc) {
    gain = size_of(Interval(w.radius * arena_->speed) / interval_of(ahead_));
  } else {
    const VectorOf<Interval> t = interval_of(w.tangent);
    gain =
        size_of(sqrt(dot(t, t)) * Interval(arena_->speed) / cross(interval_of(few_.velocity), t));
  }
  along_ = gain * box_.size(moment);
}

// To the present precision; `ahead`: v . (P - anchor).
BallState LineEnclosure::seen(const LineWall& w, Ball& ahead) const {
  BallState s;
  const Bound error = Bound(1.0001 * arena_->speed) * (box_.size(direction) + stretch_);
  s.velocity = {velocity_.x.rounded().widened(error), velocity_.y.rounded().widened(error)};
  s.time = few_.time;
  if (wall_ < 0) {
    s.position = {anchor_.x.rounded().widened(start_error_),
                  anchor_.y.rounded().widened(start_error_)};
    ahead = Ball(0).widened(Bound(1.01 * arena_->speed) * start_error_);
    return s;
  }
  const Ball h = moment_.rounded().widened(Bound(1.0001 * moment_unit()) * box_.size(moment));
  const BallVector& v = s.velocity;
  if (w.arc) {
    const Ball outwards = sqrt(w.size2 - square(h));
    ahead = w.side > 0.0 ? -outwards : outwards;
    const Ball per = arena_->scene.motion.inverse_speed2.rounded();
    s.position = {w.anchor.x + (v.x * ahead - v.y * h) * per,
                  w.anchor.y + (v.y * ahead + v.x * h) * per};
  } else {
    const Ball x = h / cross(v, w.tangent);
    s.position = w.anchor + x * w.tangent;
    ahead = x * dot(v, w.tangent);
  }
  return s;
}

BallState LineEnclosure::state(long bits) const {
  if (bits <= lines_->few_bits) return few_;
  const Precision precision(bits);
  Ball ahead;
  return seen(wall_ < 0 ? LineWall{} : lines_->walls[static_cast<std::size_t>(wall_)], ahead);
}

double LineEnclosure::useful_bits() const { return line_guard_bits - line_error().log2(); }

}  // namespace carom::certify
