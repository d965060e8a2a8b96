#include "carom/analyses/diffusion.hpp"

#include <algorithm>

#include "analyses/diffusion/diffusion_listener.hpp"
#include "carom/base/error.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {

using namespace analyses;

namespace {

// Each takes 26 kB a thread, and up to 300 kB where displacements differ by many orders of size.
constexpr std::size_t most_times = 2000;

DiffusionResult nothing(const System& system) {
  DiffusionResult result;
  result.sums = DisplacementSums(system.run.times);
  if (system.run.free_paths) result.free_paths = FreePathSums(longest_path(system));
  return result;
}

void refuse_impossible(const System& system) {
  if (system.run.times.size() > most_times)
    throw InputError(Place{"", 0, 0, "run.times"},
                     std::to_string(system.run.times.size()) + " times are too many",
                     "at most " + std::to_string(most_times) + " report times");
  if (const auto& window = system.run.window) {
    const TimeWindow asked{window->first, window->second};
    if (std::count_if(system.run.times.begin(), system.run.times.end(),
                      [&](double t) { return asked.holds(t); }) < 2)
      throw InputError(Place{"", 0, 0, "run.window"}, "it holds fewer than two report times > 0",
                       "a window of two report times at least; four give the exponent, too");
  }
  refuse_injections(system, "an ensemble that diffuses");
  refuse_quasi_random(system, "an ensemble that diffuses");
  if (is_thermal(*system.table))
    throw InputError(Place{"", 0, 0, "table.wall"},
                     "walls change the speeds, and lengths of flights count one speed",
                     "another law than \"thermal\"");
  if (system.run.free_paths && regions_change_speeds(*system.table))
    throw InputError(Place{"", 0, 0, "run.free_paths"},
                     "regions change the speeds, and lengths of flights count one speed",
                     "regions without an index or a potential");
  if (system.run.free_paths && (system.is_integrated() || feel_each_other(system)))
    throw InputError(Place{"", 0, 0, "run.free_paths"},
                     "flights are free between hits of walls alone, and other forces act",
                     "free particles, one by one, with or without a magnetic field");
}

}  // namespace

bool DiffusionResult::add(const DiffusionResult& other) {
  if (!add_common(other)) return false;
  sums.merge(other.sums);
  free_paths.merge(other.free_paths);
  add_ends(other);
  energy_change = std::max(energy_change, other.energy_change);
  return true;
}

DiffusionResult run_diffusion(const System& system, const DiffusionOptions& options) {
  refuse_impossible(system);
  return engines::fly_blocks<DiffusionResult>(
      system, system, options, nothing(system),
      {.t_end = system.run.times.back(), .times = system.run.times, .hits = system.run.free_paths},
      [&](const Engine& engine, DiffusionListener::Thread& thread) {
        return DiffusionListener(system, engine, thread);
      });
}

}  // namespace carom
