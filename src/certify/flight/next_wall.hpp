// Which wall does a straight flight meet first? By signs in any arithmetic; what cannot be decided
// is said.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "certify/flight/flight.hpp"

namespace carom::certify {

enum class Verdict : unsigned char { no, yes, undecided };

/// The sign of a quantity whose zero is a tie: into a joint, touching, at an end. Enclosures report
/// a proven zero as undecided, so that the tie is looked for in rational numbers. Numbers taken at
/// their word keep it: they give the joint to one of its walls.
Sign sign_or_tie(const auto& x) { return sign(x); }
inline Sign sign_or_tie(const Ball& x) {
  const Sign s = sign(x);
  return s == Sign::zero ? Sign::undecided : s;
}
inline Sign sign_or_tie(const Interval& x) {
  const Sign s = sign(x);
  return s == Sign::zero ? Sign::undecided : s;
}

/// A wall that the flight may meet, and when.
template <class N>
struct Meeting {
  Verdict verdict = Verdict::no;
  N time{};
};

template <class N>
Meeting<N> meets_segment(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v) {
  // The flight leaves through a wall that runs from its right to its left. Of plain numbers a zero
  // is a plus, for both walls of a joint.
  const Sign start = sign_or_tie(cross(v, w.from - P));
  if (start == Sign::positive || start == Sign::zero) return {};
  const Sign end = sign_or_tie(cross(v, w.to - P));
  if (end == Sign::negative) return {};
  const N height = dot(P - w.from, w.normal);
  const Sign inside = sign_or_tie(height);
  if (inside == Sign::negative || inside == Sign::zero) return {};
  const bool certain =
      start != Sign::undecided && end != Sign::undecided && inside != Sign::undecided;
  return {certain ? Verdict::yes : Verdict::undecided, -(height / dot(v, w.normal))};
}

/// Does the crossing X of a circle or ellipse lie on the arc? It does on one side of the chord.
template <class N>
Verdict on_arc(const WallOf<N>& w, const VectorOf<N>& X) {
  if (w.closed) return Verdict::yes;
  const VectorOf<N> e = X - w.from;
  const Sign side = sign_or_tie(cross(w.chord, e));
  if (side == Sign::undecided) return Verdict::undecided;
  if (side == Sign::zero)  // a joint: it belongs to the wall that begins there
    return sign(e.x) == Sign::zero && sign(e.y) == Sign::zero ? Verdict::yes : Verdict::no;
  return (side == Sign::negative) == (w.turn > 0) ? Verdict::yes : Verdict::no;
}

template <class N>
Meeting<N> meets_conic(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                       const MotionOf<N>& motion, bool standing) {
  using std::sqrt;
  const bool obstacle = w.turn < 0;
  const VectorOf<N> e = in_round_frame(w, P - w.centre), u = in_round_frame(w, v);
  const N a = w.form == Form::ellipse ? square(u.x) + square(u.y) : motion.speed2;
  const N b = dot(e, u);
  Verdict verdict = Verdict::yes;
  const auto require = [&verdict](Sign s) {  // positive, or there is no hit
    if (s == Sign::undecided) {
      if (verdict == Verdict::yes) verdict = Verdict::undecided;
    } else if (s != Sign::positive) {
      verdict = Verdict::no;
    }
  };
  N time{};
  if (standing) {
    if (obstacle) return {};  // it moves away
    require(sign_or_tie(-b));
    if (verdict == Verdict::no) return {};
    time = -(b + b) / a;
  } else {
    if (obstacle) {
      require(sign_or_tie(-b));
      if (verdict == Verdict::no) return {};
    }
    const N discriminant = square(b) - a * level_at(w, P);
    require(sign_or_tie(discriminant));  // a tangent flight does not hit
    if (verdict == Verdict::no) return {};
    const N root = sqrt(discriminant);
    time = (obstacle ? -root - b : root - b) / a;
    require(sign_or_tie(time));
    if (verdict == Verdict::no) return {};
  }
  const Verdict piece = on_arc(w, VectorOf<N>{P.x + time * v.x, P.y + time * v.y});
  if (piece == Verdict::no) return {};
  return {piece == Verdict::undecided ? piece : verdict, time};
}

template <class N>
Meeting<N> meets(const WallOf<N>& w, const VectorOf<N>& P, const VectorOf<N>& v,
                 const MotionOf<N>& motion, bool standing) {
  if (w.form != Form::segment) return meets_conic(w, P, v, motion, standing);
  return standing ? Meeting<N>{} : meets_segment(w, P, v);
}

/// The first of several meetings, or the two whose order is undecided.
template <class N, class Key>
class First {
 public:
  /// `passed_by`: keys that are touched and not hit. `last`: meetings after that time are of no
  /// interest; or null.
  explicit First(const std::vector<Key>& passed_by, const N* last = nullptr)
      : passed_by_(passed_by), last_(last) {}
  void offer(const Meeting<N>& m, const Key& key) {
    if (m.verdict == Verdict::no) return;
    if (!passed_by_.empty() &&
        std::find(passed_by_.begin(), passed_by_.end(), key) != passed_by_.end())
      return;
    if (last_ != nullptr && sign(m.time - *last_) == Sign::positive) {
      later_ = true;
      return;
    }
    const Sign order = found_ ? sign(m.time - best_.time) : Sign::negative;
    if (order == Sign::positive) return;
    if (m.verdict == Verdict::yes && order == Sign::negative) {  // what was the first comes later
      found_ = true;
      best_ = m;
      best_key_ = key;
    } else {
      others_.push_back({m, key});
    }
  }
  bool found() const { return found_; }
  /// Was there one after the last time?
  bool later() const { return later_; }
  /// True only if this copy was among the last few that were tested. False answers are harmless:
  /// the copy is tested again.
  bool knows(const Key& key) const {
    if (found_ && best_key_ == key) return true;
    const auto last = others_.size() > 32 ? others_.end() - 32 : others_.begin();
    return std::any_of(last, others_.end(), [&](const Other& other) { return other.key == key; });
  }
  const Key& key() const { return best_key_; }
  const N& time() const { return best_.time; }
  /// One that may come before the first, or null.
  const Key* rival() const {
    for (const Other& other : others_)
      if (!found_ || sign(other.meeting.time - best_.time) != Sign::positive) return &other.key;
    return nullptr;
  }

 private:
  struct Other {
    Meeting<N> meeting;
    Key key;
  };
  const std::vector<Key>& passed_by_;
  const N* last_;
  bool found_ = false, later_ = false;
  Meeting<N> best_;
  Key best_key_{};
  std::vector<Other> others_;  ///< undecided, or not known to come later; seldom any
};

}  // namespace carom::certify
