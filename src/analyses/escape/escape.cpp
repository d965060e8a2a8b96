#include "carom/analyses/escape.hpp"

#include "analyses/escape/escape_listener.hpp"
#include "carom/table/hole_names.hpp"

namespace carom {

bool EscapeResult::add(const EscapeResult& other) {
  if (!add_common(other)) return false;
  counts.merge(other.counts);
  effort += other.effort;
  return true;
}

EscapeResult run_escape(const System& system, const EscapeOptions& options) {
  EscapeResult nothing;
  nothing.counts =
      SurvivalCounts(system.run.times, hole_names(*system.table).size(), system.quasi_random());
  return engines::fly_blocks<EscapeResult>(
      system, system, options, nothing, {.t_end = system.run.t_max},
      [&](const Engine& engine, analyses::EscapeListener::Thread& thread) {
        return analyses::EscapeListener(system, engine, thread, nothing.counts);
      });
}

DecayFit decay_of(const System& system, const EscapeResult& result) {
  return fit_decay(result.counts, system.run.t_max, system.run.window);
}

}  // namespace carom
