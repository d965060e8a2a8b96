#include "carom/ensemble/lyapunov.hpp"

#include <cmath>

#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/trajectories.hpp"
#include "carom/integrators/scheme.hpp"
#include "ensemble/lyapunov_listener.hpp"

namespace carom {

using namespace ensemble;

namespace {

// Lengths and rates of deviations are compared by the time that a particle needs for it.
double unit_length_of(const Table& table) {
  const TableMeasure size = measure(table);
  const double length = std::isfinite(size.mean_flight) ? size.mean_flight : size.perimeter;
  return length > 0.0 ? length : 1.0;
}

GrowthSums plan_of(const System& system) {
  return {growth_window(system),
          system.run.trajectories * (interacts(system) ? 1 : system.particles.size())};
}

void refuse_impossible(const System& system) {
  const Dynamics& d = system.dynamics;
  if (system.of_discs())
    throw InputError(Place{"", 0, 0, "interaction.kind"}, "deviations of discs are not followed",
                     "points, free or under forces");
  const bool forces = d.everywhere || (d.forces && !d.forces->empty());
  if (forces && is_adaptive(d.integrator.scheme))
    throw InputError(Place{"", 0, 0, "integrator.scheme"},
                     "deviations are not followed by adaptive schemes", "a scheme of fixed steps");
  refuse_injections(system, "an ensemble whose deviations grow");
  const TimeWindow window = growth_window(system);
  if (!(window.from >= 0.0 && window.from < window.to && window.to <= system.run.t_max))
    throw InputError(Place{"", 0, 0, "run.window"}, "deviations grow during the run",
                     "0 <= from < to <= run.t_max");
}

}  // namespace

bool interacts(const System& system) {
  return system.dynamics.forces && system.dynamics.forces->interacts();
}

bool LyapunovResult::add(const LyapunovResult& other) {
  if (!add_common(other)) return false;
  growth.merge(other.growth);
  trajectories += other.trajectories;
  add_fates(other);
  collisions += other.collisions;
  return true;
}

TimeWindow growth_window(const System& system) {
  if (const auto& window = system.run.window) return {window->first, window->second};
  // Deviations have then turned into the direction that grows.
  return {0.2 * system.run.t_max, system.run.t_max};
}

LyapunovResult run_lyapunov(const System& system, const LyapunovOptions& options) {
  refuse_impossible(system);
  check_start(system, options.interrupted);
  const Sampler sampler(system, options.interrupted);
  const World world = make_world(system, options.decisions);  // threads share its table
  LyapunovResult nothing;
  nothing.growth = plan_of(system);
  const GrowthTimes times(nothing.growth);
  const double unit_length = unit_length_of(*system.table);
  EnsembleRun<LyapunovResult> run(system, options, nothing);
  if (why_one_by_one(system, {.deviations = times.times()}).empty()) run.lanes = options.lanes;
  return run.run([&](LyapunovListener::Thread& thread) {
    const auto engine = make_engine(system, {.t_end = nothing.growth.window().to,
                                             .deviations = times.times(),
                                             .unit_length = unit_length,
                                             .lanes = options.lanes,
                                             .like = &world});
    LyapunovListener listener(system, times, nothing.growth, unit_length, *engine, thread);
    const std::function<bool()> stopped = [&] { return thread.stopped(); };
    DrawnStarts starts(sampler, [&](TrajectoryRange& block) {
      std::uint64_t number = 0;
      return !stopped() && thread.claim(block, number);
    });
    engine->run(starts, listener, stopped);
  });
}

}  // namespace carom
