#include "orbits/newton.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "carom/motion/tangent.hpp"

namespace carom::orbits {

using geometry::Vector;

namespace {

// The first hit of a flight, as reported.
class FirstHit : public Observer {
 public:
  void hit(const HitEvent& event) override {
    if (!met) hit_ = event, met = true;
  }
  const HitEvent& event() const { return hit_; }
  bool met = false;

 private:
  HitEvent hit_;
};

State start_of(const OrbitHit& hit, double speed) {
  State state;
  state.wall = hit.wall;
  state.u = hit.u;
  state.position = hit.position;
  // One Newton step: |v| is the speed to rounding.
  const Vector v = (1.0 / speed) * hit.velocity;
  state.velocity = speed * ((1.5 - 0.5 * dot(v, v)) * v);
  return state;
}

// How far from the next hit the engine's may lie along the wall. An estimate, to first order and
// doubled; `--certify` proves. Errors are those of the unknowns and of rounding:
// - A place errs by its unknown's error; points of both, which are compared, by 12 u D each
//   (chain.hpp (1)).
// - The direction errs by two places over the chord, by the half-turn's error, and by rounding:
//   difference, root and quotients 4 u, sine and cosine 2 u, the rotation 3 u (chain.hpp (1));
//   times the speed, over it, times the factor that sets the speed and the speed again 4 u; the
//   world sets the speed once more, 2 u. That is 15 u; the points' roundings are in the places.
// The engine's own rounding is that of a start displaced by a few u D: it is left to the doubling.
double allowed(const Boundary& boundary, const Solution& solution, std::size_t i) {
  const ChainGeometry& g = solution.geometry;
  const ChainFlight& flight = g.flights[i];
  const WallPoint& end = g.points[(i + 1) % g.points.size()];
  const double speed = boundary.particle.speed, omega = boundary.particle.omega;
  const double duration =
      omega == 0.0 ? flight.chord / speed : 2.0 * solution.chain[i].half_turn / std::abs(omega);
  const Deviation arc = at_wall(end.normal, speed * flight.arrival, omega).arc;
  const Deviation before = flight_tangent(omega, duration).before(arc);
  const double place = solution.error + 24.0 * unit_roundoff * boundary.size;
  const double direction = 2.0 * place / flight.chord + solution.error + 16.0 * unit_roundoff;
  const auto norm = [](Vector v) { return std::sqrt(dot(v, v)); };
  return 2.0 * (norm(before.position) * place + norm(before.velocity) * speed * direction + place);
}

}  // namespace

bool confirmed(const Boundary& boundary, World& world, const Solution& solution,
               const PeriodicOrbit& orbit) {
  const std::size_t n = orbit.hits.size();
  world.limit_hits(1);
  for (std::size_t i = 0; i < n; ++i) {
    const OrbitHit &from = orbit.hits[i], &to = orbit.hits[(i + 1) % n];
    world.clear();
    FirstHit first;
    try {
      world.add(boundary.particle, start_of(from, boundary.particle.speed));
    } catch (const std::invalid_argument&) {
      return false;  // it leaves along the wall, or out of the domain
    }
    world.run_until(std::numeric_limits<double>::max(), first);
    if (!first.met) return false;
    const HitEvent& hit = first.event();
    const auto curve = [&](int wall) { return boundary.curves[static_cast<std::size_t>(wall)]; };
    if (curve(hit.wall) != curve(to.wall) || hit.cell != from.step || hit.reflections != 1)
      return false;
    const Vector miss = hit.position - to.position;
    if (!(std::sqrt(dot(miss, miss)) <= allowed(boundary, solution, i))) return false;
  }
  return true;
}

}  // namespace carom::orbits
