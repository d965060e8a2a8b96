// Tangent maps: how small deviations of a state are carried along by flights and reflections.
// docs/physics/tangent-map.md derives them.
#pragma once

#include "carom/geometry/vector.hpp"

namespace carom {

/// The difference of a nearby orbit from a reference orbit at the same time, to first order. Also a
/// linear functional of such a difference, by its coefficients.
struct Deviation {
  geometry::Vector position, velocity;

  friend constexpr Deviation operator+(const Deviation& a, const Deviation& b) {
    return {a.position + b.position, a.velocity + b.velocity};
  }
  friend constexpr Deviation operator*(double s, const Deviation& a) {
    return {s * a.position, s * a.velocity};
  }
  friend constexpr double dot(const Deviation& a, const Deviation& b) {
    return dot(a.position, b.position) + dot(a.velocity, b.velocity);
  }
};

/// A straight or Larmor flight: x' = x + (a + b J) v, v' = (c + s J) v, J the quarter turn
/// clockwise.
struct FlightTangent {
  double a = 0.0, b = 0.0, c = 1.0, s = 0.0;

  constexpr Deviation operator()(const Deviation& d) const {
    const geometry::Vector v = d.velocity, j = right(v);
    return {d.position + a * v + b * j, c * v + s * j};
  }
  /// The functional of the deviation before the flight that has the value of g after it.
  constexpr Deviation before(const Deviation& g) const {
    const geometry::Vector p = g.position, q = g.velocity;
    return {p, a * p + b * left(p) + c * q + s * left(q)};
  }
};
FlightTangent flight_tangent(double omega, double duration);

/// An elastic reflection: x' = S x, v' = S v + (kick . x) turned, S the reflection by the wall's
/// tangent. Of a nearby orbit at the same time, which has not reached the wall yet or has left it
/// already: its delay is part of the map.
struct ReflectionTangent {
  geometry::Vector normal;  ///< unit
  geometry::Vector kick, turned;

  constexpr geometry::Vector mirrored(const geometry::Vector& x) const {
    return x - (2.0 * dot(normal, x)) * normal;
  }
  constexpr Deviation operator()(const Deviation& d) const {
    return {mirrored(d.position), mirrored(d.velocity) + dot(kick, d.position) * turned};
  }
};
/// `normal`: unit, into the domain; `curvature`: positive where the wall turns towards the domain;
/// v: the velocity before.
constexpr ReflectionTangent reflection_tangent(const geometry::Vector& normal, double curvature,
                                               const geometry::Vector& v, double omega) {
  const geometry::Vector tangent = right(normal);
  const double delay = -1.0 / dot(normal, v);  // of a deviation along the normal
  ReflectionTangent map;
  map.normal = normal;
  map.kick = 2.0 * (curvature * tangent + ((curvature * dot(tangent, v) + omega) * delay) * normal);
  map.turned = left(map.mirrored(v));
  return map;
}

/// An elastic contact of two smooth discs, as a map of the deviations of both. Of nearby orbits at
/// the same time, as that of a reflection.
struct ContactTangent {
  geometry::Vector separation;  ///< from the second's centre to the first's
  geometry::Vector approach;    ///< of the velocities before, first - second
  geometry::Vector bend;        ///< of the accelerations by the field before, first - second
  geometry::Vector push;        ///< first_share of it changes the first's velocity
  double first_share = 0.5, second_share = -0.5;
  double first_omega = 0.0, second_omega = 0.0;

  constexpr void operator()(Deviation& first, Deviation& second) const {
    const geometry::Vector& d = separation;
    const double rate = dot(d, approach);
    const geometry::Vector apart = first.position - second.position;
    const double delay = -dot(d, apart) / rate;
    // As they are at the contact of the nearby orbit.
    const geometry::Vector turned = apart + delay * approach,
                           faster = first.velocity - second.velocity + delay * bend;
    const geometry::Vector change =
        (-2.0 / dot(d, d)) * ((dot(d, faster) + dot(turned, approach)) * d + rate * turned);
    const auto carry = [&](Deviation& one, double share, double omega) {
      one.position = one.position - (share * delay) * push;
      one.velocity = one.velocity + share * (change - (omega * delay) * right(push));
    };
    carry(first, first_share, first_omega);
    carry(second, second_share, second_omega);
  }
};
/// Velocities are those before.
constexpr ContactTangent contact_tangent(const geometry::Vector& separation,
                                         const geometry::Vector& first,
                                         const geometry::Vector& second, double first_mass,
                                         double second_mass, double first_omega,
                                         double second_omega) {
  ContactTangent map;
  map.separation = separation;
  map.approach = first - second;
  map.bend = first_omega * right(first) - second_omega * right(second);
  map.push = (-2.0 * dot(separation, map.approach) / dot(separation, separation)) * separation;
  map.first_share = second_mass / (first_mass + second_mass);
  map.second_share = -first_mass / (first_mass + second_mass);
  map.first_omega = first_omega;
  map.second_omega = second_omega;
  return map;
}

/// A deviation as it is seen at the wall, where the nearby orbit hits it earlier or later:
/// functionals of a deviation from the velocity v that the reference has there, before or after the
/// reflection.
struct AtWall {
  Deviation arc;    ///< along the wall
  Deviation delay;  ///< of the hit
  Deviation angle;  ///< of the velocity at the hit, counter-clockwise, in radians
};
constexpr AtWall at_wall(const geometry::Vector& normal, const geometry::Vector& v, double omega) {
  const geometry::Vector tangent = right(normal);
  const geometry::Vector delay = (-1.0 / dot(normal, v)) * normal;
  return {{tangent + dot(tangent, v) * delay, {}},
          {delay, {}},
          {-omega * delay, (1.0 / dot(v, v)) * left(v)}};
}

}  // namespace carom
