// The part of the tangent map of a free particle that stretches: deviations across its orbit, two
// numbers in place of four. docs/physics/lyapunov.md derives them. Templates: lanes carry many
// orbits at once by the same operations.
#pragma once

#include <cmath>

#include "carom/geometry/vector.hpp"
#include "carom/motion/tangent.hpp"

namespace carom {

/// A deviation across an orbit of constant speed, to nearby orbits of the same speed: the part of
/// the displacement to the left of the velocity, and its derivative in time. A shift along the
/// orbit has none of either. Reflections turn both about; that common sign is left out here.
template <class Number>
struct BasicTransverse {
  Number place{}, rate{};
};
using Transverse = BasicTransverse<double>;

/// Of a deviation from a velocity v whose change has no part along v. omega as in Particle.
inline Transverse across(const Deviation& d, const geometry::Vector& v, double omega) {
  const double speed = std::sqrt(dot(v, v));
  return {dot(left(v), d.position) / speed,
          (dot(left(v), d.velocity) + omega * dot(v, d.position)) / speed};
}

/// After a straight flight.
template <class Number>
constexpr BasicTransverse<Number> flown(const BasicTransverse<Number>& w, const Number& duration) {
  return {w.place + duration * w.rate, w.rate};
}
/// A flight along a Larmor circle: place'' = -omega^2 place.
template <class Number>
struct TransverseFlight {
  Number cosine, lever, back;
};
inline TransverseFlight<double> transverse_flight(const FlightTangent& flight, double omega) {
  return {flight.c, flight.a, omega * flight.s};
}
/// The flight that leaves with the velocity v and leads over the displacement d; no sine is needed.
/// `inverse_square`: of the speed.
template <class Number>
constexpr TransverseFlight<Number> flight_over(const geometry::BasicVector<Number>& d,
                                               const geometry::BasicVector<Number>& v,
                                               const Number& inverse_square, const Number& omega) {
  const Number lever = inverse_square * dot(d, v), aside = inverse_square * dot(d, right(v));
  return {1.0 - omega * aside, lever, omega * (omega * lever)};
}
template <class Number>
constexpr BasicTransverse<Number> flown(const BasicTransverse<Number>& w,
                                        const TransverseFlight<Number>& f) {
  return {f.cosine * w.place + f.lever * w.rate, f.cosine * w.rate - f.back * w.place};
}

/// A wall as kicks need it: G = M (x - center) + normal is a normal at x. Of a segment M = 0; of a
/// circle M = 1, of an ellipse it is the matrix of its equation, and normal = 0.
template <class Number>
struct WallForm {
  Number center_x{}, center_y{}, xx{}, xy{}, yy{}, determinant{}, normal_x{}, normal_y{};
};

/// What a reflection adds to the rate, times the place. v: the velocity after the hit at x;
/// `square`: of the speed. The radius of a circle does not matter, nor the side of a wall.
template <class Number>
constexpr Number transverse_kick(const WallForm<Number>& wall,
                                 const geometry::BasicVector<Number>& x,
                                 const geometry::BasicVector<Number>& v, const Number& square,
                                 const Number& omega) {
  const geometry::BasicVector<Number> d{x.x - wall.center_x, x.y - wall.center_y};
  const geometry::BasicVector<Number> g{wall.xx * d.x + wall.xy * d.y + wall.normal_x,
                                        wall.xy * d.x + wall.yy * d.y + wall.normal_y};
  const Number bend = wall.determinant * dot(d, g) / dot(g, g);  // curvature times |g|
  return 2.0 * (square * bend - omega * dot(right(g), v)) / dot(g, v);
}
/// The same of a circle (bent = 1) or a straight wall (bent = 0, its normal), with the same bits.
template <class Number>
constexpr Number kick_of_circle_or_line(const geometry::BasicVector<Number>& center,
                                        const Number& bent,
                                        const geometry::BasicVector<Number>& normal,
                                        const geometry::BasicVector<Number>& x,
                                        const geometry::BasicVector<Number>& v,
                                        const Number& square, const Number& omega) {
  const geometry::BasicVector<Number> g = bent * (x - center) + normal;
  return 2.0 * (square * bent - omega * dot(right(g), v)) / dot(g, v);
}
template <class Number>
constexpr BasicTransverse<Number> reflected(const BasicTransverse<Number>& w, const Number& kick) {
  return {w.place, w.rate + kick * w.place};
}

}  // namespace carom
