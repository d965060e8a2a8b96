// The orbit x = 0 of the Hénon–Heiles potential: its period and stability are elliptic integrals.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

using geometry::Vector;

struct LineOrbit {
  double energy, period, trace;
};
const LineOrbit line_orbits[] = {{1.0 / 12.0, 6.9016436153392559825, 1.322086765878},
                                 {1.0 / 8.0, 7.5432594126750786126, -1.08694434649}};

struct Crossings : Observer {
  std::vector<double> up, down;
  void crossing(int, Time time, const State& state, int direction) override {
    (direction > 0 ? up : down).push_back(time.value());
    where.push_back(state);
  }
  std::vector<State> where;
};

Dynamics with(const System& system, const char* scheme, double step, double tolerance) {
  Dynamics d = system.dynamics;
  d.integrator.scheme = scheme;
  d.integrator.step = step;
  d.integrator.tolerance = tolerance;
  return d;
}

State at_origin(double energy) {
  State s;
  s.velocity = {0.0, std::sqrt(2.0 * energy)};
  return s;
}

State end_of(const System& system, const Dynamics& dynamics, const State& start, double time) {
  World world(*system.table, dynamics);
  world.add(system.particles[0], start);
  Observer silent;
  world.run_until(time, silent);
  EXPECT_EQ(world.fate(0), Fate::survived) << world.report(0);
  return world.state_at(0, Time(time));
}

// Crossings of y = 0 and of v_y = 0 come back after the period, with fixed steps and adaptive ones.
TEST(HenonHeiles, LineOrbitHasItsPeriod) {
  const LoadedSystem loaded = load_system("henon-heiles");
  const System& system = loaded.system;
  for (const LineOrbit& orbit : line_orbits) {
    for (const Dynamics& dynamics :
         {with(system, "", 0.02, 0.0), with(system, "kahan-li-8", 0.05, 0.0),
          with(system, "arkode", 0.0, 1e-13)}) {
      for (const auto kind : {Surface::Kind::position_y, Surface::Kind::velocity_y}) {
        Surface surface;
        surface.kind = kind;
        World world(*system.table, dynamics);
        world.add(system.particles[0], at_origin(orbit.energy));
        world.watch(&surface);
        Crossings seen;
        world.run_until(25.0, seen);
        for (const std::vector<double>& times : {seen.up, seen.down}) {
          ASSERT_GE(times.size(), 3u);
          for (std::size_t i = 1; i < times.size(); ++i)
            EXPECT_NEAR((times[i] - times[i - 1]) / orbit.period, 1.0, 1e-12)
                << dynamics.integrator.scheme;
        }
        for (const State& s : seen.where) {
          EXPECT_EQ(s.position.x, 0.0);
          const double energy =
              energy_of({system.particles.data(), 1}, {&s, 1}, dynamics, *system.table).total();
          EXPECT_NEAR(energy, orbit.energy, 1e-13);
        }
      }
    }
  }
}

// Trace of the transverse part of the monodromy matrix: orbits at x = d and v_x = d followed for
// one period. Their mirror images are orbits, too, so that x(T)/d is a central difference; its
// errors of d^2 and d^4 are taken away with d, d/2 and d/4 (Richardson).
TEST(HenonHeiles, LineOrbitHasItsTrace) {
  const LoadedSystem loaded = load_system("henon-heiles");
  const System& system = loaded.system;
  for (const LineOrbit& orbit : line_orbits) {
    for (const Dynamics& dynamics :
         {with(system, "", 0.02, 0.0), with(system, "arkode", 0.0, 1e-14)}) {
      double estimate[3];
      for (int level = 0; level < 3; ++level) {
        const double d = 0x1p-8 / (1 << level);
        State shifted = at_origin(orbit.energy), turned = shifted;
        shifted.position.x = d;
        turned.velocity.x = d;
        estimate[level] = (end_of(system, dynamics, shifted, orbit.period).position.x +
                           end_of(system, dynamics, turned, orbit.period).velocity.x) /
                          d;
      }
      const double once = (4.0 * estimate[1] - estimate[0]) / 3.0,
                   more = (4.0 * estimate[2] - estimate[1]) / 3.0;
      const double trace = (16.0 * more - once) / 15.0;
      EXPECT_NEAR(trace, orbit.trace, 1e-11) << orbit.energy << " " << dynamics.integrator.scheme;
    }
  }
}

}  // namespace
}  // namespace carom
