// A wall in any arithmetic.
#pragma once

#include "carom/geometry/vector.hpp"
#include "certify/number/interval.hpp"

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
  bool closed = false;  ///< a full circle or ellipse, without joints
  double turn = 1.0;    ///< +1 counter-clockwise (the domain is inside), -1 clockwise
  VectorOf<Number> from, to;
  VectorOf<Number> chord;   ///< to - from
  VectorOf<Number> normal;  ///< segment: left(chord)
  Number double_inverse{};  ///< segment: 2/(normal . normal); circle: 2/radius^2
  VectorOf<Number> centre;
  Number radius2{};                ///< circle: radius^2
  VectorOf<Number> along, across;  ///< ellipse: axes over squared semi-axes
};

/// The same wall in another arithmetic.
template <class To, class From, class Convert>
WallOf<To> converted(const WallOf<From>& w, const Convert& convert) {
  const auto vector = [&](const VectorOf<From>& v) {
    return VectorOf<To>{convert(v.x), convert(v.y)};
  };
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

template <class N>
WallOf<N> segment_wall(const VectorOf<N>& from, const VectorOf<N>& to) {
  WallOf<N> w;
  w.from = from;
  w.to = to;
  w.chord = to - from;
  w.normal = left(w.chord);
  w.double_inverse = N(2) / dot(w.chord, w.chord);
  return w;
}

template <class N>
WallOf<N> arc_wall(const VectorOf<N>& from, const VectorOf<N>& to, const VectorOf<N>& centre,
                   const N& radius2, bool counterclockwise) {
  WallOf<N> w;
  w.form = Form::circle;
  w.turn = counterclockwise ? 1.0 : -1.0;
  w.from = from;
  w.to = to;
  w.chord = to - from;
  w.centre = centre;
  w.radius2 = radius2;
  w.double_inverse = N(2) / radius2;
  return w;
}

template <class N>
WallOf<N> circle_wall(const VectorOf<N>& centre, const N& radius, bool counterclockwise) {
  const VectorOf<N> start{centre.x + radius, centre.y};
  WallOf<N> w = arc_wall(start, start, centre, square(radius), counterclockwise);
  w.closed = true;
  return w;
}

/// `axis`: the semi-axis a as a vector; the other one is ratio left(axis).
template <class N>
WallOf<N> ellipse_wall(const VectorOf<N>& centre, const VectorOf<N>& axis, const N& ratio,
                       bool counterclockwise) {
  WallOf<N> w;
  w.form = Form::ellipse;
  w.closed = true;
  w.turn = counterclockwise ? 1.0 : -1.0;
  w.from = w.to = centre + axis;
  w.centre = centre;
  // (P - C) . axis/a^2 is the coordinate in units of a; across: the other axis is ratio left(axis).
  const N a2 = dot(axis, axis);
  w.along = {axis.x / a2, axis.y / a2};
  const N scale = N(1) / (ratio * a2);
  w.across = {-(scale * axis.y), scale * axis.x};
  return w;
}

/// An arc of such an ellipse.
template <class N>
WallOf<N> elliptic_arc_wall(const VectorOf<N>& from, const VectorOf<N>& to,
                            const VectorOf<N>& centre, const VectorOf<N>& axis, const N& ratio,
                            bool counterclockwise) {
  WallOf<N> w = ellipse_wall(centre, axis, ratio, counterclockwise);
  w.closed = false;
  w.from = from;
  w.to = to;
  w.chord = to - from;
  return w;
}

/// A vector in the frame where an ellipse is the unit circle; beside other walls the vector itself.
template <class Number>
VectorOf<Number> in_round_frame(const WallOf<Number>& w, const VectorOf<Number>& d) {
  return w.form == Form::ellipse ? VectorOf<Number>{dot(d, w.along), dot(d, w.across)} : d;
}

/// Zero on the wall's line, circle or ellipse, positive on the left of the line and outside of the
/// others.
template <class Number>
Number level_at(const WallOf<Number>& w, const VectorOf<Number>& P) {
  if (w.form == Form::segment) return dot(P - w.from, w.normal);
  const VectorOf<Number> e = in_round_frame(w, P - w.centre);
  return (square(e.x) + square(e.y)) - (w.form == Form::ellipse ? Number(1) : w.radius2);
}

/// Across a wall at a point of it, of any length: outwards from a circle or ellipse (a segment has
/// one normal).
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
  Number speed2{};  ///< |v|^2
  Number inverse_speed2{};
  bool turns = false;   ///< in a magnetic field:
  Number half_omega{};  ///< omega/2; the velocity turns clockwise by omega t
  long time_bits = 64;  ///< precision of the time from the arctangent
};

/// Where a flight meets a wall, and the velocity after it.
template <class Number>
struct LandingOf {
  Number time{};
  VectorOf<Number> position, velocity;
};

}  // namespace carom::certify
