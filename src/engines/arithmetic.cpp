#include "engines/arithmetic.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "carom/base/digest.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/sampler.hpp"
#include "carom/system/system.hpp"
#include "engines/particle_hash.hpp"

namespace carom::engines {

namespace {

using Numbers = std::map<std::string, ExactNumber>;

// A point with the speed 1 in a table of that shape, with these numbers and words of its
// specification.
System in_table(const char* shape, Numbers numbers, double omega, double t_max,
                std::map<std::string, std::string> words = {}) {
  TableSpec spec;
  spec.shape = shape;
  spec.numbers = std::move(numbers);
  spec.words = std::move(words);
  System system;
  system.table = std::make_shared<const Table>(build_table(spec));
  system.particles = {Particle{}};
  system.particles.front().omega = omega;
  system.run.t_max = t_max;
  return system;
}

// Two charges over two bumps: potentials, pairs, steps in a magnetic field and hits within them.
System with_forces() {
  System system = in_table("rectangle", {{"width", 3.0}, {"height", 2.0}}, 0.5, 1.5);
  system.particles.push_back(system.particles.front());
  ForceSpec forces;
  for (const auto kind : {PotentialSpec::Kind::fermi, PotentialSpec::Kind::gaussian}) {
    PotentialSpec& bump = forces.potentials.emplace_back();
    bump.kind = kind;
    bump.radius = bump.width = 0.25;
    bump.centers = {{kind == PotentialSpec::Kind::fermi ? 0.875 : 2.125, 1.0}};
  }
  forces.interaction.emplace().strength = 0.25;
  system.dynamics.forces = ForceField::build(forces, system.particles, system.table->lattice);
  system.dynamics.integrator.step = 0.0625;
  return system;
}

// Systems that between them use every kind of motion: lines and Larmor circles among segments,
// arcs, ellipses and copies on a lattice, and steps. Each free particle makes some twenty hits.
std::vector<System> systems() {
  std::vector<System> all;
  all.push_back(in_table("stadium", {{"half_length", 2.0}, {"radius", 1.0}}, 0.0, 40.0));
  all.push_back(in_table("rectangle", {{"width", 1.0}, {"height", 1.0}}, 1.96875, 16.0));
  all.push_back(in_table(
      "mushroom", {{"cap_radius", 1.0}, {"stem_width", 1.0}, {"stem_height", 1.0}, {"offset", 0.0}},
      0.0, 24.0));
  all.push_back(in_table("lorentz", {{"spacing", 2.1875}, {"radius", 1.0}}, 0.0, 8.0,
                         {{"lattice", "triangular"}}));
  all.push_back(in_table("ellipse", {{"a", 1.0}, {"b", 0.75}}, 0.375, 20.0));
  all.push_back(with_forces());
  return all;
}

std::uint64_t computed() {
  constexpr std::uint64_t trajectories = 2;
  std::uint64_t sum = 0;
  for (const System& system : systems()) {
    const ParticleHash share(system);
    const Sampler sampler(system);
    World world(*system.table, system.dynamics);
    for (std::uint64_t trajectory = 0; trajectory < trajectories; ++trajectory) {
      world.clear();
      add_starts(world, sampler, trajectory);
      world.run_until(system.run.t_max);
      for (int particle = 0; particle < world.size(); ++particle) {
        const State& end = world.state(particle);
        sum = mix(mix(sum ^ static_cast<std::uint64_t>(std::int64_t{end.wall}), end.u), end);
        // The share of an ensemble's digest, with a sample: builds that compute digests in another
        // way must not be merged either.
        sum = mix(sum ^ share(trajectory, world.fate(particle), system.run.t_max,
                              world.hits(particle), world.last_wall(particle), end,
                              std::span(&end.position.x, 1)));
      }
    }
  }
  return sum;
}

}  // namespace

const std::string& arithmetic_fingerprint() {
  static const std::string digits = fmt::format("{:016x}", computed());
  return digits;
}

}  // namespace carom::engines
