#include "certify/tie_follower.hpp"

#include "certify/start.hpp"

namespace carom::certify {
namespace {

constexpr std::size_t most_bits = 1u << 16;  ///< of one number of a state

/// Has `a` the smaller angle, from 0 up to a whole turn?
bool smaller_angle(const VectorOf<Quadratic>& a, const VectorOf<Quadratic>& b) {
  const auto second_half = [](const VectorOf<Quadratic>& v) {
    return sign(v.y) == Sign::negative || (is_zero(v.y) && sign(v.x) == Sign::negative);
  };
  if (second_half(a) != second_half(b)) return second_half(b);
  return sign(cross(a, b)) == Sign::positive;
}

}  // namespace

TieFollower::TieFollower(const ExactSystem& system, const CertifiedTask& task) : system_(system), task_(task) {
  TableOf<Quadratic> table = TableBuilder<Quadratic>(*system.spec).build();
  scene_.walls = std::move(table.walls);
  scene_.lattice = std::move(table.lattice);
  const ExactStart& start = system.start;
  P_ = {Quadratic(start.position.x), Quadratic(start.position.y)};
  v_ = start.angle ? Source<Quadratic>::direction(*start.angle)
                   : Vector{Quadratic(start.direction.x), Quadratic(start.direction.y)};
  standing_ = start.wall;
  if (standing_ >= 0) P_ = point_with_parameter(wall(standing_), start.u);
  // The speed is that of the direction: only the time is another one, and in a field what it turns in a time.
  scene_.motion.speed2 = dot(v_, v_);
  scene_.motion.inverse_speed2 = Quadratic(1) / scene_.motion.speed2;
  const Quadratic omega(system.omega);
  scene_.motion.turns = !is_zero(omega);
  if (turns()) scene_.motion.half_omega = omega * sqrt(scene_.motion.speed2) / Quadratic(system.speed) / Quadratic(2);
}

TieFollower::Vector TieFollower::velocity_after(const Vector& d) const {
  return v_ + Quadratic(2) * scene_.motion.half_omega * right_of(d);
}

void TieFollower::fly_to(const Copy& copy) {
  const bool same = copy.wall == standing_ && copy.cell == geometry::Cell{};
  const Wall& w = wall(copy.wall);
  const Vector P = seen(copy);
  LandingOf<Quadratic> landing;
  if (!turns()) {
    landing = fly<Quadratic, Quadratic>(w, P, v_, scene_.motion, same);
    time_ = time_ + landing.time;
  } else {
    const LarmorQuadratic<Quadratic> f =
        w.form == Form::ellipse ? LarmorQuadratic<Quadratic>{1, 0, 0}
                                : larmor_quadratic<Quadratic, Quadratic>(w, P, v_, scene_.motion, same);
    // In a joint the next reflection follows at once.
    const bool at_once = !same && is_zero(f.a) && sign(f.b) == Sign::negative;
    landing = at_once ? fly<Quadratic, Quadratic>(w, P, v_, scene_.motion, same)
                      : fly_larmor<Quadratic, Quadratic>(w, P, v_, scene_.motion, same);
    const Vector before = velocity_after(landing.position - P), way = scene_.motion.inverse_speed2 * v_;
    const bool clockwise = sign(scene_.motion.half_omega) == Sign::positive;
    const Vector turn{dot(way, before), clockwise ? cross(before, way) : cross(way, before)};
    const Vector sum = turn.x * turned_ + turn.y * left(turned_);
    if (smaller_angle(sum, turned_)) ++whole_turns_;
    turned_ = sum;
  }
  P_ = landing.position;
  v_ = landing.velocity;
  standing_ = copy.wall;
  for (const Quadratic* x : {&P_.x, &P_.y, &v_.x, &v_.y, &time_, &turned_.x, &turned_.y})
    if (x->bits() > most_bits) throw NotQuadratic("numbers of more than 65536 bits");
}

std::optional<Tie> TieFollower::tie(const Doubt& doubt) {
  switch (doubt.kind) {
    case Doubt::choice: {
      const std::optional<Tie> first = with_wall(doubt.first);
      return first || doubt.second.wall < 0 ? first : with_wall(doubt.second);
    }
    case Doubt::hole:
      fly_to(doubt.first);
      return with_hole(doubt.hole_index);
    case Doubt::last_time:
      fly_to(doubt.first);
      break;
  }
  return with_last_time();
}

std::optional<Tie> TieFollower::with_last_time() const {
  const Tie tie{Tie::last_time, name(standing_) + " is met exactly at the last time: the hit counts"};
  if (!turns()) {
    // |v| t / speed, squared.
    const Quadratic way2 = square(time_) * scene_.motion.speed2;
    const Quadratic last = Quadratic(system_.speed) * Quadratic(*task_.t_max);
    return is_zero(way2 - square(last)) ? std::optional(tie) : std::nullopt;
  }
  // The velocity has turned by |omega| t. An algebraic angle other than zero has no algebraic sine (Lindemann): then
  // there is no tie.
  const std::string omega = "(" + exact_text(system_.omega) + ")", t = "(" + exact_text(*task_.t_max) + ")";
  const auto parts = ExactNumber("sqrt(" + omega + "^2)*" + t + "/pi*12", Place{}).to_rational();
  if (!parts || parts->denominator != "1") throw NotQuadratic("a last angle that is no multiple of pi/12");
  const mpz_class all(parts->numerator), turns = all / 24, rest = all % 24;
  if (turns != whole_turns_) return std::nullopt;
  return is_zero(turned_ - twenty_fourth(rest.get_si())) ? std::optional(tie) : std::nullopt;
}

}  // namespace carom::certify
