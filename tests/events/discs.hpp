// Systems of hard discs for the tests.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "carom/base/random.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "events/recorder.hpp"

namespace carom::tests {

inline Dynamics discs_of(const std::vector<double>& radii) {
  ForceSpec spec;
  spec.interaction = InteractionSpec{};
  spec.interaction->kind = InteractionSpec::Kind::hard_discs;
  spec.interaction->radii = radii;
  Dynamics dynamics;
  dynamics.forces = ForceField::build(spec, std::vector<Particle>(radii.size()), std::nullopt);
  return dynamics;
}

inline Table torus(Vector first, Vector second) {
  Table table;
  table.extent = Extent::lattice;
  table.lattice = geometry::make_lattice(first, second, {0, 0});
  return table;
}
inline Table plane() {
  Table table;
  table.extent = Extent::open_plane;
  return table;
}

struct Disc {
  Particle particle;
  State state;
};
inline Disc disc_at(Vector position, Vector velocity, double radius, double mass = 1.0,
                    double omega = 0.0) {
  Disc d;
  d.particle.mass = mass;
  d.particle.radius = radius;
  d.particle.omega = omega;
  d.state = start(position, velocity);
  return d;
}
inline std::vector<double> radii_of(const std::vector<Disc>& discs) {
  std::vector<double> radii;
  for (const Disc& d : discs) radii.push_back(d.particle.radius);
  return radii;
}

/// Discs on a table, with what they conserve.
struct Gas {
  const Table& table;
  World world;
  Gas(const Table& t, const std::vector<Disc>& discs)
      : table(t), world(t, discs_of(radii_of(discs))) {
    for (const Disc& d : discs) world.add(d.particle, d.state);
  }
  double energy() const {
    double sum = 0.0;
    for (int i = 0; i < world.size(); ++i)
      sum += 0.5 * world.particle(i).mass * dot(world.state(i).velocity, world.state(i).velocity);
    return sum;
  }
  Vector momentum() const {
    Vector sum{};
    for (int i = 0; i < world.size(); ++i)
      sum = sum + world.particle(i).mass * world.state(i).velocity;
    return sum;
  }
};

/// Discs on a grid of sites of a square torus of side `side` with random velocities, total momentum
/// about 0.
inline std::vector<Disc> square_gas(int across, double side, double radius, std::uint64_t seed) {
  RandomStream random(seed, Purpose::initial_state, 0);
  std::vector<Disc> discs;
  const double step = side / across;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      const Vector x{(i + 0.5) * step - 0.5 * side, (j + 0.5) * step - 0.5 * side};
      discs.push_back(disc_at(x, {random.symmetric(), random.symmetric()}, radius));
    }
  Vector mean{};
  for (const Disc& d : discs)
    mean = mean + (1.0 / static_cast<double>(discs.size())) * d.state.velocity;
  for (Disc& d : discs) d.state.velocity = d.state.velocity - mean;
  return discs;
}

struct ContactRecorder : Recorder {
  std::vector<ContactEvent> contacts;
  void contact(const ContactEvent& e) override { contacts.push_back(e); }
};

}  // namespace carom::tests
