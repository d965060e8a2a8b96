#include "carom/engines/engine.hpp"

#include <algorithm>
#include <utility>

#include "carom/lanes/free_lanes.hpp"
#include "carom/lanes/soft_lanes.hpp"
#include "engines/in_lanes.hpp"
#include "engines/one_by_one.hpp"
#include "motion/take_state.hpp"

namespace carom {

using namespace engines;

namespace {

/// Does nothing act between walls?
bool is_free(const System& system) { return !system.is_integrated() && !system.of_discs(); }

/// Starts that are drawn together.
constexpr std::uint64_t most_ahead = 64;

World world_like(const System& system, const EngineOptions& options) {
  return options.like ? options.like->empty_copy()
                      : World(*system.table, system.dynamics, options.decisions);
}

}  // namespace

DrawnStarts::DrawnStarts(const Sampler& sampler, Blocks blocks)
    : sampler_(sampler), injector_(sampler.system()), blocks_(std::move(blocks)) {}
DrawnStarts::DrawnStarts(const Sampler& sampler, TrajectoryRange range)
    : DrawnStarts(sampler, [range, given = false](TrajectoryRange& block) mutable {
        block = range;
        return !std::exchange(given, true);
      }) {}

bool DrawnStarts::next(Trajectory& trajectory, const World& world) {
  while (block_.first == block_.last)
    if (!blocks_(block_)) return false;
  trajectory.number = block_.first++;
  const System& system = sampler_.system();
  if (system.particles.size() == 1 && !system.of_discs()) {
    if (given_ == ahead_.size()) {
      ahead_.resize(std::min(most_ahead, block_.last - trajectory.number));
      sampler_.draw_several(world, trajectory.number, ahead_);
      given_ = 0;
    }
    // Into the memory that the trajectory has: many are short.
    trajectory.starts.resize(1);
    motion::take(trajectory.starts.front(), ahead_[given_++]);
  } else {
    trajectory.starts = sampler_.draw_all(world, trajectory.number);
  }
  if (system.injections.empty()) {
    // A trajectory that is used again has them.
    if (trajectory.particles.empty()) trajectory.particles = system.particles;
    return true;
  }
  trajectory.particles = system.particles;
  for (const InjectedParticle& one : injector_.draw(trajectory.number)) {
    trajectory.particles.push_back(one.particle);
    trajectory.starts.push_back(one.state);
  }
  return true;
}

std::string why_one_by_one(const System& system, const EngineOptions& options) {
  if (!system.injections.empty()) return "particles enter later ([[injection]])";
  if (scatters(*system.table)) return "walls reflect at random";
  if (!system.table->regions.empty()) return "particles pass walls of regions";
  if (options.surface) return "crossings of a surface are located";
  if (options.energy && !is_free(system)) return "energies are checked after each step";
  if (options.frame) return "a frame of deviations is followed";
  if (!options.deviations.empty() && !is_free(system))
    return system.of_discs() ? "deviations of discs are followed"
                             : "deviations are followed under forces";
  if (is_free(system)) return FreeLanes::hindrance(*system.table, system.particles);
  return SoftLanes::hindrance(*system.table, system.dynamics, system.particles);
}

std::unique_ptr<Engine> make_engine(const System& system, const EngineOptions& options) {
  if (!options.lanes || !why_one_by_one(system, options).empty())
    return std::make_unique<OneByOne>(system, options, world_like(system, options));
  const World world = world_like(system, options);
  std::unique_ptr<Lanes> lanes;
  if (is_free(system))
    lanes = std::make_unique<FreeLanes>(world, system.particles, *options.lanes);
  else
    lanes = std::make_unique<SoftLanes>(*system.table, system.dynamics, system.particles.at(0),
                                        *options.lanes, options.decisions);
  return std::make_unique<InLanes>(system, options, world, std::move(lanes));
}

}  // namespace carom
