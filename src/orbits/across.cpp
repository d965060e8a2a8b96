#include "orbits/across.hpp"

#include <cmath>
#include <limits>

#include "carom/motion/tangent.hpp"

namespace carom::orbits {

using geometry::Vector;

namespace {

AcrossMap absolute(const AcrossMap& m) {
  return {std::abs(m.a), std::abs(m.b), std::abs(m.c), std::abs(m.d)};
}

// Deviations across an orbit of direction `from` (unit), carried by `map` to one of direction
// `to`: what lies along the flow there is taken off.
AcrossMap across(const auto& map, Vector from, Vector to, double speed, double omega) {
  const auto seen = [&](const Deviation& before) {
    Deviation after = map(before);
    const double along = dot(to, after.position) / speed;
    after = after + (-along) * Deviation{speed * to, (omega * speed) * right(to)};
    return Vector{dot(left(to), after.position), dot(left(to), after.velocity) / speed};
  };
  const Vector distance = seen({left(from), {}});
  const Vector angle = seen({{}, speed * left(from)});
  return {distance.x, angle.x, distance.y, angle.y};
}

FlightAcross flight_across(const Boundary& boundary, const Chain& chain, const ChainGeometry& g,
                           std::size_t i) {
  const double speed = boundary.particle.speed, omega = boundary.particle.omega;
  const ChainFlight& flight = g.flights[i];
  const WallPoint& wall = g.points[(i + 1) % chain.size()];
  const ReflectionTangent reflection =
      reflection_tangent(wall.normal, wall.curvature, speed * flight.arrival, omega);
  FlightAcross out;
  out.flown = across(flight_tangent(omega, duration_of(boundary, chain[i], flight)),
                     flight.departure, flight.arrival, speed, omega);
  out.reflected =
      across(reflection, flight.arrival, reflection.mirrored(flight.arrival), speed, omega);
  out.beyond_half_turn = omega != 0.0 && flight.cosine < 0.0;
  return out;
}

}  // namespace

double duration_of(const Boundary& boundary, const Link& link, const ChainFlight& flight) {
  const Particle& p = boundary.particle;
  return p.omega == 0.0 ? flight.chord / p.speed : 2.0 * link.half_turn / std::abs(p.omega);
}

std::vector<FlightAcross> flights_across(const Boundary& boundary, const Chain& chain,
                                         const ChainGeometry& g) {
  std::vector<FlightAcross> all;
  for (std::size_t i = 0; i < chain.size(); ++i)
    all.push_back(flight_across(boundary, chain, g, i));
  return all;
}

AcrossMap tangent_map(const Boundary& boundary, const Chain& chain, const ChainGeometry& g,
                      std::size_t flights, AcrossMap* sizes) {
  AcrossMap whole;
  if (sizes) *sizes = {};
  for (std::size_t i = 0; i < flights; ++i) {
    const FlightAcross one = flight_across(boundary, chain, g, i % chain.size());
    whole = one.reflected * (one.flown * whole);
    if (sizes) *sizes = absolute(one.reflected) * (absolute(one.flown) * *sizes);
  }
  return whole;
}

double leading_multiplier(double trace) {
  const double square = 0.25 * trace * trace - 1.0;
  if (square < 0.0) return std::numeric_limits<double>::quiet_NaN();
  const double root = std::sqrt(square);
  return trace < 0.0 ? 0.5 * trace - root : 0.5 * trace + root;
}

}  // namespace carom::orbits
