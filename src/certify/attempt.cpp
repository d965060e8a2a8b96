#include "certify/attempt.hpp"

#include <algorithm>

#include "carom/base/error.hpp"
#include "certify/exact_value.hpp"
#include "certify/start.hpp"

namespace carom::certify {
namespace {

constexpr double guard_bits = 40.0;  ///< what rounding may stay below the error that is there

Interval point(const Ball& x) { return interval_of(x.midpoint()); }
VectorOf<Interval> point(const BallVector& v) { return {point(v.x), point(v.y)}; }
geometry::Vector near(const BallVector& v) { return {v.x.to_double(), v.y.to_double()}; }
BallVector middle(const BallVector& v) { return {v.x.midpoint(), v.y.midpoint()}; }
Bound radius(const BallVector& v) { return v.x.radius() + v.y.radius(); }

/// The least radius of curvature, nearly.
double least_radius(const WallOf<Ball>& w) {
  if (w.form == Form::circle) return std::sqrt(w.radius2.to_double());
  const geometry::Vector p = near(w.along), q = near(w.across);  // of lengths 1/a and 1/b
  const double u = dot(p, p), v = dot(q, q);
  return std::sqrt(std::min(u, v)) / std::max(u, v);
}

/// Of a correction only these count; short factors make products cheap.
Ball first_bits(const Ball& x) {
  const Precision few(64);
  return x.rounded().midpoint();
}

/// A power of two of at least half that size.
double power_near(double size) { return std::exp2(std::floor(std::log2(size))); }

}  // namespace

Attempt::Attempt(const ExactSystem& system, const CertifiedTask& task, const KnownTies& ties, long bits)
    : system_(system), task_(task), ties_(ties), first_bits_(bits), bits_(bits), table_bits_(bits) {
  const Precision precision(bits);
  BallTable table = ball_table(*system.spec);
  where_ = whereabouts_of(table);
  double size = where_.stretch;
  for (const Whereabouts::Disc& disc : where_.discs) size = std::max(size, disc.radius);
  unit_ = size > 0.0 ? power_near(size) : 1.0;
  scene_.walls = std::move(table.walls);
  scene_.lattice = std::move(table.lattice);
  const Ball written_speed = value_of(system.speed);
  scene_.motion.speed2 = square(written_speed);
  scene_.motion.inverse_speed2 = Ball(1) / scene_.motion.speed2;
  scene_.motion.half_omega = value_of(system.omega) / 2;
  scene_.motion.turns = sign(scene_.motion.half_omega) != Sign::zero;
  speed_ = written_speed.to_double() * 1.000001;
  time_unit_ = unit_ / speed_;
  if (task.t_max) t_max_ = value_of(*task.t_max);
  scene_.holes = ball_holes(system, scene_.walls);
  set_interval_table();
  place_start(system);
}

void Attempt::place_start(const ExactSystem& system) {
  const ExactStart& start = system.start;
  now_.state.position = {value_of(start.position.x), value_of(start.position.y)};
  BallVector direction{value_of(start.direction.x), value_of(start.direction.y)};
  if (start.angle) {
    const CosSin d = direction_of(*start.angle);
    direction = {d.cos, d.sin};
  }
  const Ball length2 = dot(direction, direction), speed2 = scene_.motion.speed2;
  // A direction of the right length already stays exact.
  const bool exact = (length2 - speed2).contains(Ball(0)) && sign(length2 - speed2) == Sign::zero;
  rescaled_ = !(length2 - speed2).contains(Ball(0));
  const Ball scale = exact ? Ball(1) : sqrt(speed2 / length2);
  now_.state.velocity = {scale * direction.x, scale * direction.y};
  now_.standing = start.wall;
  if (now_.standing >= 0)
    now_.state.position = point_with_parameter(scene_.walls[static_cast<std::size_t>(now_.standing)], start.u);
  const Bound of_position = radius(now_.state.position) * Bound(1.0 / unit_ * 1.000001);
  const Bound of_velocity = radius(now_.state.velocity) * Bound(1.0 / speed_ * 1.00001);
  now_.errors.round(of_position + of_velocity, Bound());
  now_.state.position = middle(now_.state.position);
  now_.state.velocity = middle(now_.state.velocity);
  now_.frame = {{Interval(1.0), Interval(0.0)}, point(now_.state.velocity), unit_};
}

void Attempt::set_interval_table() {
  fast_ = converted<Interval>(scene_, [](const Ball& x) { return interval_of(x); });
}

// Bits far below the error that is already there are of no use.
void Attempt::trim_precision() {
  const Bound error = error_of_state();
  const double size = std::max({1.0, std::fabs(now_.state.position.x.to_double()) / unit_,
                                std::fabs(now_.state.position.y.to_double()) / unit_,
                                std::fabs(now_.state.time.to_double()) / time_unit_});
  const double wanted = -error.log2() + guard_bits + std::log2(size);
  bits_ = std::min(first_bits_, static_cast<long>(std::clamp(wanted, 64.0, 1e15)));
  // Only the digits asked for, and somewhat more in each attempt, should the last time be a close call.
  scene_.motion.time_bits = static_cast<long>(3.33 * task_.digits + 64.0 + std::log2(size)) + first_bits_ / 16;
  if (bits_ + 32 < table_bits_ - table_bits_ / 16) {
    const Precision precision(bits_ + 32);
    scene_ = converted<Ball>(scene_, [](const Ball& x) { return x.rounded(); });  // nothing is passed by
    table_bits_ = bits_ + 32;
  }
}

Choice Attempt::choose() const {
  const Bound dP = position_error(), dv = velocity_error();
  const geometry::Vector P0 = near(now_.state.position), v0 = near(now_.state.velocity);
  const VectorOf<Interval> P{interval_of(now_.state.position.x, dP), interval_of(now_.state.position.y, dP)};
  const VectorOf<Interval> v{interval_of(now_.state.velocity.x, dv), interval_of(now_.state.velocity.y, dv)};
  const Choice fast = fast_.next(where_, P, v, now_.standing, P0, v0);
  if (fast.answer != Choice::undecided) return fast;
  const Precision precision(bits_);
  const BallVector position{now_.state.position.x.widened(dP), now_.state.position.y.widened(dP)};
  const BallVector velocity{now_.state.velocity.x.widened(dv), now_.state.velocity.y.widened(dv)};
  return scene_.next(where_, position, velocity, now_.standing, P0, v0);
}

// The joint, unless one of the other walls comes before it.
Choice Attempt::choose_at(const KnownTies::Joint& joint) const {
  const Choice at_joint{Choice::wall, joint.hit, {}};
  if (joint.of.empty()) return at_joint;
  const Choice other = choose();
  if (other.answer == Choice::nothing) return at_joint;
  if (other.answer != Choice::wall) return {Choice::undecided, joint.hit, other.first};
  const Precision precision(bits_);
  const Bound dP = position_error(), dv = velocity_error();
  const BallVector P{now_.state.position.x.widened(dP), now_.state.position.y.widened(dP)};
  const BallVector v{now_.state.velocity.x.widened(dv), now_.state.velocity.y.widened(dv)};
  const auto seen = [&](const Copy& copy) {
    return copy.cell == geometry::Cell{} ? P : P - scene_.translation(copy.cell);
  };
  const Copy& ends = joint.of.front();
  const BallVector to_joint = scene_.walls[static_cast<std::size_t>(ends.wall)].to - seen(ends);
  const bool standing = other.first.wall == now_.standing && other.first.cell == geometry::Cell{};
  const Ball time =
      meets(scene_.walls[static_cast<std::size_t>(other.first.wall)], seen(other.first), v, scene_.motion, standing).time;
  switch (sign(time * dot(v, v) - dot(to_joint, v))) {
    case Sign::positive:
      return at_joint;
    case Sign::negative:
      return other;
    default:
      return {Choice::undecided, joint.hit, other.first};
  }
}

// Flies to the wall; the state stands on it afterwards.
void Attempt::move_to(const Copy& copy) {
  const auto index = static_cast<std::size_t>(copy.wall);
  const bool same = copy.wall == now_.standing && copy.cell == geometry::Cell{};
  const Bound per_unit(1.000001 / unit_), per_speed(1.00001 / speed_), per_time(1.000001 / time_unit_);
  if (!(copy.cell == geometry::Cell{})) {
    const BallVector seen = now_.state.position - scene_.translation(copy.cell);
    now_.errors.round(radius(seen) * per_unit, Bound());
    now_.state.position = middle(seen);
    now_.cell = {now_.cell.first + copy.cell.first, now_.cell.second + copy.cell.second};
  }
  LandingOf<Ball> landing =
      flight_to<Ball, Ball>(scene_.walls[index], now_.state.position, now_.state.velocity, scene_.motion, same);
  // The tangent map over all states that the true one may be.
  const Bound dP = position_error(), dv = velocity_error();
  const VectorOf<Interval> P{interval_of(now_.state.position.x, dP), interval_of(now_.state.position.y, dP)};
  const VectorOf<Interval> v{interval_of(now_.state.velocity.x, dv), interval_of(now_.state.velocity.y, dv)};
  const bool settles = settles_now();
  const Bound settled = settles ? settle(landing, scene_, scene_.walls[index], same, unit_) : Bound();
  const BallVector position = middle(landing.position), velocity = middle(landing.velocity);
  const FrameOf<Interval> after{tangent_of(fast_.walls[index], point(position)), point(velocity), unit_};
  TangentMap<Interval> map = tangent_map(fast_.walls[index], P, v, fast_.motion, same, now_.frame, after);
  for (Interval& t : map.times) t = t / Interval(time_unit_);
  now_.errors.move(map.rows, map.times);
  const Ball time = now_.state.time + landing.time;
  const Bound rounding = settled + radius(landing.position) * per_unit + radius(landing.velocity) * per_speed;
  now_.errors.round(rounding, time.radius() * per_time);
  now_.state = {position, velocity, time.midpoint()};
  now_.frame = after;
  // After settling the state has its speed to first order; a turn by b takes b^2/2 of the component along
  // the midpoint's velocity.
  const Bound turned = now_.errors.size(turning);
  if (settles) now_.errors.constrain(speed, rounding + turned * turned);
  const WallOf<Ball>& wall = scene_.walls[index];
  if (same && wall.form == Form::segment) {
    // It is on the wall, so as far off as the midpoint is from the wall.
    const Ball height = dot(position - wall.from, wall.normal);
    Bound distance;
    arb_get_mag(distance.raw(), height.raw());
    const geometry::Vector normal = near(wall.normal);
    now_.errors.constrain(off, distance * per_unit * Bound(1.000001 / std::sqrt(dot(normal, normal))));
  }
  if (settles && same && wall.form != Form::segment) {
    // Likewise it is on the curve: who is a along its tangent and near it is at most a^2/r off it (for a < r/2), where r is
    // the least radius of curvature.
    const double radius_below = least_radius(wall) * 0.999999 / unit_;
    const Bound moved = now_.errors.size(along);
    if (moved.to_double() < 0.5 * radius_below && now_.errors.size(off).to_double() < 0.5 * radius_below)
      now_.errors.constrain(off, rounding + moved * moved * Bound(1.0 / radius_below));
  }
  now_.wall = now_.standing = copy.wall;
}

// With many bits a few of them are cheaper than the squares: then every fourth hit suffices.
bool Attempt::settles_now() const { return scene_.motion.turns || bits_ < 2000 || now_.hits % 4 == 3; }

// The true state lies on the wall and has the true speed: the computed one is put back there to first
// order in what it has left them by, and what is changed counts as rounding. Without this the errors off
// the wall and of the speed would feed each other, for their motion is unstable.
Bound Attempt::settle(LandingOf<Ball>& landing, const SceneOf<Ball>& scene, const WallOf<Ball>& w, bool same,
                      double unit) {
  BallVector& v = landing.velocity;
  const Ball slow = (scene.motion.speed2 - (square(v.x) + square(v.y))) * scene.motion.inverse_speed2;
  const Ball half(0.5);
  const Ball stretch = half * first_bits(slow);
  v = {v.x + stretch * v.x, v.y + stretch * v.y};
  Bound changed;
  arb_get_mag(changed.raw(), slow.raw());
  if (!same || w.form == Form::segment) return changed;
  BallVector& P = landing.position;
  if (w.form == Form::ellipse) {
    // Down the gradient of X^2 + Y^2 - 1, which is twice the normal.
    const BallVector e = P - w.centre;
    const Ball X = dot(e, w.along), Y = dot(e, w.across);
    const BallVector normal = X * w.along + Y * w.across;
    const Ball low = (Ball(1) - (square(X) + square(Y))) / (square(normal.x) + square(normal.y));
    const Ball lift = half * first_bits(low);
    P = {P.x + lift * normal.x, P.y + lift * normal.y};
    Bound lifted, length;
    arb_get_mag(lifted.raw(), low.raw());
    arb_get_mag(length.raw(), (sqrt(square(normal.x) + square(normal.y))).raw());
    return changed + lifted * length * Bound(1.000001 / unit);
  }
  const BallVector e = P - w.centre;
  const Ball low = (w.radius2 - (square(e.x) + square(e.y))) * w.double_inverse;
  const Ball lift = half * half * first_bits(low);  // (r^2 - e^2)/(2 r^2)
  P = {P.x + lift * e.x, P.y + lift * e.y};
  Bound lifted;
  arb_get_mag(lifted.raw(), low.raw());
  return changed + lifted * Bound(std::sqrt(w.radius2.to_double()) * 1.000001 / unit);
}

double Attempt::needed_bits() const {
  const double tolerance = -static_cast<double>(task_.digits) * 3.3219280948873626 - 2.0;
  const double error = std::max({position_error().log2(), velocity_error().log2(), time_error().log2()});
  return error - tolerance;
}

Outcome Attempt::step() {
  trim_precision();
  const Precision precision(bits_);
  const auto joint = ties_.joints.find(now_.hits + 1);
  const bool at_joint = joint != ties_.joints.end();
  if (!ties_.passed_by.empty() || !ties_.joints.empty()) {
    const auto touched = ties_.passed_by.find(now_.hits + 1);
    std::vector<Copy> passed_by = touched == ties_.passed_by.end() ? std::vector<Copy>() : touched->second;
    if (at_joint) passed_by.insert(passed_by.end(), joint->second.of.begin(), joint->second.of.end());
    fast_.passed_by = scene_.passed_by = passed_by;
  }
  const Choice choice = at_joint ? choose_at(joint->second) : choose();
  switch (choice.answer) {
    case Choice::undecided:
      return {Outcome::undecided, needed_bits(), {Doubt::choice, choice.first, choice.second, -1}};
    case Choice::too_far:
      return {Outcome::too_far, 0.0, {Doubt::choice, choice.first, {}, -1}};
    case Choice::nothing:
      return {Outcome::unbounded, 0.0, {}};
    case Choice::wall:
      break;
  }
  std::optional<Now> before;
  if (t_max_ || !scene_.holes.empty()) before = now_;
  move_to(choice.first);
  const Outcome outcome = arrive(choice.first, before);
  if (outcome.kind == Outcome::undecided)
    now_ = std::move(*before);  // it may go on, should algebra tell
  else if (path_.size() < longest_path)
    path_.push_back(choice.first);
  return outcome;
}

Outcome Attempt::arrive(const Copy& copy, const std::optional<Now>& before) {
  if (!t_max_) return landed(copy, before);
  Sign late = sign(now_.state.time.widened(time_error()) - *t_max_);
  if (late == Sign::undecided && ties_.at_last_time == now_.hits + 1) late = Sign::zero;
  if (late == Sign::undecided) return {Outcome::undecided, needed_bits(), {Doubt::last_time, copy, {}, -1}};
  if (late != Sign::positive) return landed(copy, before);
  now_ = *before;
  return stop_at_last_time();
}

Outcome Attempt::landed(const Copy& copy, const std::optional<Now>& before) {
  if (!scene_.holes.empty()) {
    Passage passage = pass();
    if (passage.verdict == Verdict::undecided) {
      const auto known = ties_.holes.find(now_.hits + 1);
      if (known == ties_.holes.end())
        return {Outcome::undecided, needed_bits(), {Doubt::hole, copy, {}, passage.hole}};
      passage = {known->second >= 0 ? Verdict::yes : Verdict::no, known->second};
    }
    if (passage.verdict == Verdict::yes) {
      hole_ = passage.hole;
      return leave(*before);
    }
  }
  ++now_.hits;
  const double needed = needed_bits();
  if (!(needed <= 0.0)) return {Outcome::inaccurate, needed, {}};
  return {Outcome::hit, 0.0, {}};
}

Passage Attempt::pass() const {
  const Bound error = position_error();
  const BallVector& P = now_.state.position;
  const Passage fast = fast_.hole_at(now_.wall, {interval_of(P.x, error), interval_of(P.y, error)});
  if (fast.verdict != Verdict::undecided) return fast;
  const Precision precision(bits_);
  return scene_.hole_at(now_.wall, {P.x.widened(error), P.y.widened(error)});
}

// Through a hole with the velocity that it came with; the last reflection was the one before.
Outcome Attempt::leave(const Now& before) {
  const double needed = needed_bits();
  if (!(needed <= 0.0)) return {Outcome::inaccurate, needed, {}};
  BallState s = enclosed();
  const Bound error = Bound(speed_) * before.errors.of_velocity();
  s.velocity = {before.state.velocity.x.widened(error), before.state.velocity.y.widened(error)};
  if (scene_.motion.turns) {  // that has turned since then: the reflection is undone instead
    const Precision precision(bits_);
    const Bound at = position_error(), after = velocity_error();
    const BallVector P{now_.state.position.x.widened(at), now_.state.position.y.widened(at)};
    const BallVector v{now_.state.velocity.x.widened(after), now_.state.velocity.y.widened(after)};
    const BallVector t = tangent_of(scene_.walls[static_cast<std::size_t>(now_.wall)], P);
    const Ball twice = Ball(2) * dot(v, t);
    s.velocity = {twice * t.x - v.x, twice * t.y - v.y};
  }
  now_.wall = before.wall;
  stopped_ = std::move(s);
  return {Outcome::escaped, 0.0, {}};
}

Outcome Attempt::stop_at_last_time() {
  BallState s = enclosed();
  const Ball rest = *t_max_ - s.time;
  if (scene_.motion.turns) {
    const LandingOf<Ball> end = larmor_state_after(rest, s.position, s.velocity, scene_.motion.half_omega);
    s.position = end.position;
    s.velocity = end.velocity;
  } else {
    s.position = s.position + rest * s.velocity;
  }
  s.time = *t_max_;
  const double tolerance = -static_cast<double>(task_.digits) * 3.3219280948873626 - 2.0;
  const double error = std::max(radius(s.position).log2(), radius(s.velocity).log2());
  if (!(error <= tolerance)) return {Outcome::inaccurate, error - tolerance, {}};
  stopped_ = std::move(s);
  return {Outcome::stopped, 0.0, {}};
}

BallState Attempt::enclosed() const {
  if (stopped_) return *stopped_;
  const Precision precision(bits_);
  const Bound dP = position_error(), dv = velocity_error();
  BallState r;
  r.position = {now_.state.position.x.widened(dP), now_.state.position.y.widened(dP)};
  if (scene_.lattice) r.position = r.position + scene_.translation(now_.cell);
  r.velocity = {now_.state.velocity.x.widened(dv), now_.state.velocity.y.widened(dv)};
  r.time = now_.state.time.widened(time_error());
  return r;
}

double Attempt::lost_bits() const {
  return std::max(0.0, error_of_state().log2() + static_cast<double>(first_bits_));
}

// In a field the time has a precision of its own.
Bound Attempt::error_of_state() const {
  const Bound error = now_.errors.of_position() + now_.errors.of_velocity();
  return scene_.motion.turns ? error : error + now_.errors.of_time();
}

Forecast Attempt::look_ahead(const std::function<bool()>& interrupted) const {
  const auto number = [](const Ball& x) { return x.to_double(); };
  const SceneOf<double> scene = converted<double>(scene_, number);
  Horizon horizon;
  horizon.hits = task_.collisions > 0 ? task_.collisions - now_.hits : 100'000;
  horizon.t_max = t_max_ ? t_max_->to_double() - now_.state.time.to_double() : HUGE_VAL;
  horizon.bits = static_cast<double>(task_.most_bits);
  horizon.interrupted = &interrupted;
  return forecast(scene, where_, near(now_.state.position), near(now_.state.velocity), now_.standing, horizon, unit_);
}

}  // namespace carom::certify
