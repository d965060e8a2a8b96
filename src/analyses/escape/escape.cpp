#include "carom/analyses/escape.hpp"

#include "analyses/escape/escape_listener.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/table/hole_names.hpp"

namespace carom {

using namespace analyses;

namespace {

EscapeResult nothing(const System& system) {
  EscapeResult result;
  result.counts =
      SurvivalCounts(system.run.times, hole_names(*system.table).size(), system.quasi_random());
  return result;
}

// What one thread does.
void work(const System& system, const Sampler& sampler, const EscapeOptions& options,
          const World& world, EscapeListener::Thread& thread, EscapeListener::Output& output) {
  const auto engine =
      make_engine(system, {.t_end = system.run.t_max, .lanes = options.lanes, .like = &world});
  EscapeListener listener(system, *engine, thread, output);
  DrawnStarts starts(sampler, [&](TrajectoryRange& block) { return listener.claim(block); });
  while (engine->run(starts, listener, [&] { return thread.stopped(); }) && listener.go_on()) {
  }
}

}  // namespace

bool EscapeResult::add(const EscapeResult& other) {
  if (!add_common(other)) return false;
  counts.merge(other.counts);
  effort += other.effort;
  return true;
}

EscapeResult run_escape(const System& system, const EscapeOptions& options) {
  check_start(system, options.interrupted);
  const Sampler sampler(system, options.interrupted);
  const World world = make_world(system, options.decisions);  // threads share its table
  engines::EnsembleRun<EscapeResult> run(system, options, nothing(system));
  if (why_one_by_one(system).empty()) run.lanes = options.lanes;
  EscapeListener::Output output(options.records, 16 * static_cast<std::uint64_t>(run.threads()));
  const EscapeResult result = run.run([&](EscapeListener::Thread& thread) {
    work(system, sampler, options, world, thread, output);
  });
  output.finish();
  return result;
}

DecayFit decay_of(const System& system, const EscapeResult& result) {
  return fit_decay(result.counts, system.run.t_max, system.run.window);
}

}  // namespace carom
