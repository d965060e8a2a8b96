#include "carom/starts/injection.hpp"

#include <stdexcept>

#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"
#include "carom/base/random.hpp"
#include "carom/events/world.hpp"

namespace carom {

namespace {

constexpr std::uint64_t most_in_a_trajectory = std::uint64_t{1} << 20;

InputError too_many(const Injection& injection) {
  return InputError(injection.place, "too many particles enter",
                    "at most 1000000 particles in a trajectory");
}

}  // namespace

Injector::Injector(const System& system) {
  if (!system.injections.empty() && system.run.trajectories > (std::uint64_t{1} << 43))
    throw InputError("with injections there may be at most 2^43 trajectories");
  systems_.assign(system.injections.size(), system);
  samplers_.reserve(systems_.size());
  for (System& one : systems_) {
    const auto entry = static_cast<std::size_t>(&one - systems_.data());
    one.initial = {};
    one.initial.kind = InitialCondition::Kind::hole;
    one.initial.hole = system.injections[entry].hole;
    one.initial.place = system.injections[entry].place;
    samplers_.emplace_back(one);
  }
}

// A Poisson process: the waiting times are exponential.
std::vector<double> Injector::times(std::size_t entry, std::uint64_t trajectory) const {
  const System& system = systems_[entry];
  const Injection& injection = system.injections[entry];
  if (!(injection.rate > 0.0)) return injection.times;
  std::vector<double> times;
  RandomStream random(system.run.seed, Purpose::injection_time, trajectory, entry);
  for (double t = 0.0;;) {
    t += -elementary::log(1.0 - random.uniform()) / injection.rate;
    if (!(t < system.run.t_max)) return times;
    if (times.size() >= most_in_a_trajectory) throw too_many(injection);
    times.push_back(t);
  }
}

std::vector<InjectedParticle> Injector::draw(std::uint64_t trajectory) const {
  std::vector<InjectedParticle> all;
  for (std::size_t entry = 0; entry < systems_.size(); ++entry) {
    const System& system = systems_[entry];
    const Injection& injection = system.injections[entry];
    std::uint64_t number = std::uint64_t{entry} << 32;
    for (const double time : times(entry, trajectory)) {
      RandomStream random(system.run.seed, Purpose::injection, trajectory, number++);
      State state = samplers_[entry].cosine_law(random, injection.particle.speed);
      state.time = Time(time);
      all.push_back({injection.particle, state});
    }
    if (all.size() + system.particles.size() > most_in_a_trajectory) throw too_many(injection);
  }
  return all;
}

std::vector<InjectedParticle> Injector::add(World& world, std::uint64_t trajectory) const {
  std::vector<InjectedParticle> all = draw(trajectory);
  for (const InjectedParticle& one : all) add_injected(world, systems_.front(), one, trajectory);
  return all;
}

void add_injected(World& world, const System& system, const InjectedParticle& one,
                  std::uint64_t trajectory) {
  try {
    world.add(one.particle, one.state);
  } catch (const std::invalid_argument& error) {
    throw InputError(system.injections.front().place, "a particle of trajectory " +
                                                          std::to_string(trajectory) +
                                                          " cannot enter: " + error.what());
  }
}

std::size_t injected_count(const System& system, std::uint64_t trajectory) {
  return Injector(system).draw(trajectory).size();
}

std::uint64_t particle_index(const System& system, std::uint64_t trajectory,
                             std::uint64_t particle) {
  return trajectory * (system.injections.empty() ? system.particles.size() : most_in_a_trajectory) +
         particle;
}

void refuse_injections(const System& system, const char* what) {
  if (system.injections.empty()) return;
  throw InputError(system.injections.front().place,
                   std::string("particles cannot be injected in ") + what,
                   "a system without [[injection]]");
}

}  // namespace carom
