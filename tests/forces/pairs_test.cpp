// Particles that act on each other: closed forms, conserved quantities, and the scaling of Coulomb
// forces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"

namespace carom {
namespace {

using geometry::Vector;

State state_of(const Vector& position, const Vector& velocity) {
  State s;
  s.position = position;
  s.velocity = velocity;
  return s;
}

std::vector<State> states_of(const World& world, double time) {
  std::vector<State> states;
  for (int i = 0; i < world.size(); ++i) {
    EXPECT_EQ(world.fate(i), Fate::survived) << world.report(i);
    states.push_back(world.state_at(i, Time(time)));
  }
  return states;
}

TEST(Ring, HasItsCoulombEnergy) {
  for (int count = 2; count <= 20; ++count) {
    ForceSpec spec;
    spec.interaction.emplace();
    const std::vector<Particle> particles(static_cast<std::size_t>(count));
    Dynamics dynamics;
    dynamics.forces = ForceField::build(spec, particles, std::nullopt);
    std::vector<State> states;
    double exact = 0.0;
    for (int k = 0; k < count; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / count;
      states.push_back(state_of({std::cos(angle), std::sin(angle)}, {}));
      if (k > 0) exact += 0.25 * count / std::sin(std::numbers::pi * k / count);
    }
    const Energy energy = energy_of(particles, states, dynamics, Table{});
    EXPECT_NEAR(energy.pair / exact, 1.0, 2e-15) << count;
    // The forces point outwards; their size is the energy a particle, as r dE/dr = -E.
    for (std::size_t i = 0; i < states.size(); ++i) {
      Vector force{};
      for (std::size_t j = 0; j < states.size(); ++j)
        if (j != i)
          dynamics.forces->add_pair(particles[i], particles[j],
                                    states[i].position - states[j].position, force);
      EXPECT_LT(length(force - (exact / count) * states[i].position) / length(force), 5e-14)
          << count;
    }
  }
}

// Eight partners at a time or one after the other: the same forces to rounding, whatever is left
// over.
TEST(CoulombPairs, AllAtOnceAreTheirSum) {
  for (const std::size_t count : {2u, 15u, 16u, 17u, 23u, 24u, 25u, 64u, 101u}) {
    ForceSpec spec;
    spec.interaction.emplace();
    spec.interaction->strength = 1.5;
    std::vector<Particle> particles(count);
    std::vector<Vector> x, all(count), one_by_one(count);
    for (std::size_t i = 0; i < count; ++i) {
      particles[i].charge = 1.0 + 0.25 * static_cast<double>(i % 3);
      const double angle = 2.4 * static_cast<double>(i), r = std::sqrt(static_cast<double>(i + 1));
      x.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    const auto forces = ForceField::build(spec, particles, std::nullopt);
    forces->add_pairs(particles, x, nullptr, all);
    Vector total{};
    for (std::size_t i = 0; i < count; ++i) {
      double size = 0.0;
      for (std::size_t j = 0; j < count; ++j) {
        if (i == j) continue;
        Vector force{};
        forces->add_pair(particles[i], particles[j], x[i] - x[j], force);
        one_by_one[i] = one_by_one[i] + force;
        size += length(force);
      }
      EXPECT_LT(length(all[i] - one_by_one[i]), 1e-15 * size) << count << " " << i;
      total = total + all[i];
    }
    EXPECT_LT(length(total), 1e-14 * static_cast<double>(count)) << count;
  }
}

// What is kept on a hyperbola about a centre that repels, V = k/r, in complex numbers: the
// direction from which a particle comes and that to which it goes, at infinity, from any of its
// states.
struct Hyperbola {
  std::complex<double> coming, going;
  double energy, impact;
  Hyperbola(double mass, double k, Vector x, Vector v) {
    const std::complex<double> i(0.0, 1.0), r(x.x, x.y), p(mass * v.x, mass * v.y);
    energy = 0.5 * mass * dot(v, v) + k / length(x);
    const double angular = mass * cross(x, v), momentum = std::sqrt(2.0 * mass * energy);
    impact = std::fabs(angular) / momentum;
    // The Laplace vector p x L + m k r/|r|; far away r and p have the direction sought, up to a
    // sign.
    const std::complex<double> laplace = -i * angular * p + mass * k * r / std::abs(r);
    going = laplace / (mass * k - i * momentum * angular);
    coming = laplace / (-mass * k - i * momentum * angular);
  }
};

double scattering_angle(const Hyperbola& before, const Hyperbola& after) {
  return std::fabs(std::arg(after.going / before.coming));
}

// Rutherford's formula. Start and end are at finite distances: the rest of the way is Kepler's
// hyperbola.
TEST(Rutherford, ACentreScattersByRutherfordsFormula) {
  const LoadedSystem loaded = read_system(R"(
[[potential]]
kind = "coulomb"
charge = 3
[particles]
mass = 2
charge = 1.5
speed = 1
[integrator]
scheme = "arkode"
tolerance = 1e-14
[initial]
kind = "point"
position = [1, 0]
angle = 0
)",
                                          "rutherford");
  const System& system = loaded.system;
  const double k = 4.5;
  for (const double offset : {0.01, 0.5, 2.0, 8.0}) {
    for (const double speed : {1.0, 3.0}) {
      const State start = state_of({-20.0, offset}, {speed, 0.0});
      World world(*system.table, system.dynamics);
      world.add(system.particles[0], start);
      Observer silent;
      const double time = 60.0 / speed;
      world.run_until(time, silent);
      const State end = states_of(world, time).front();
      const Hyperbola before(2.0, k, start.position, start.velocity),
          after(2.0, k, end.position, end.velocity);
      EXPECT_GT(dot(end.position, end.velocity), 0.0);
      const double exact = 2.0 * std::atan(k / (2.0 * before.energy * before.impact));
      EXPECT_NEAR(scattering_angle(before, after), exact, 1e-11) << offset << " " << speed;
    }
  }
}

// Two bodies: the same formula for the relative motion, with the reduced mass.
TEST(Rutherford, AnotherParticleScattersByRutherfordsFormula) {
  const LoadedSystem loaded = read_system(R"(
[interaction]
kind = "coulomb"
strength = 0.5
[particles]
mass = [1, 3]
charge = [2, 4]
speed = 1
[integrator]
step = 0.002
[initial]
kind = "list"
starts = [[1, 0, 1, 0]]
)",
                                          "two-bodies");
  const System& system = loaded.system;
  const double k = 4.0, mass = 0.75;
  World world(*system.table, system.dynamics);
  const State one = state_of({-10.0, 0.4}, {2.0, 0.1}), two = state_of({1.0, 0.0}, {-0.3, 0.2});
  world.add(system.particles[0], one);
  world.add(system.particles[1], two);
  Observer silent;
  world.run_until(20.0, silent);
  const std::vector<State> end = states_of(world, 20.0);
  const Hyperbola before(mass, k, one.position - two.position, one.velocity - two.velocity);
  const Hyperbola after(mass, k, end[0].position - end[1].position,
                        end[0].velocity - end[1].velocity);
  EXPECT_NEAR(scattering_angle(before, after),
              2.0 * std::atan(k / (2.0 * before.energy * before.impact)), 1e-11);
}

/// The momentum that pair forces keep in a uniform field: m v' = m omega (y', -x') + F.
Vector canonical_momentum(const std::vector<Particle>& particles,
                          const std::vector<State>& states) {
  Vector sum = momentum_of(particles, states);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Vector& x = states[i].position;
    sum = sum + (particles[i].mass * particles[i].omega) * Vector{-x.y, x.x};
  }
  return sum;
}

