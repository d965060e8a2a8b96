// The next event of an attempt: a wall, a joint that is known, or the last time.
#include "certify/attempt.hpp"

namespace carom::certify {

// A doubt about an event after the last time does not matter. On a lattice, straight flights are
// followed to the last time only.
Choice Attempt::choose() const {
  const bool bounded = t_max_ && arena_.scene.lattice && !arena_.scene.motion.turns;
  const Choice choice = choose(bounded ? last_time() : std::nullopt);
  const bool clear = choice.answer != Choice::undecided && choice.answer != Choice::too_far;
  if (!t_max_ || bounded || clear) return choice;
  const std::optional<Ball> last = last_time();
  return last ? choose(last) : choice;
}

Choice Attempt::choose(const std::optional<Ball>& last) const {
  const VectorOf<Interval> P = now_.state->position(), v = now_.state->velocity();
  const geometry::Vector P0{P.x.middle(), P.y.middle()}, v0{v.x.middle(), v.y.middle()};
  const Interval fast_last = last ? interval_of(*last) : Interval();
  const Choice fast =
      arena_.fast.next(where_, P, v, now_.standing, P0, v0, last ? &fast_last : nullptr);
  const bool unclear =
      fast.answer == Choice::too_far && fast.first.wall >= 0;  // whether that wall is met
  if (fast.answer != Choice::undecided && !unclear) return fast;
  const Precision precision(bits_);
  const BallState s = now_.state->state(bits_);
  return arena_.scene.next(where_, s.position, s.velocity, now_.standing, P0, v0,
                           last ? &*last : nullptr);
}

// The joint, unless one of the other walls or the last time comes before it.
Choice Attempt::choose_at(const KnownTies::Joint& joint) const {
  const Choice at_joint{Choice::wall, joint.hit, {}};
  if (joint.of.empty()) return at_joint;
  const Choice other = choose();
  if (other.answer == Choice::undecided) return other;
  if (other.answer == Choice::too_far) return {Choice::undecided, joint.hit, other.first};
  const Precision precision(bits_);
  const Ball passing = passing_time(joint.at);
  const auto is_late = [&](const Ball& time) {
    return order_with_last_time(time) == Sign::positive;
  };
  const bool late = is_late(passing);
  if (other.answer == Choice::wall) {
    const Ball time = meeting_time(other.first);
    const Sign order = sign(time - passing);
    if (order == Sign::negative) return other;
    if (order != Sign::positive && !(late && is_late(time)))
      return {Choice::undecided, joint.hit, other.first};
  }
  return late ? Choice{Choice::last_time, {}, {}} : at_joint;
}

BallVector Attempt::seen(const Copy& copy, const BallVector& P) const {
  return copy.cell == geometry::Cell{} ? P : P - arena_.scene.translation(copy.cell);
}

// The last time in the form in which meetings are compared: since the start of the flight, or in a
// field -kappa; nothing beyond the flight's turn.
std::optional<Ball> Attempt::last_time() const {
  if (!t_max_) return std::nullopt;
  const Precision precision(bits_);
  const Ball rest = *t_max_ - now_.state->time();
  if (!arena_.scene.motion.turns) return rest;
  Ball h, pi, sine, cosine;
  arb_abs(h.raw(), arena_.scene.motion.half_omega.raw());
  arb_const_pi(pi.raw(), Precision::bits());
  const Ball angle = h * rest;
  if (sign(angle) != Sign::positive || sign(pi - angle) != Sign::positive) return std::nullopt;
  sin_cos(sine, cosine, angle);
  return -(h * cosine / sine);
}

Sign Attempt::order_with_last_time(const Ball& time) const {
  const std::optional<Ball> last = last_time();
  return last ? sign(time - *last) : Sign::negative;
}

Ball Attempt::meeting_time(const Copy& copy) const {
  const Precision precision(bits_);
  const BallState s = now_.state->state(bits_);
  const bool standing = copy.wall == now_.standing && copy.cell == geometry::Cell{};
  return meeting_with(arena_.wall(copy.wall), seen(copy, s.position), s.velocity,
                      arena_.scene.motion, standing)
      .time;
}

Ball Attempt::passing_time(const WallEnd& end) const {
  const Precision precision(bits_);
  const BallState s = now_.state->state(bits_);
  const WallOf<Ball>& w = arena_.wall(end.copy.wall);
  return dot(s.velocity, (end.last ? w.to : w.from) - seen(end.copy, s.position)) /
         dot(s.velocity, s.velocity);
}

// Remembers which of the walls that the flight touches come after `end`.
void Attempt::look_behind(const std::vector<Copy>& touched, const Ball& end) {
  const Precision precision(bits_);
  const BallState s = now_.state->state(bits_);
  behind_.clear();
  for (const Copy& copy : touched) {
    const WallOf<Ball>& w = arena_.wall(copy.wall);
    const BallVector P = seen(copy, s.position);
    if (w.form == Form::segment) continue;  // it is in line with the flight
    const BallVector e = in_round_frame(w, P - w.centre), u = in_round_frame(w, s.velocity);
    const Ball time = -(dot(e, u) / dot(u, u));
    if (sign(time - end) == Sign::positive) behind_.push_back(copy);
  }
}

}  // namespace carom::certify
