// Particles that enter through a hole during a run ([[injection]]).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/starts/sampler.hpp"
#include "carom/system/system.hpp"

namespace carom {

class World;

/// A particle that enters during a run, and how.
struct InjectedParticle {
  Particle particle;
  State state;  ///< on the wall, inside the hole, inwards; its time is that of entry
};

/// Draws what enters: entry after entry of System::injections, each in order of time. A function of
/// (seed, trajectory, number of the entry, number of the particle in it) alone, so that neither
/// threads nor other entries matter.
class Injector {
 public:
  explicit Injector(const System&);
  Injector(const Injector&) = delete;

  std::vector<InjectedParticle> draw(std::uint64_t trajectory) const;
  /// Draws and adds to the world, after what is there already; returns what was drawn.
  std::vector<InjectedParticle> add(World&, std::uint64_t trajectory) const;

 private:
  std::vector<double> times(std::size_t entry, std::uint64_t trajectory) const;

  std::vector<System> systems_;    ///< one an entry: this system, started from the entry's hole
  std::vector<Sampler> samplers_;  ///< of these
};

/// Adds a particle that was drawn to the world. Throws InputError.
void add_injected(World&, const System&, const InjectedParticle&, std::uint64_t trajectory);

/// How many particles enter in a trajectory.
std::size_t injected_count(const System&, std::uint64_t trajectory);

/// The number of a particle in an ensemble: trajectory * count + particle. Where particles are
/// injected their number may differ between trajectories: trajectory * 2^20 + particle, those of
/// the start first.
std::uint64_t particle_index(const System&, std::uint64_t trajectory, std::uint64_t particle);

/// Throws InputError where something is asked for that knows no injections.
void refuse_injections(const System&, const char* what);

}  // namespace carom
