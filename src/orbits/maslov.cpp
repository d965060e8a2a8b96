#include "orbits/maslov.hpp"

#include <algorithm>
#include <cmath>

namespace carom::orbits {

namespace {

// A neighbour of the orbit: at `distance` to its left, in a direction turned left by `angle`.
struct Neighbour {
  double distance = 0.0, angle = 0.0;
};

Neighbour carried(const AcrossMap& m, const Neighbour& x) {
  return {m.a * x.distance + m.b * x.angle, m.c * x.distance + m.d * x.angle};
}

// How often it meets the orbit within one period, its end included. The distance follows
// y'' + k^2 y = 0 along a flight, so it is reversed by a half-turn, and none is a full turn.
// Reflections leave what meets there alone.
int meetings(const std::vector<FlightAcross>& flights, Neighbour x) {
  int count = 0;
  for (const FlightAcross& flight : flights) {
    bool left = x.distance > 0.0 || (x.distance == 0.0 && x.angle > 0.0);
    if (flight.beyond_half_turn) {
      ++count;
      left = !left;
    }
    x = carried(flight.flown, x);
    if (left ? !(x.distance > 0.0) : !(x.distance < 0.0)) ++count;
    x = carried(flight.reflected, x);
    // Only the direction counts; long products would overflow.
    const double size = std::max(std::abs(x.distance), std::abs(x.angle));
    x = {x.distance / size, x.angle / size};
  }
  return count;
}

AcrossMap product(const std::vector<FlightAcross>& flights) {
  AcrossMap whole;
  for (const FlightAcross& flight : flights) whole = flight.reflected * (flight.flown * whole);
  return whole;
}

// The direction that M stretches.
Neighbour unstable(const AcrossMap& m) {
  const double large = leading_multiplier(m.trace());
  const Neighbour one{m.b, large - m.a}, other{large - m.d, m.c};
  return std::abs(m.b) + std::abs(large - m.a) > std::abs(large - m.d) + std::abs(m.c) ? one
                                                                                       : other;
}

}  // namespace

std::optional<int> maslov_index(const std::vector<FlightAcross>& flights, Stability stability) {
  if (stability == Stability::parabolic) return std::nullopt;
  const int walls = static_cast<int>(flights.size());
  // Half-turns of a direction across the orbit: each reflection is one.
  if (stability == Stability::elliptic) {
    const int half_turns = walls + meetings(flights, {0.0, 1.0});
    return walls + 2 * (half_turns / 2) + 1;
  }
  const int half_turns = walls + meetings(flights, unstable(product(flights)));
  // A direction that comes back as itself has made an even number of them.
  if ((half_turns % 2 == 0) != (stability == Stability::hyperbolic)) return std::nullopt;
  return walls + half_turns;
}

}  // namespace carom::orbits
