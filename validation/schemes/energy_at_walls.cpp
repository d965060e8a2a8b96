// What walls inside the steps do to the energy: how much a hit changes it, and how the change grows
// over many hits, with and without magnetic field. Henon-Heiles in a hard circle about a point off
// its centre; the bottom of the potential is where the energy is counted from.
//
//   energy_at_walls [hits]        prints the table of docs/physics/walls-in-steps.md
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "carom/base/random.hpp"
#include "carom/integrators/scheme.hpp"
#include "events/step/barriers_of.hpp"
#include "events/step/crossing_in_step.hpp"
#include "integrators/splitting.hpp"
#include "integrators/spreiter_walter.hpp"

namespace {

using namespace carom;
using geometry::Vector;

struct HenonHeiles : ForceLaw<double> {
  void accelerations(std::span<const Vector> x, std::span<Vector> a) const override {
    a[0] = {-x[0].x - 2.0 * x[0].x * x[0].y, -x[0].y - x[0].x * x[0].x + x[0].y * x[0].y};
  }
  static double potential(Vector x) {
    return 0.5 * dot(x, x) + x.x * x.x * x.y - x.y * x.y * x.y / 3.0;
  }
};

constexpr double energy = 0.25;
constexpr int orbits = 64;

double energy_of(const Phase<double>& p) {
  return HenonHeiles::potential(p.position[0]) + 0.5 * dot(p.velocity[0], p.velocity[0]);
}

struct Statistics {
  double hit = 0.0;  ///< root mean square of the change from one hit to the next
  double mean = 0.0, error = 0.0, spread = 0.0;  ///< of the change after all hits, over the orbits
};

Statistics measure(const Scheme& scheme, double omega, double step, int hits) {
  const HenonHeiles law;
  const std::vector<double> omegas = {omega};
  std::unique_ptr<Stepper<double>> stepper;
  if (scheme.form == Scheme::Form::spreiter_walter)
    stepper = std::make_unique<integrators::SpreiterWalterStepper<double>>(law, omegas);
  else
    stepper = std::make_unique<integrators::SplittingStepper<double>>(scheme, law, omegas);
  const events::Barrier<double> wall =
      events::barriers_of<double>(geometry::Circle{{0.05, 0.03}, 0.5, true}, Vector{}).front();
  double sum = 0.0, squares = 0.0, hit_squares = 0.0;
  for (int orbit = 0; orbit < orbits; ++orbit) {
    RandomStream random(1, Purpose::initial_state, static_cast<std::uint64_t>(orbit));
    Phase<double> p{{{0.6 * (random.uniform() - 0.5), 0.6 * (random.uniform() - 0.5)}}, {Vector{}}};
    Vector direction;
    random.point_in_disc(direction.x, direction.y);
    const double speed = std::sqrt(2.0 * (energy - HenonHeiles::potential(p.position[0])));
    p.velocity[0] = (speed / std::sqrt(dot(direction, direction))) * direction;
    events::StepPath<double> path(*stepper, law, omegas);
    events::CrossingSearch<double> search(path);
    double last = energy_of(p), rest = step;
    const double first = last;
    for (int done = 0; done < hits;) {
      path.begin(p, rest);
      const events::PathHull<double> hull(path.start(), path.end(), 0);
      auto* found =
          stays_off(wall, hull) ? nullptr : search.first(wall, 0, path.start(), path.end());
      if (!found) {
        p = path.end().phase;
        rest = step;
        continue;
      }
      p = found->phase;
      rest -= found->time;
      if (!(rest > 0.0)) rest = step;
      const Vector n = wall.normal(p.position[0]), v = p.velocity[0];
      p.velocity[0] = v - (2.0 * dot(v, n) / dot(n, n)) * n;
      const double now = energy_of(p);
      hit_squares += (now - last) * (now - last);
      last = now;
      ++done;
    }
    const double change = last - first;
    sum += change;
    squares += change * change;
  }
  Statistics s;
  s.hit = std::sqrt(hit_squares / orbits / hits);
  s.mean = sum / orbits;
  s.spread = std::sqrt(squares / orbits);
  s.error = std::sqrt((squares / orbits - s.mean * s.mean) / orbits);
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  const int hits = argc > 1 ? std::atoi(argv[1]) : 4000;
  std::printf(
      "| scheme | omega | step | rms change a hit | hits | mean change | spread "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const char* name :
       {"velocity-verlet", "spreiter-walter", "he-4", "blanes-moan-srkn6b", "blanes-moan-srkn11b"})
    for (const double omega : {0.0, 1.0})
      for (const double step : {0.2, 0.1, 0.05})
        for (const int n : {hits / 16, hits}) {
          const Statistics s = measure(find_scheme(name), omega, step, n);
          std::printf("| %s | %g | %g | %.2g | %d | %.2g +- %.1g | %.2g |\n", name, omega, step,
                      s.hit, n, s.mean, s.error, s.spread);
        }
}
