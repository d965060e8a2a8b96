#include "reference.hpp"

#include <algorithm>
#include <cmath>

namespace resolution {
namespace {

template <class Real>
Real distance(const State<Real>& a, const State<Real>& b) {
  const Real x = a.x - b.x, y = a.y - b.y, vx = a.vx - b.vx, vy = a.vy - b.vy;
  return root(x * x + y * y + vx * vx + vy * vy);
}

constexpr long most_steps = 3000;      // of the reference
constexpr long double apart = 1e-10L;  // nearby orbits, at the start

struct Growth {
  double t_end = 0.0, growth = 1.0;
  State<long double> end = {};
};

// Compares with two nearby orbits at `count` times. Without one good time, the caller takes shorter
// ones.
Growth stable_time(const System& system, double limit, double longest, int count) {
  Growth found;
  Orbit<long double> orbit(system, quick_accuracy), first(system, quick_accuracy),
      second(system, quick_accuracy);
  const long double r = apart / 2;
  first.state = {orbit.state.x + r, orbit.state.y - r, orbit.state.vx - r, orbit.state.vy + r};
  second.state = {orbit.state.x + r, orbit.state.y + r, orbit.state.vx + r, orbit.state.vy + r};
  double largest = 1.0;
  try {
    for (int i = 1; i <= count && orbit.steps < most_steps; ++i) {
      // Rounded, so that the file shows a short number.
      const auto t = static_cast<double>(static_cast<float>(longest * i / count));
      orbit.advance(t);
      first.advance(t);
      second.advance(t);
      for (const auto* near : {&first, &second})
        largest =
            std::max(largest, static_cast<double>(distance(orbit.state, near->state) / apart));
      if (largest > limit) break;
      found = {t, largest, orbit.state};
    }
  } catch (const Undecided&) {  // the orbit until then is good
  }
  return found;
}

}  // namespace

Reference reference_orbit(const System& system, double growth) {
  double longest = system.longest_time;
  Growth stable = stable_time(system, growth, longest, 200);
  while (stable.t_end == 0.0 && longest > 1e-6) {
    longest /= 200;
    stable = stable_time(system, growth, longest, 200);
  }
  Reference result;
  result.t_end = stable.t_end;
  result.growth = stable.growth;
  Orbit<Quad> orbit(system, quad_accuracy);
  const Quad before = orbit.energy();
  orbit.advance(stable.t_end);
  result.end = orbit.state;
  result.steps = orbit.steps;
  result.hits = orbit.hits;
  result.fastest = static_cast<double>(orbit.fastest);
  const Quad largest_kinetic = std::max(Quad(0.5), orbit.fastest * orbit.fastest / 2);
  result.energy_change = static_cast<double>(size(orbit.energy() - before) / largest_kinetic);
  const State<Quad> quick = {stable.end.x, stable.end.y, stable.end.vx, stable.end.vy};
  result.quick_distance = static_cast<double>(distance(orbit.state, quick));
  return result;
}

SelfTest self_test(const System& system, const Reference& reference) {
  SelfTest result;
  Orbit<Quad> finer(system, finer_accuracy);
  finer.advance(reference.t_end);
  result.finer = static_cast<double>(distance(finer.state, reference.end));

  Orbit<Quad> back(system, quad_accuracy);
  const State<Quad> start = back.state;
  back.advance(reference.t_end);
  back.turn_back();
  back.advance(reference.t_end);
  back.turn_back();
  result.reversed = static_cast<double>(distance(back.state, start));

  // At the start, the end and between: the force series' first coefficient against central
  // differences of order 8.
  const auto forces = forces_of<Quad>(system);
  const Quad h = Quad(system.scale) / 1000;
  const Quad weights[4] = {Quad(4) / 5, -Quad(1) / 5, Quad(4) / 105, -Quad(1) / 280};
  for (const Quad share : {Quad(0), Quad(0.3), Quad(0.7), Quad(1)}) {
    const Quad px = start.x + share * (reference.end.x - start.x),
               py = start.y + share * (reference.end.y - start.y);
    for (const auto& force : forces) {
      Series<Quad> x{}, y{}, ax{}, ay{};
      x[0] = px;
      y[0] = py;
      force->begin(px, py, Quad(system.scale));
      force->extend(0, x, y, ax, ay);
      Quad dx = 0, dy = 0, largest = 1;
      for (int k = 1; k <= 4; ++k) {
        const Quad d = Quad(k) * h;
        dx += weights[k - 1] * (force->potential(px + d, py) - force->potential(px - d, py)) / h;
        dy += weights[k - 1] * (force->potential(px, py + d) - force->potential(px, py - d)) / h;
        largest = std::max(largest, size(force->potential(px + d, py)) / Quad(system.scale));
      }
      const Quad wrong = std::max(size(dx + ax[0]), size(dy + ay[0])) / largest;
      result.force = std::max(result.force, static_cast<double>(wrong));
    }
  }
  return result;
}

}  // namespace resolution
