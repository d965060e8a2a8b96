// Free motion under a uniform magnetic field for a given time.
//
// With J v = (v_y, -v_x) and theta = omega t the velocity turns clockwise by theta, and the
// particle moves along a chord: u, the velocity turned by theta/2, times (2/omega) sin(theta/2).
// Neither cancels for small theta, and nothing is chosen by size; omega = 0 is the straight line.
#pragma once

#include "carom/geometry/vector.hpp"
#include "carom/integrators/arithmetic.hpp"

namespace carom::integrators {

/// A turn clockwise as three shears, each of determinant 1 whatever its coefficient is rounded to:
/// many turns by one angle neither shrink nor stretch a velocity (a rounded sine and cosine do, by
/// 1e-16 a turn). Beyond a quarter the velocity is turned round first, which keeps the shears small
/// and is exact. Quarter turns would be exact, too, but with them roundings have a trend of 1e-18 a
/// turn (measured).
template <class Real>
class ShearTurn {
 public:
  ShearTurn() = default;
  explicit ShearTurn(SineCosine<Real> turn) : round_(turn.cosine < Real(0)) {
    if (round_) turn = {-turn.sine, -turn.cosine};
    sine_ = turn.sine;
    half_tangent_ = turn.sine / (Real(1) + turn.cosine);
  }

  /// The drift of one velocity, or of the velocities of many particles.
  template <class Number>
  [[gnu::always_inline]] geometry::BasicVector<Number> operator()(
      geometry::BasicVector<Number> v) const {
    if (round_) v = -v;
    v.x = v.x + half_tangent_ * v.y;
    v.y = v.y - sine_ * v.x;
    v.x = v.x + half_tangent_ * v.y;
    return v;
  }

 private:
  Real sine_{}, half_tangent_{};
  bool round_ = false;
};

template <class Real>
class LarmorDrift {
 public:
  LarmorDrift() = default;
  LarmorDrift(const Real& omega, const Real& time) : chord_(time) {
    const Real half_angle = omega * time / Real(2);
    if (half_angle == Real(0)) return;
    straight_ = false;
    const SineCosine<Real> turn = Arithmetic<Real>::turn(half_angle);
    chord_ = time * (turn.sine / half_angle);
    half_turn_ = ShearTurn<Real>(turn);
  }

  /// One particle, or many.
  template <class Number>
  [[gnu::always_inline]] void move(geometry::BasicVector<Number>& position,
                                   geometry::BasicVector<Number>& velocity) const {
    const Number chord(chord_);
    if (straight_) {
      position = position + chord * velocity;
      return;
    }
    const geometry::BasicVector<Number> along = half_turn_(velocity);
    position = position + chord * along;
    velocity = half_turn_(along);
  }
  /// The turn alone.
  template <class Number>
  [[gnu::always_inline]] void turn(geometry::BasicVector<Number>& velocity) const {
    if (!straight_) velocity = half_turn_(half_turn_(velocity));
  }

 private:
  Real chord_{};
  ShearTurn<Real> half_turn_;
  bool straight_ = true;
};

}  // namespace carom::integrators
