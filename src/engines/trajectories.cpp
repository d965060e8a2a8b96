#include "carom/engines/trajectories.hpp"

#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {

World make_world(const System& system, DecisionOptions options) {
  World world(*system.table, system.dynamics, options);
  if (system.run.collisions > 0) world.limit_hits(system.run.collisions);
  return world;
}

void for_each_trajectory(const System& system, TrajectoryRange range, Observer& observer) {
  World world = make_world(system);
  if (system.run.sample > 0.0) world.sample_every(system.run.sample);
  const Sampler sampler(system);
  const Injector injector(system);
  for (std::uint64_t trajectory = range.first; trajectory < range.last; ++trajectory) {
    world.clear();
    add_starts(world, sampler, trajectory);
    injector.add(world, trajectory);
    world.run_until(system.run.t_max, observer);
    for (int p = 0; p < world.size(); ++p)
      if (!world.finished(p))
        observer.end({.particle = p,
                      .time = system.run.t_max,
                      .state = world.state(p),
                      .hits = world.hits(p)});
  }
}

}  // namespace carom
