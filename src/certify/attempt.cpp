#include "certify/attempt.hpp"

#include "certify/enclosure/line_enclosure.hpp"
#include "certify/enclosure/point_enclosure.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/wall/start.hpp"

namespace carom::certify {
namespace {

/// A power of two of at least half that size.
double power_near(double size) { return std::exp2(std::floor(std::log2(size))); }

double bits_of(int digits) { return static_cast<double>(digits) * 3.3219280948873626; }

/// The velocity that a particle came with, which is `after` once it was reflected at P.
BallVector before_reflection(const WallOf<Ball>& w, const BallVector& P, const BallVector& after) {
  const BallVector t = tangent_of(w, P);
  const Ball twice = Ball(2) * dot(after, t);
  return {twice * t.x - after.x, twice * t.y - after.y};
}

}  // namespace

Attempt::Attempt(const ExactSystem& system, const CertifiedTask& task, const KnownTies& ties,
                 long bits, long reading)
    : system_(system),
      task_(task),
      ties_(ties),
      first_bits_(bits),
      bits_(bits),
      table_bits_(bits),
      reading_bits_(reading) {
  const Precision precision(bits);
  set_arena(ball_table(*system.spec));
  if (task.t_max) t_max_ = value_of(*task.t_max);
  if (LineTable::holds(arena_.scene)) {
    // Few bits: the digits asked for, and somewhat more in each attempt, should the last time be a
    // close call.
    lines_.emplace(arena_.scene,
                   static_cast<long>(bits_of(task.digits)) + reading + (t_max_ ? bits / 16 : 0));
    if (bits > 1000) lines_->shorten(system);
  }
  now_.standing = system.start.wall;
  now_.state = start_enclosure(system);
}

void Attempt::set_arena(BallTable table) {
  const Ball omega = value_of(system_.omega);
  where_ = whereabouts_of(table, omega);
  const double size = std::max(where_.stretch, where_.widest);
  arena_.unit = size > 0.0 ? power_near(size) : 1.0;
  SceneOf<Ball>& scene = arena_.scene;
  scene.walls = std::move(table.walls);
  scene.lattice = std::move(table.lattice);
  const Ball written_speed = value_of(system_.speed);
  scene.motion.speed2 = square(written_speed);
  scene.motion.inverse_speed2 = Ball(1) / scene.motion.speed2;
  scene.motion.half_omega = omega / 2;
  scene.motion.turns = sign(scene.motion.half_omega) != Sign::zero;
  // Velocities of midpoints are faster by less than linear_bits() allows, 2^-20.
  arena_.speed = interval_of(written_speed).high * (1.0 + 0x1p-19);
  arena_.time_unit = arena_.unit / arena_.speed;
  scene.holes = ball_holes(system_, scene.walls);
  arena_.fast = converted<Interval>(scene, [](const Ball& x) { return interval_of(x); });
}

std::unique_ptr<StateEnclosure> Attempt::start_enclosure(const ExactSystem& system) {
  const ExactStart& start = system.start;
  BallState state;
  state.position = {value_of(start.position.x), value_of(start.position.y)};
  BallVector direction{value_of(start.direction.x), value_of(start.direction.y)};
  if (start.angle) {
    const CosSin d = direction_of(*start.angle);
    direction = {d.cos, d.sin};
  }
  const Ball length2 = dot(direction, direction), speed2 = arena_.scene.motion.speed2;
  // A direction of the right length already stays exact.
  const bool exact = (length2 - speed2).contains(Ball(0)) && sign(length2 - speed2) == Sign::zero;
  rescaled_ = !(length2 - speed2).contains(Ball(0));
  const Ball scale = exact ? Ball(1) : sqrt(speed2 / length2);
  state.velocity = {scale * direction.x, scale * direction.y};
  if (start.wall >= 0) state.position = point_with_parameter(arena_.wall(start.wall), start.u);
  if (lines_) return std::make_unique<LineEnclosure>(arena_, *lines_, state);
  return std::make_unique<PointEnclosure>(arena_, state);
}

// Bits far below the error that is already there are of no use.
void Attempt::trim_precision() {
  bits_ =
      std::min(first_bits_, static_cast<long>(std::clamp(now_.state->useful_bits(), 64.0, 1e15)));
  if (arena_.scene.motion.turns) {
    const double time = now_.state->time().to_double(),
                 size = std::max(1.0, time / arena_.time_unit);
    const long digits =
        static_cast<long>(bits_of(task_.digits) + std::log2(size)) + reading_bits_ - 32;
    arena_.scene.motion.time_bits = digits + first_bits_ / 16;
  }
  if (bits_ + 32 < table_bits_ - table_bits_ / 16) {
    const Precision precision(bits_ + 32);
    arena_.scene = converted<Ball>(
        arena_.scene, [](const Ball& x) { return x.rounded(); });  // nothing is passed by
    if (lines_) lines_->round();
    table_bits_ = bits_ + 32;
  }
}

// Flies to the wall; the state is on it afterwards.
void Attempt::move_to(const Copy& copy) {
  now_.state->fly(copy, copy.wall == now_.standing && copy.cell == geometry::Cell{}, bits_);
  now_.cell = {now_.cell.first + copy.cell.first, now_.cell.second + copy.cell.second};
  now_.wall = now_.standing = copy.wall;
}

double Attempt::needed_bits() const {
  const StateEnclosure& s = *now_.state;
  const double error =
      std::max({s.position_error().log2(), s.velocity_error().log2(), s.time_error().log2()});
  return std::max(error + bits_of(task_.digits) + 2.0, linear_bits());
}

// Bounds of LineEnclosure by first order hold a margin for the second order: 1.0001 and 1.001.
// Below 2^-20 of the state the second order is a share of at most some 2^-19 of the first.
double Attempt::linear_bits() const { return now_.state->error().log2() + 20.0; }

Outcome Attempt::step() {
  if (now_.hits == 0 && !(linear_bits() <= 0.0)) return {Outcome::inaccurate, linear_bits(), {}};
  trim_precision();
  const Precision precision(bits_);
  const auto joint = ties_.joints.find(now_.hits + 1);
  const bool at_joint = joint != ties_.joints.end();
  std::vector<Copy> touched;
  behind_.clear();
  if (!ties_.passed_by.empty() || !ties_.joints.empty()) {
    const auto known = ties_.passed_by.find(now_.hits + 1);
    if (known != ties_.passed_by.end()) touched = known->second;
    std::vector<Copy> passed_by = touched;
    if (at_joint)
      passed_by.insert(passed_by.end(), joint->second.of.begin(), joint->second.of.end());
    arena_.fast.passed_by = arena_.scene.passed_by = std::move(passed_by);
  }
  const Choice choice = at_joint ? choose_at(joint->second) : choose();
  switch (choice.answer) {
    case Choice::undecided:
      return {Outcome::undecided, needed_bits(), {Doubt::choice, choice.first, choice.second, -1}};
    case Choice::too_far:
      return {Outcome::too_far, 0.0, {Doubt::choice, choice.first, {}, -1}};
    case Choice::nothing:
      return {Outcome::unbounded, 0.0, {}};
    case Choice::last_time:
      look_behind(touched, *last_time());
      return stop_at_last_time();
    case Choice::wall:
      break;
  }
  const bool here = at_joint && choice.first == joint->second.hit,
             in_joint = here && joint->second.of.empty();
  if (!in_joint && !touched.empty())
    look_behind(touched, here ? passing_time(joint->second.at) : meeting_time(choice.first));
  if (here && !joint->second.dead_end.empty()) {
    if (ties_.at_last_time != now_.hits + 1 &&
        order_with_last_time(passing_time(joint->second.at)) == Sign::undecided)
      return {Outcome::undecided, needed_bits(), {Doubt::last_time, choice.first, {}, -1}};
    return {Outcome::dead_end, 0.0, {}};
  }
  std::optional<Now> before;
  if (t_max_ || !arena_.scene.holes.empty()) before = now_.copy();
  move_to(choice.first);
  const Outcome outcome = arrive(choice.first, before);
  if (outcome.kind == Outcome::undecided)
    now_ = std::move(*before);  // it may go on, should rational numbers tell
  else if (path_.size() < longest_path)
    path_.push_back(choice.first);
  return outcome;
}

Outcome Attempt::arrive(const Copy& copy, const std::optional<Now>& before) {
  if (!t_max_) return landed(copy, before);
  Sign late = sign(now_.state->time() - *t_max_);
  if (late == Sign::undecided && ties_.at_last_time == now_.hits + 1) late = Sign::zero;
  if (late == Sign::undecided)
    return {Outcome::undecided, needed_bits(), {Doubt::last_time, copy, {}, -1}};
  if (late != Sign::positive) return landed(copy, before);
  now_ = before->copy();
  if (const auto touched = ties_.passed_by.find(now_.hits + 1); touched != ties_.passed_by.end())
    look_behind(touched->second, *last_time());
  return stop_at_last_time();
}

Outcome Attempt::landed(const Copy& copy, const std::optional<Now>& before) {
  if (!arena_.scene.holes.empty()) {
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
  const Passage fast = arena_.fast.hole_at(now_.wall, now_.state->position());
  if (fast.verdict != Verdict::undecided) return fast;
  const Precision precision(bits_);
  return arena_.scene.hole_at(now_.wall, now_.state->state(bits_).position);
}

// Through a hole with the velocity that it came with; the last reflection was the one before.
Outcome Attempt::leave(const Now& before) {
  const double needed = needed_bits();
  if (!(needed <= 0.0)) return {Outcome::inaccurate, needed, {}};
  BallState s = enclosed();
  s.velocity = before.state->state(bits_).velocity;
  if (arena_.scene.motion.turns) {  // that has turned since then: the reflection is undone instead
    const Precision precision(bits_);
    const BallState after = now_.state->state(bits_);
    s.velocity = before_reflection(arena_.wall(now_.wall), after.position, after.velocity);
  }
  const double missing = radius(s.velocity).log2() + bits_of(task_.digits) + 2.0;
  if (!(missing <= 0.0)) return {Outcome::inaccurate, missing, {}};
  now_.wall = before.wall;
  stopped_ = std::move(s);
  return {Outcome::escaped, 0.0, {}};
}

Outcome Attempt::stop_at_last_time() {
  BallState s = enclosed();
  fly_for(*t_max_ - s.time, s.position, s.velocity, arena_.scene.motion);
  s.time = *t_max_;
  const double needed =
      std::max(radius(s.position).log2(), radius(s.velocity).log2()) + bits_of(task_.digits) + 2.0;
  if (!(needed <= 0.0)) return {Outcome::inaccurate, needed, {}};
  stopped_ = std::move(s);
  return {Outcome::stopped, 0.0, {}};
}

BallState Attempt::enclosed() const {
  if (stopped_) return *stopped_;
  const long few = lines_ ? lines_->few_bits : bits_;
  const Precision precision(few);
  BallState r = now_.state->state(few);
  if (arena_.scene.lattice) r.position = r.position + arena_.scene.translation(now_.cell);
  return r;
}

std::string Attempt::description(const Doubt& doubt) const {
  const auto name = [&](const Copy& copy) {
    std::string text = "'" + system_.table->walls[static_cast<std::size_t>(copy.wall)].name + "'";
    if (arena_.scene.lattice)
      text += " of cell " + std::to_string(now_.cell.first + copy.cell.first) + ", " +
              std::to_string(now_.cell.second + copy.cell.second);
    return text;
  };
  const std::string event = "event " + std::to_string(now_.hits + 1) + ": ";
  if (doubt.first.wall < 0)
    return event + "which walls are near, for the position and velocity are not known well enough";
  const std::string first = name(doubt.first);
  switch (doubt.kind) {
    case Doubt::last_time:
      return event + "whether " + first + " is met before the last time";
    case Doubt::hole:
      return event + "on which side of an end of '" +
             system_.table->holes[static_cast<std::size_t>(doubt.hole_index)].name + "' " + first +
             " is met";
    case Doubt::choice:
      break;
  }
  return doubt.second.wall < 0
             ? event + "whether the flight meets " + first
             : event + "which comes first, " + first + " or " + name(doubt.second);
}

double Attempt::missing_bits(const BallState& s) const {
  Bound largest = s.time.radius();
  for (const Ball* x : {&s.position.x, &s.position.y, &s.velocity.x, &s.velocity.y})
    if (largest < x->radius()) largest = x->radius();
  return largest.log2() + bits_of(task_.digits) + 1.001;
}

double Attempt::lost_bits() const {
  return std::max(0.0, now_.state->error().log2() + static_cast<double>(first_bits_));
}

double Attempt::spare_bits() const {
  return -now_.state->error().log2() - bits_of(task_.digits) - size_bits() - 2.0;
}

double Attempt::size_bits() const {
  return std::max(0.0, std::log2(std::max({arena_.unit, arena_.speed, arena_.time_unit})));
}
double Attempt::size_bits(const Forecast& f, double more) const {
  const double time = t_max_ ? t_max_->to_double() : f.time * more;
  return std::max(
      {size_bits(), std::log2(arena_.unit * (1.0 + f.cells * more)), std::log2(1.0 + time)});
}

// Measured. The errors of a line are only two, and roundings do not feed each other.
double Attempt::rounding_loss(double hits) const {
  return lines_ ? 8.0 + 0.6 * std::log2(hits + 1.0) : 16.0 + 1.5 * std::log2(hits + 1.0);
}

Forecast Attempt::look_ahead(const std::function<bool()>& interrupted) const {
  const auto number = [](const Ball& x) { return x.to_double(); };
  const SceneOf<double> scene = converted<double>(arena_.scene, number);
  Horizon horizon;
  horizon.hits = task_.collisions > 0 ? task_.collisions - now_.hits : 100'000;
  horizon.t_max = t_max_ ? t_max_->to_double() - now_.state->time().to_double() : HUGE_VAL;
  horizon.bits = static_cast<double>(task_.most_bits);
  horizon.interrupted = &interrupted;
  const BallState s = now_.state->state(64);
  return forecast(scene, where_, near(s.position), near(s.velocity), now_.standing, horizon,
                  arena_.unit);
}

}  // namespace carom::certify
