#include "certify/wall/hole.hpp"

#include <acb.h>
#include <acb_elliptic.h>

#include <cmath>

#include "carom/base/error.hpp"
#include "carom/table/table.hpp"
#include "certify/number/exact_value.hpp"
#include "certify/wall/rational_table.hpp"
#include "table/numbers.hpp"

namespace carom::certify {
namespace {

BallVector turned(const BallVector& v, const Ball& angle) {
  Ball s, c;
  arb_sin_cos(s.raw(), c.raw(), angle.raw(), Precision::bits());
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

// The angle up to whole turns, narrow also for vectors near the negative axis.
Ball angle_of(const BallVector& v) {
  Ball angle;
  if (sign(v.x) != Sign::negative) {
    arb_atan2(angle.raw(), v.y.raw(), v.x.raw(), Precision::bits());
    return angle;
  }
  const BallVector w = -v;
  arb_atan2(angle.raw(), w.y.raw(), w.x.raw(), Precision::bits());
  Ball pi;
  arb_const_pi(pi.raw(), Precision::bits());
  return angle + pi;
}

// The arc length of an ellipse as a function of the angle in the frame where it is a circle:
// b E(angle | 1 - a^2/b^2), for the element is b sqrt(1 - (1 - a^2/b^2) sin^2).
class EllipseLength {
 public:
  explicit EllipseLength(const WallOf<Ball>& w)
      : a_(Ball(1) / sqrt(dot(w.along, w.along))),
        b_(Ball(1) / sqrt(dot(w.across, w.across))),
        m_(Ball(1) - square(a_ / b_)) {}

  Ball to(const Ball& angle) const {
    acb_t result, phi, m;
    acb_init(result);
    acb_init(phi);
    acb_init(m);
    acb_set_arb(phi, angle.raw());
    acb_set_arb(m, m_.raw());
    acb_elliptic_e_inc(result, phi, m, 0, Precision::bits());
    Ball length;
    arb_set(length.raw(), acb_realref(result));
    acb_clear(m);
    acb_clear(phi);
    acb_clear(result);
    return b_ * length;
  }
  Ball element(const Ball& angle) const {
    Ball s;
    arb_sin(s.raw(), angle.raw(), Precision::bits());
    return b_ * sqrt(Ball(1) - m_ * square(s));
  }

  /// Encloses the angle up to which the length is `length`: Newton's steps find it nearly; how far
  /// off it is follows from what is missing of the length and the least element.
  Ball angle_at(const Ball& length, Ball guess) const {
    const slong bits = Precision::bits();
    for (slong now = std::min<slong>(bits, 64);; now = std::min(bits, 2 * now)) {
      const Precision few(now + 16);
      for (int step = 0; step < (now <= 64 ? 40 : 2); ++step) {
        const Ball better = (guess - (to(guess) - length) / element(guess)).midpoint();
        const bool settled = sign((better - guess).midpoint()) == Sign::zero;
        guess = better;
        if (settled) break;
      }
      if (now == bits) break;
    }
    const Ball missing = to(guess) - length, by_a = missing / a_, by_b = missing / b_;
    Bound error, other;
    arb_get_mag(error.raw(), by_a.raw());
    arb_get_mag(other.raw(), by_b.raw());
    return guess.widened(error < other ? other : error);
  }

 private:
  Ball a_, b_, m_;
};

ExactNumber end_of(const HoleSpec& spec, const char* side) {
  return {table::shapes::quoted(spec.center) + side + table::shapes::quoted(spec.width) + "/2",
          spec.place};
}

// The sign of an arc length less that of the wall.
Sign past_length(const ExactSystem& system, const HoleSpec& spec, const ExactNumber& s) {
  const auto index = static_cast<std::size_t>(system.table->wall_index(spec.wall));
  for (const slong bits : {bits_of_a_first_look, slong{1024}, most_bits_of_a_sign}) {
    const Precision precision(bits);
    const WallOf<Ball> w = ball_table(*system.spec).walls[index];
    if (const Sign past = sign(value_of(s) - arc_length(w)); past != Sign::undecided) return past;
    if (bits != bits_of_a_first_look || w.form != Form::segment) continue;
    try {  // by squares, for the length is a root; neither number is negative
      const WallOf<Rational> exact = rational_table(*system.spec).walls[index];
      return sign(square(Rational(s)) - dot(exact.chord, exact.chord));
    } catch (const NotRational&) {  // more bits may tell
    }
  }
  return Sign::undecided;
}

// Does the hole cover its whole wall? On a closed wall its width decides, wherever it begins. `w`:
// the wall to the present precision.
bool is_all_of_its_wall(const ExactSystem& system, const HoleSpec& spec, const WallOf<Ball>& w) {
  if (sign(value_of(spec.width) - arc_length(w)) == Sign::negative) return false;
  const auto at_least = [](Sign s) { return s == Sign::zero || s == Sign::positive; };
  if (w.closed) return at_least(past_length(system, spec, spec.width));
  const Sign start = before_start(spec);
  return (start == Sign::zero || start == Sign::negative) && at_least(past_end(system, spec));
}

class Cutter {
 public:
  Cutter(const WallOf<Ball>& wall, const Ball& from, const Ball& to)
      : w_(wall), from_(from), to_(to) {}

  void cut(HoleOf<Ball>& hole) const {
    if (w_.form == Form::segment) {
      const Ball length = sqrt(dot(w_.chord, w_.chord));
      hole.low = from_ * length;
      hole.high = to_ * length;
      return;
    }
    const Ball way(w_.turn);
    const BallVector d = w_.from - w_.centre;
    Ball turn;
    if (w_.form == Form::circle) {
      const Ball radius = sqrt(w_.radius2);
      hole.first = turned(d, way * from_ / radius);
      hole.last = turned(d, way * to_ / radius);
      turn = (to_ - from_) / radius;
    } else {
      const EllipseLength length(w_);
      const Ball start = angle_of(in_round_frame(w_, d));
      const auto angle_at = [&](const Ball& s) {
        return length.angle_at(length.to(start) + way * s,
                               (start + way * s / length.element(Ball(0.8))).midpoint());
      };
      const Ball first = angle_at(from_), last = angle_at(to_);
      hole.first = turned({1, 0}, first);
      hole.last = turned({1, 0}, last);
      turn = way * (last - first);
    }
    Ball pi;
    arb_const_pi(pi.raw(), Precision::bits());
    hole.wide = above_zero(sign(turn - pi));
  }

 private:
  const WallOf<Ball>& w_;
  const Ball &from_, &to_;
};

}  // namespace

Ball angle_of(const WallOf<Ball>& w) {
  const auto seen = [&](const BallVector& P) { return angle_of(in_round_frame(w, P - w.centre)); };
  Ball whole_turn;
  arb_const_pi(whole_turn.raw(), Precision::bits());
  whole_turn = whole_turn + whole_turn;
  if (w.closed) return whole_turn;
  const Ball turn = Ball(w.turn) * (seen(w.to) - seen(w.from));
  const Sign forwards = sign(turn);
  if (forwards == Sign::undecided) return turn.widened(Bound(HUGE_VAL));  // nothing is known
  return forwards == Sign::positive ? turn : turn + whole_turn;
}

Ball arc_length(const WallOf<Ball>& w) {
  if (w.form == Form::segment) return sqrt(dot(w.chord, w.chord));
  const Ball turn = angle_of(w);
  if (w.form != Form::ellipse) return sqrt(w.radius2) * turn;
  const Ball start = angle_of(in_round_frame(w, w.from - w.centre));
  const EllipseLength length(w);
  return Ball(w.turn) * (length.to(start + Ball(w.turn) * turn) - length.to(start));
}

Sign before_start(const HoleSpec& spec) { return sign_of(end_of(spec, "-")); }
Sign past_end(const ExactSystem& system, const HoleSpec& spec) {
  return past_length(system, spec, end_of(spec, "+"));
}

std::vector<HoleOf<Ball>> ball_holes(const ExactSystem& system,
                                     const std::vector<WallOf<Ball>>& walls) {
  std::vector<HoleOf<Ball>> holes;
  for (std::size_t k = 0; k < system.spec->holes.size(); ++k) {
    const HoleSpec& spec = system.spec->holes[k];
    HoleOf<Ball> hole;
    hole.wall = system.table->wall_index(spec.wall);
    hole.hole = system.table->hole_index(name_of_hole(system.spec->holes, k));
    const WallOf<Ball>& w = walls[static_cast<std::size_t>(hole.wall)];
    const Ball centre = value_of(spec.center), half = value_of(spec.width) / 2;
    hole.whole = is_all_of_its_wall(system, spec, w);
    if (!hole.whole) Cutter(w, centre - half, centre + half).cut(hole);
    holes.push_back(std::move(hole));
  }
  return holes;
}

}  // namespace carom::certify