// Newton's third law, for every interaction, with unequal masses and charges, with and without a
// field; Yukawa and the others of finite range form groups that change. What is left is rounding:
// of velocities, and where positions count, of adding the same short way thousands of times, which
// rounds to the same side.
TEST(ThirdLaw, KeepsMomenta) {
  for (const char* interaction :
       {"kind = \"coulomb\"", "kind = \"yukawa\"\nrange = 0.01\nstrength = 2",
        "kind = \"lennard-jones\"\ndiameter = 0.2\ndepth = 0.1",
        "kind = \"soft-sphere\"\ndiameter = 0.3",
        "kind = \"soft-sphere\"\ndiameter = 0.3\nexponent = 9",
        "kind = \"expression\"\nexpression = \"exp(-r^2)\""}) {
    for (const auto& [field, rounding] : {std::pair{"0", 1e-13}, std::pair{"0.8", 1e-12}}) {
      const LoadedSystem loaded =
          read_system(std::string("[interaction]\n") + interaction + "\n[field]\nB = " + field +
                          "\n[particles]\nmass = [1, 2, 0.5, 1, 3, 1, 1.5, 1]\n"
                          "charge = [1, 2, 1, 0.5, 1, 1, 1.5, 1]\nspeed = 1\n"
                          "[integrator]\nstep = 0.004\n[initial]\nkind = \"rectangle\"\n"
                          "min = [-2, -2]\nmax = [2, 2]\n",
                      "third-law");
      const System& system = loaded.system;
      World world(*system.table, system.dynamics);
      std::vector<State> start;
      for (int i = 0; i < 8; ++i) {
        const double angle = 0.3 + 0.9 * i;
        start.push_back(state_of({0.7 * (i % 3) + 0.02 * i, 0.6 * (i / 3)},
                                 {std::cos(angle), std::sin(angle)}));
        world.add(system.particles[static_cast<std::size_t>(i)], start.back());
      }
      Observer silent;
      world.run_until(4.0, silent);
      const std::vector<State> end = states_of(world, 4.0);
      const Vector drift =
          canonical_momentum(system.particles, end) - canonical_momentum(system.particles, start);
      EXPECT_LT(length(drift), rounding) << interaction << " B = " << field;
      const double turned = angular_momentum_of(system.particles, end, *system.table) -
                            angular_momentum_of(system.particles, start, *system.table);
      EXPECT_NEAR(turned, 0.0, 1e-11) << interaction << " B = " << field;
      // They did act on each other.
      EXPECT_GT(length(end[0].velocity - start[0].velocity), 1e-3) << interaction;
    }
  }
}

