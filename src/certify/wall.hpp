// A wall in any arithmetic, and the straight flight to it.
#pragma once

#include "carom/geometry/vector.hpp"
#include "certify/interval.hpp"

namespace carom::certify {

template <class Number>
using VectorOf = geometry::BasicVector<Number>;
using BallVector = VectorOf<Ball>;

enum class Form : unsigned char { segment, circle, ellipse };

/// A wall with everything that flights ask of it. An ellipse is a circle in the frame of its axes:
/// X = (along . (P - centre), across . (P - centre)) has length 1 on it.
template <class Number>
struct WallOf {
  Form form = Form::segment;
  bool closed = false;       ///< a full circle or ellipse, without joints
  double turn = 1.0;         ///< +1 counter-clockwise (the domain is inside), -1 clockwise
  VectorOf<Number> from, to;
  VectorOf<Number> chord;    ///< to - from
  VectorOf<Number> normal;   ///< segment: left(chord)
  Number double_inverse{};   ///< segment: 2/(normal . normal); circle: 2/radius^2
  VectorOf<Number> centre;
  Number radius2{};          ///< circle: radius^2
  VectorOf<Number> along, across;  ///< ellipse: axes over squared semi-axes
};

/// The same wall in another arithmetic.
template <class To, class From, class Convert>
WallOf<To> converted(const WallOf<From>& w, const Convert& convert) {
  const auto vector = [&](const VectorOf<From>& v) { return VectorOf<To>{convert(v.x), convert(v.y)}; };
  WallOf<To> r;
  r.form = w.form;
  r.closed = w.closed;
  r.turn = w.turn;
  r.from = vector(w.from);
  r.to = vector(w.to);
  r.chord = vector(w.chord);
  r.normal = vector(w.normal);
  r.double_inverse = convert(w.double_inverse);
  r.centre = vector(w.centre);
  r.radius2 = convert(w.radius2);
  r.along = vector(w.along);
  r.across = vector(w.across);
  return r;
}

/// Across a wall at a point of it, of any length: outwards from a circle or ellipse (a segment has one normal).
template <class Number, class Constant>
VectorOf<Number> normal_at(const WallOf<Constant>& w, const VectorOf<Number>& P) {
  const VectorOf<Number> e{P.x - w.centre.x, P.y - w.centre.y};
  if (w.form == Form::circle) return e;
  const Number X = e.x * w.along.x + e.y * w.along.y, Y = e.x * w.across.x + e.y * w.across.y;
  return {X * w.along.x + Y * w.across.x, X * w.along.y + Y * w.across.y};
}

/// What does not change along an orbit.
template <class Number>
struct MotionOf {
  Number speed2{};         ///< |v|^2
  Number inverse_speed2{};
  bool turns = false;      ///< in a magnetic field:
  Number half_omega{};     ///< omega/2; the velocity turns clockwise by omega t
  long time_bits = 64;     ///< precision of the time from the arctangent
};

/// Where a flight meets a wall, and the velocity after it.
template <class Number>
struct LandingOf {
  Number time{};
  VectorOf<Number> position, velocity;
};

}  // namespace carom::certify
