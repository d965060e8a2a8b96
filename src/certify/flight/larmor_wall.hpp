// Which wall does a Larmor flight meet first? By signs in any arithmetic, as in next_wall.hpp; what
// is compared instead of times is -kappa, which grows along the flight.
#pragma once

#include <optional>

#include "carom/base/elementary.hpp"
#include "certify/flight/larmor_flight.hpp"
#include "certify/flight/next_wall.hpp"

namespace carom::certify {

/// Does the crossing X of a line lie on the segment? Of plain numbers its start belongs to it, its
/// end does not.
template <class N>
Verdict on_segment(const WallOf<N>& w, const VectorOf<N>& X) {
  const Sign after = sign_or_tie(dot(X - w.from, w.chord));
  if (after == Sign::negative) return Verdict::no;
  const Sign before = sign_or_tie(dot(w.to - X, w.chord));
  if (before == Sign::negative || before == Sign::zero) return Verdict::no;
  return after == Sign::undecided || before == Sign::undecided ? Verdict::undecided : Verdict::yes;
}

/// Where a flight that crosses the wall's line or circle at k meets the wall.
template <class N>
Meeting<N> meeting_at(Kappa<N> k, Verdict verdict, const WallOf<N>& w, const VectorOf<N>& P,
                      const VectorOf<N>& v, const MotionOf<N>& motion) {
  if (!w.closed) {
    const VectorOf<N> X = larmor_state<N, N>(k, P, v, motion.half_omega).position;
    const Verdict piece = w.form == Form::segment ? on_segment(w, X) : on_arc(w, X);
    if (piece == Verdict::no) return {};
    if (piece == Verdict::undecided) verdict = piece;
  }
  const Sign side = sign(k.q);
  if (side == Sign::negative) k = {-k.p, -k.q};
  // Just after the start or just before the end of the turn: that is not known.
  if (side == Sign::zero || side == Sign::undecided) verdict = Verdict::undecided;
  return {verdict, -(k.p / k.q)};
}

/// A segment or circle; the place is unique, for a circle and a line or circle cross twice, and one
/// of the two leads into the domain.
template <class N>
Meeting<N> meets_larmor(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                        const MotionOf<N>& motion, bool standing) {
  const Quadratic<N> f = larmor_quadratic<N, N>(w, P, v, motion, standing);
  if (standing) {
    const Sign inwards = sign_or_tie(f.b);
    if (inwards == Sign::negative || inwards == Sign::zero) return {};
    const Verdict verdict = inwards == Sign::positive ? Verdict::yes : Verdict::undecided;
    return meeting_at(second_root(f), verdict, w, P, v, motion);
  }
  const N squared_root = discriminant(f);
  const Sign crosses = sign_or_tie(squared_root);  // a tangent flight does not hit
  if (crosses == Sign::negative || crosses == Sign::zero) return {};
  const Verdict verdict = crosses == Sign::positive ? Verdict::yes : Verdict::undecided;
  return meeting_at(rising_root(f, squared_root), verdict, w, P, v, motion);
}

/// An ellipse or an arc of one.
template <class N>
Meeting<N> meets_ellipse(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                         const MotionOf<N>& motion, bool standing) {
  const EllipseFlight<N> flight(larmor_form<N, N>(w, P, v, motion, standing),
                                kappa_scale(w, v, motion.half_omega));
  for (const LarmorExit<N>& exit : LarmorExits<N>(flight.chords(), w.closed ? 1 : 5)) {
    const Kappa<N> k = flight.place(exit);
    // It may leave there or anywhere later: whether on the arc there says nothing, and no time
    // before the bracket's.
    if (!exit.certain) return {Verdict::undecided, -(k.p / k.q)};
    const Meeting<N> m = meeting_at(k, Verdict::yes, w, P, v, motion);
    if (m.verdict != Verdict::no) return m;
  }
  return {};
}

/// Straight or on a Larmor circle, as the particle moves.
template <class N>
Meeting<N> meeting_with(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                        const MotionOf<N>& motion, bool standing) {
  if (!motion.turns) return meets(w, P, v, motion, standing);
  return w.form == Form::ellipse ? meets_ellipse(w, P, v, motion, standing)
                                 : meets_larmor(w, P, v, motion, standing);
}

/// A Larmor flight over a lattice in pieces of equal length, in doubles: where to look for walls.
class LarmorPieces {
 public:
  LarmorPieces(geometry::Vector from, geometry::Vector velocity, double half_omega, double length)
      : from_(from),
        velocity_(velocity),
        h_(half_omega),
        time_(length / std::sqrt(dot(velocity, velocity))) {}

  geometry::Vector middle(double k) const {
    if (angle_to(k) < hardly_turned) return from_ + ((k + 0.5) * time_) * velocity_;
    const elementary::SinCos a = elementary::sincos(h_ * (k + 0.5) * time_);
    const double ahead = a.sin * a.cos / h_, aside = a.sin * a.sin / h_;
    return from_ + ahead * velocity_ + aside * right(velocity_);
  }
  /// All of the turn lies before the end of piece k.
  bool last(double k) const { return angle_to(k) > above_pi; }
  /// -kappa before the end of piece k, as far as walls have been looked for; nothing near the end
  /// of the turn.
  std::optional<double> seen_to(double k) const {
    const double angle = angle_to(k);
    if (angle > near_end_of_turn) return std::nullopt;
    if (angle < hardly_turned) return -1.0 / ((k + 1.0) * time_ * (1.0 - 0x1p-40));
    const elementary::SinCos a = elementary::sincos(angle);
    return -std::fabs(h_) * a.cos / a.sin;
  }

 private:
  static constexpr double above_pi = 0x1.921fb54442d19p+1;  ///< the double after pi
  /// Any angle below pi whose sine is not small.
  static constexpr double near_end_of_turn = 3.0;
  /// Below it a flight is straight, except for less than its coordinates are rounded. A field may
  /// be too small for a double.
  static constexpr double hardly_turned = 0x1p-60;
  /// Half the angle that is turned by the end of piece k, less 2^-40 of it: that is more than its
  /// rounding, and as the cotangent has the slope -1/sin^2 it moves kappa by more than sine and
  /// cosine are rounded by (2^-50/sin^2).
  double angle_to(double k) const { return std::fabs(h_) * (k + 1.0) * time_ * (1.0 - 0x1p-40); }
  geometry::Vector from_, velocity_;
  double h_, time_;
};

}  // namespace carom::certify