struct Hits : Observer {
  std::vector<HitEvent> all;
  void hit(const HitEvent& event) override { all.push_back(event); }
};

struct Scale {
  double size = 1.0, energy = 1.0;
  double time() const { return size / std::sqrt(energy); }
};

std::string text_of(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

/// Three particles in the hard circle, everything scaled: alpha with energy * size, B with 1 /
/// time.
Hits three_in_a_circle(const Scale& scale, double time) {
  SystemOverrides set;
  set.set = {{"particles.count", "3"},
             {"particles.energy", text_of(12.0 * scale.energy)},
             {"table.radius", text_of(scale.size)},
             {"interaction.strength", text_of(scale.size * scale.energy)},
             {"field.B", text_of(0.5 / scale.time())},
             {"integrator.step", text_of(scale.time() / 1024.0)}};
  const LoadedSystem loaded = load_system("coulomb-circle", set);
  const double speed = std::sqrt(scale.energy);
  World world(*loaded.system.table, loaded.system.dynamics);
  const Vector x[] = {{0.5, 0.125}, {-0.25, 0.5}, {-0.0625, -0.375}};
  const Vector v[] = {{0.5, 1.75}, {-1.25, 0.25}, {0.75, -1.5}};
  for (int i = 0; i < 3; ++i)
    world.add(loaded.system.particles[0], state_of(scale.size * x[i], speed * v[i]));
  Hits hits;
  world.run_until(time * scale.time(), hits);
  states_of(world, time * scale.time());
  return hits;
}

// Powers of two change no bit of an orbit; other factors change rounding, which chaos amplifies.
// Its growth is measured by two orbits that differ by that much, and by nothing else.
TEST(CoulombScaling, RepeatsTheOrbit) {
  const Hits one = three_in_a_circle({}, 8.0);
  ASSERT_GT(one.all.size(), 20u);
  for (const Scale& scale : {Scale{4.0, 1.0}, Scale{2.0, 16.0}, Scale{0.5, 0.25}}) {
    const Hits scaled = three_in_a_circle(scale, 8.0);
    ASSERT_EQ(scaled.all.size(), one.all.size());
    for (std::size_t i = 0; i < one.all.size(); ++i) {
      EXPECT_EQ(scaled.all[i].particle, one.all[i].particle);
      EXPECT_EQ(scaled.all[i].u, one.all[i].u) << i;
      EXPECT_EQ(scaled.all[i].position, scale.size * one.all[i].position) << i;
      EXPECT_EQ(scaled.all[i].time.value(), scale.time() * one.all[i].time.value()) << i;
    }
  }
  for (const Scale& scale : {Scale{3.0, 1.0}, Scale{0.7, 2.9}, Scale{11.0, 0.05}}) {
    const Hits scaled = three_in_a_circle(scale, 3.0);
    ASSERT_GT(scaled.all.size(), 8u);
    for (std::size_t i = 0; i < scaled.all.size(); ++i) {
      EXPECT_EQ(scaled.all[i].particle, one.all[i].particle);
      EXPECT_LT(length((1.0 / scale.size) * scaled.all[i].position - one.all[i].position), 1e-10)
          << i;
      EXPECT_NEAR(scaled.all[i].time.value() / scale.time(), one.all[i].time.value(), 1e-10) << i;
    }
  }
}

}  // namespace
}  // namespace carom
