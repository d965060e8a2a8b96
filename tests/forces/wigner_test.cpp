// Coulomb particles in a harmonic well, E = sum r^2 + sum 1/r: ground states and small
// oscillations.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "carom/base/random.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

using geometry::Vector;
using Positions = std::vector<Vector>;

LoadedSystem molecule(int count) {
  SystemOverrides set;
  set.set = {{"particles.count", std::to_string(count)}, {"particles.energy", "100"}};
  return load_system("wigner", set);
}

/// Potential energy and the forces, from the field that moves particles.
double energy_and_forces(const System& system, const Positions& x, Positions& force) {
  const ForceField& field = *system.dynamics.forces;
  double energy = 0.0;
  force.assign(x.size(), Vector{});
  for (std::size_t i = 0; i < x.size(); ++i)
    energy += field.add_external(system.particles[i], x[i], force[i]);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = i + 1; j < x.size(); ++j) {
      Vector pair{};
      energy += field.add_pair(system.particles[i], system.particles[j], x[i] - x[j], pair);
      force[i] = force[i] + pair;
      force[j] = force[j] - pair;
    }
  return energy;
}

double power(const Positions& a, const Positions& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

/// Cools by FIRE (Bitzek et al. 2006): the particles move under their forces and stop wherever they
/// would climb. Returns the size of the force that is left.
double cool(const System& system, Positions& x, double& energy) {
  Positions v(x.size()), force;
  double step = 0.02, mixing = 0.1, left = 0.0;
  int downhill = 0;
  for (int i = 0; i < 20000; ++i) {
    energy = energy_and_forces(system, x, force);
    const double f = std::sqrt(power(force, force)), speed = std::sqrt(power(v, v));
    left = f;
    if (f < 1e-12) break;
    if (power(force, v) > 0.0) {
      for (std::size_t k = 0; k < x.size(); ++k)
        v[k] = (1.0 - mixing) * v[k] + (mixing * speed / f) * force[k];
      if (++downhill > 5) {
        step = std::fmin(1.1 * step, 0.2);
        mixing *= 0.99;
      }
    } else {
      v.assign(x.size(), Vector{});
      step *= 0.5;
      mixing = 0.1;
      downhill = 0;
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
      v[k] = v[k] + step * force[k];
      x[k] = x[k] + step * v[k];
    }
  }
  return left;
}

/// The lowest of several minima.
Positions ground_state(const System& system, double& lowest) {
  Positions best;
  lowest = 1e300;
  for (std::uint64_t start = 0; start < 6; ++start) {
    RandomStream random(1, Purpose::initial_state, start, 0);
    Positions x(system.particles.size());
    for (Vector& r : x) r = {random.uniform() - 0.5, random.uniform() - 0.5};
    double energy = 0.0;
    const double force = cool(system, x, energy);
    EXPECT_LT(force, 1e-9);
    if (energy < lowest) best = x;
    lowest = std::fmin(lowest, energy);
  }
  return best;
}

TEST(Wigner, GroundStatesHaveTheirEnergies) {
  const std::pair<int, double> known[] = {
      {2, 0.75}, {3, 1.3103706971}, {4, 1.8354456111}, {5, 2.3384453805}};
  for (const auto& [count, each] : known) {
    const LoadedSystem loaded = molecule(count);
    double energy = 0.0;
    ground_state(loaded.system, energy);
    EXPECT_NEAR(energy / count, each, 6e-11) << count;
  }
}

// In a minimum every W of degree -1 and V of degree 2 obey W = 2 V (virial theorem).
TEST(Wigner, VirialTheoremHolds) {
  for (int count = 2; count <= 12; ++count) {
    const LoadedSystem loaded = molecule(count);
    double energy = 0.0;
    const Positions x = ground_state(loaded.system, energy);
    const double external = power(x, x);
    EXPECT_NEAR((energy - external) / (2.0 * external), 1.0, 1e-11) << count;
  }
}

struct Samples : Observer {
  std::vector<Positions> x;
  Positions now;
  void sample(int, Time, const State& s) override { now.push_back(s.position); }
  bool sampled(Time) override {
    x.push_back(now);
    now.clear();
    return true;
  }
};

/// Frequency of an oscillation about `rest` from its zeros on the way up, each from the cubic
/// through the four samples around it.
double frequency(const std::vector<double>& y, double rest, double interval) {
  std::vector<double> zeros;
  for (std::size_t i = 2; i + 1 < y.size(); ++i) {
    const double a = y[i - 1] - rest, b = y[i] - rest;
    if (!(a <= 0.0 && b > 0.0)) continue;
    const double p = y[i - 2] - rest, q = y[i + 1] - rest;
    double s = a / (a - b);
    for (int k = 0; k < 20; ++k) {
      const auto cubic = [&](double t) {
        return -p * t * (t - 1.0) * (t - 2.0) / 6.0 + a * (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0 -
               b * (t + 1.0) * t * (t - 2.0) / 2.0 + q * (t + 1.0) * t * (t - 1.0) / 6.0;
      };
      const double slope = (cubic(s + 1e-4) - cubic(s - 1e-4)) / 2e-4;
      s -= cubic(s) / slope;
    }
    zeros.push_back((static_cast<double>(i - 1) + s) * interval);
  }
  EXPECT_GE(zeros.size(), 3u);
  return 2.0 * std::numbers::pi * static_cast<double>(zeros.size() - 1) /
         (zeros.back() - zeros.front());
}

std::vector<Positions> follow(const System& system, const Positions& x, const Positions& v,
                              double time, double interval) {
  World world(*system.table, system.dynamics);
  for (std::size_t i = 0; i < x.size(); ++i) {
    State s;
    s.position = x[i];
    s.velocity = v[i];
    world.add(system.particles[i], s);
  }
  world.sample_every(interval);
  Samples samples;
  world.run_until(time, samples);
  for (int i = 0; i < world.size(); ++i)
    EXPECT_EQ(world.fate(i), Fate::survived) << world.report(i);
  return samples.x;
}

TEST(Wigner, BreathesAtRootThreeOmega) {
  constexpr double interval = 0.02, amplitude = 1e-4;
  const double omega = std::numbers::sqrt2;
  for (int count = 2; count <= 5; ++count) {
    const LoadedSystem loaded = molecule(count);
    double energy = 0.0;
    const Positions x = ground_state(loaded.system, energy);
    Positions v = x;
    for (Vector& u : v) u = amplitude * u;
    std::vector<double> size;
    for (const Positions& p : follow(loaded.system, x, v, 30.0, interval))
      size.push_back(power(p, p));
    // Beyond the first order in the amplitude, 1e-4, the size swings by its square.
    const double measured = frequency(size, power(x, x), interval);
    EXPECT_NEAR(measured / (std::numbers::sqrt3 * omega), 1.0, 1e-7) << count;
  }
}

// Kohn's theorem: the centre of mass swings at omega for any amplitude and any motion of the
// others, and with a magnetic field as a single particle does.
TEST(Wigner, CentreOfMassMovesAlone) {
  const double omega = std::numbers::sqrt2;
  for (const double field : {0.0, 0.7}) {
    SystemOverrides set;
    set.set = {{"particles.energy", "100"}, {"field.B", std::to_string(field)}};
    const LoadedSystem loaded = load_system("wigner", set);
    const System& system = loaded.system;
    const Positions x = {{1.0, 0.1}, {-0.8, 0.9}, {0.2, -1.1}, {-0.5, -0.4}, {0.6, 1.0}};
    const Positions v = {{0.3, 0.1}, {-0.2, 0.5}, {0.7, -0.4}, {0.1, 0.2}, {0.4, -0.1}};
    const auto centre = [](const Positions& p) {
      Vector sum{};
      for (const Vector& r : p) sum = sum + r;
      return (1.0 / static_cast<double>(p.size())) * sum;
    };
    // z'' = -i w z' - omega^2 z: z = a exp(-i f t) + b exp(i g t), f, g = sqrt(omega^2 + w^2/4) +-
    // w/2.
    const double root = std::sqrt(omega * omega + 0.25 * field * field), f = root + 0.5 * field,
                 g = root - 0.5 * field;
    const Vector z = centre(x), u = centre(v);
    // -i f a + i g b = u, a + b = z: a = (g z + i u)/(f + g), b = (f z - i u)/(f + g).
    const Vector a = (1.0 / (f + g)) * Vector{g * z.x - u.y, g * z.y + u.x};
    const Vector b = (1.0 / (f + g)) * Vector{f * z.x + u.y, f * z.y - u.x};
    const std::vector<Positions> seen = follow(system, x, v, 30.0, 0.5);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double t = 0.5 * static_cast<double>(i);
      const double cf = std::cos(f * t), sf = std::sin(f * t), cg = std::cos(g * t),
                   sg = std::sin(g * t);
      const Vector exact{a.x * cf + a.y * sf + b.x * cg - b.y * sg,
                         a.y * cf - a.x * sf + b.y * cg + b.x * sg};
      const Vector d = centre(seen[i]) - exact;
      EXPECT_LT(std::sqrt(dot(d, d)), 1e-11) << field << " at " << t;
    }
  }
}

}  // namespace
}  // namespace carom
