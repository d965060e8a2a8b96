// Forces on many particles at once are those on each, to the bit.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "carom/base/random.hpp"
#include "forces/potential.hpp"

namespace carom {

using namespace forces;

namespace {

using Kind = PotentialSpec::Kind;

PotentialSpec spec_of(Kind kind) {
  PotentialSpec s;
  s.kind = kind;
  s.height = 0.7;
  s.radius = 0.6;
  s.softness = 0.11;
  s.width = 0.3;
  s.omega_x = 1.3;
  s.omega_y = 0.9;
  s.strength = 0.8;
  s.exponent = 3.0;
  s.charge = 0.4;
  s.half_length = 0.5;
  s.force = {0.3, -1.1};
  s.centers = {{0.1, 0.2}, {-0.7, 0.4}, {0.3, -0.5}};
  return s;
}

TEST(Potentials, PushManyParticlesAsTheyPushEach) {
  constexpr int count = 61;
  Particle particle;
  particle.mass = 1.7;
  particle.charge = 0.6;
  for (const Kind kind :
       {Kind::fermi, Kind::gaussian, Kind::harmonic, Kind::quartic, Kind::power, Kind::coulomb,
        Kind::henon_heiles, Kind::linear, Kind::soft_circle, Kind::soft_stadium}) {
    const auto potential = make_potential(spec_of(kind), {});
    RandomStream random(3, Purpose::initial_state, 1);
    std::vector<double> x(count), y(count), fx(count), fy(count);
    std::vector<geometry::Vector> expected;
    for (std::size_t i = 0; i < count; ++i) {
      for (double* number : {&x[i], &y[i], &fx[i], &fy[i]})
        *number = 3.0 * (random.uniform() - 0.5);
      expected.push_back({fx[i], fy[i]});
      potential->add_force(particle, {x[i], y[i]}, expected.back());
    }
    potential->add_forces(particle, count, x.data(), y.data(), fx.data(), fy.data());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(fx[i]), std::bit_cast<std::uint64_t>(expected[i].x))
          << int(kind);
      EXPECT_EQ(std::bit_cast<std::uint64_t>(fy[i]), std::bit_cast<std::uint64_t>(expected[i].y))
          << int(kind);
    }
  }
}

}  // namespace
}  // namespace carom
