#include "carom/analyses/splitting.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "analyses/splitting/population.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/starts/injection.hpp"
#include "engines/parallel_blocks.hpp"

namespace carom {

using namespace analyses;

namespace {

void check(const System& system, const SplittingPlan& plan) {
  const auto refuse = [](const char* key, const char* problem, const char* expected) {
    throw InputError(Place{{}, 0, 0, key}, problem, expected);
  };
  refuse_all_but_mirrors(*system.table, "populations");
  refuse_injections(system, "splitting");
  refuse_quasi_random(system, "splitting");
  if (system.is_integrated() || system.particles.size() != 1 || system.of_discs())
    refuse("splitting", "splitting follows one free particle",
           "a system without forces, of one particle, flown by events");
  if (system.run.collisions > 0)
    refuse("run.collisions", "splitting allows no cap on hits",
           "levels in hits: hits:0,1,2 or hits:lin:0:50:51");
  const std::vector<double>& levels = plan.levels;
  if (levels.empty()) refuse("splitting", "there are no levels", "at least one");
  const bool by_time = plan.by == SplittingPlan::Level::time;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (!(levels[i] >= 0.0 && levels[i] < 0x1p53) || (i > 0 && !(levels[i] > levels[i - 1])))
      refuse("splitting", "the levels do not increase",
             "levels of at least 0, in increasing order");
    if (!by_time && levels[i] != std::floor(levels[i]))
      refuse("splitting", "a number of hits is not whole", "whole numbers of hits");
  }
  if (by_time && plan.deviations)
    refuse("splitting", "deviations are carried from hit to hit", "levels in hits");
  if (by_time && (system.run.times.empty() || !(levels.back() < system.run.times.back())))
    refuse("splitting", "the last level is not below the last report time",
           "levels below --t-max and --times");
  if (plan.population < 2 || plan.population > 1'000'000'000)
    refuse("population", "the population is too small or too large", "2 to 1e9");
  if (plan.repetitions < 2 || plan.repetitions > 1'000'000)
    refuse("repetitions", "the number of repetitions is too small or too large", "2 to 1e6");
  if (plan.lookback > SplittingPlan::most_lookback)
    refuse("lookback", "too many hits to look back", "at most 8");
  if (!(plan.kick >= 0.0 && plan.kick <= 0.5))
    refuse("kick", "the kick is not possible", "above 0, at most 0.5; or 0 to have it chosen");
}

// A population is kept whole by the thread that follows it.
void check_memory(const SplittingPlan& plan, int threads) {
  const double here =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double each = static_cast<double>(Population::bytes_each()) * threads;
  if (static_cast<double>(plan.population) * each <= here) return;
  const auto most = static_cast<std::uint64_t>(here / each);
  throw InputError(Place{{}, 0, 0, "population"},
                   "the population does not fit into the memory of this machine",
                   "at most " + std::to_string(most) + " trajectories on " +
                       std::to_string(threads) + (threads == 1 ? " thread" : " threads"));
}

// Populations that are wanted, those that there are, and what else the threads share.
struct Shared {
  Shared(std::uint64_t repetitions, std::size_t kicks)
      : runs(kicks, std::vector<PopulationRun>(repetitions)) {}
  std::uint64_t first = 0;                       // repetition
  std::vector<std::vector<PopulationRun>> runs;  // by kick and repetition
  std::mutex mutex;
  DecisionCounts decisions;
  std::vector<std::string> reports;
  std::uint64_t done = 0, hits = 0;
};

// One thread's populations.
class SplittingWorker {
 public:
  SplittingWorker(Population population, const SplittingOptions& options, Shared& shared)
      : population_(std::move(population)), options_(options), shared_(shared) {}

  bool run(std::uint64_t, std::uint64_t first, std::uint64_t end,
           const std::function<bool()>& stopped) {
    const std::size_t kicks = shared_.runs.size();
    for (std::uint64_t i = first; i < end; ++i) {
      // Every kick of a repetition starts from the same states, so neighbours in order share the
      // work fairly.
      PopulationRun one = population_.run(shared_.first + i / kicks, i % kicks, stopped);
      if (!one.done) return false;
      const std::lock_guard lock(shared_.mutex);
      ++shared_.done;
      shared_.hits += one.collisions;
      shared_.runs[i % kicks][i / kicks] = std::move(one);
      if (options_.progress)
        options_.progress(shared_.done, kicks * shared_.runs.front().size(), shared_.hits);
    }
    return true;
  }

  void finish() {
    shared_.decisions += population_.decisions();
    const std::vector<std::string>& failures = population_.failures();
    shared_.reports.insert(shared_.reports.end(), failures.begin(), failures.end());
  }

 private:
  Population population_;
  const SplittingOptions& options_;
  Shared& shared_;
};

// The same for all populations of a run.
struct Setting {
  const System& system;
  const Sampler& sampler;
  const World& world;
  const Kick& kick;
  const std::vector<double>& at;
};

/// False: it was stopped on the way.
bool follow(const Setting& s, const SplittingPlan& plan, const engines::BlockPlan& blocks,
            const SplittingOptions& options, Shared& shared) {
  return engines::run_blocks(
      blocks, options.interrupted,
      [&] {
        return SplittingWorker(
            Population(s.system, s.sampler, s.world, s.kick, plan, s.at, options), options, shared);
      },
      [](SplittingWorker& worker) { worker.finish(); });
}

/// The kick of a plan that leaves it open (docs/physics/rare-events.md), by small populations. What
/// they lose counts.
double chosen_kick(const Setting& setting, SplittingPlan plan, SplittingOptions options,
                   SplittingResult& result) {
  constexpr double least = 0x1p-40;
  constexpr std::uint64_t judges = 16;
  const std::uint64_t starts = plan.repetitions * plan.population, population = plan.population;
  options.progress = nullptr;
  const auto follow_some = [&](std::uint64_t repetitions, std::uint64_t largest) {
    plan.population = std::min(population, largest);
    Shared shared(repetitions, 1);
    // The first repetition of this size behind all starts: its random numbers are no other's.
    shared.first = (starts + plan.population - 1) / plan.population;
    const bool all =
        follow(setting, plan, engines::BlockPlan(repetitions, options.threads, 1), options, shared);
    result.reports.insert(result.reports.end(), shared.reports.begin(), shared.reports.end());
    for (const PopulationRun& one : shared.runs.front()) {
      result.unresolved += one.unresolved;
      result.lost += one.lost;
    }
    return all ? shared.runs.front() : std::vector<PopulationRun>();
  };
  for (plan.kick = SplittingPlan::largest_choice; plan.kick > least; plan.kick /= 2) {
    const std::vector<PopulationRun> one = follow_some(1, 1000);
    if (one.empty() || one.front().tried == 0)
      return SplittingPlan::largest_choice;  // nothing is copied, or nearly
    const auto tried = static_cast<double>(one.front().tried),
               accepted = static_cast<double>(one.front().accepted);
    if (tried - accepted <= SplittingPlan::most_kept * tried) break;
  }
  for (; plan.kick > least; plan.kick /= 4) {
    const std::vector<PopulationRun> some = follow_some(judges, 4000);
    if (some.empty() || !is_likely(cost_of_kicks(some, plan.levels.size() + 1), judges)) break;
  }
  return plan.kick;
}

}  // namespace

SplittingResult run_splitting(const System& system, const SplittingPlan& plan,
                              const SplittingOptions& options) {
  check(system, plan);
  check_start(system, options.interrupted);
  SplittingResult result;
  result.plan = plan;
  result.at = plan.by == SplittingPlan::Level::time ? system.run.times : plan.levels;
  // One population is one block: it needs no other, and its bits know no thread.
  const engines::BlockPlan blocks(plan.repetitions * kick_sizes, options.threads, 1);
  check_memory(plan, blocks.threads);
  const Sampler sampler(system, options.interrupted);
  const World world = make_world(system, options.decisions);
  const Kick kick(*system.table);
  const Stopwatch watch;
  const Setting setting{system, sampler, world, kick, result.at};
  if (plan.kick == 0.0) result.plan.kick = chosen_kick(setting, plan, options, result);
  Shared shared(plan.repetitions, kick_sizes);
  shared.reports = std::move(result.reports);
  result.complete = follow(setting, result.plan, blocks, options, shared);
  std::move(shared.runs.begin(), shared.runs.end(), result.runs.begin());
  result.threads = blocks.threads;
  result.decisions = shared.decisions;
  std::sort(shared.reports.begin(), shared.reports.end());
  if (shared.reports.size() > 5) shared.reports.resize(5);
  result.reports = std::move(shared.reports);
  // An interrupted run keeps the repetitions that were finished at every kick.
  for (std::size_t r = plan.repetitions; r-- > 0;) {
    if (std::all_of(result.runs.begin(), result.runs.end(),
                    [&](const auto& runs) { return runs[r].done; }))
      continue;
    for (auto& runs : result.runs) runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(r));
  }
  for (const auto& runs : result.runs) {
    for (const PopulationRun& run : runs) {
      result.collisions += run.collisions;
      result.unresolved += run.unresolved;
      result.lost += run.lost;
      result.digest += run.digest;
    }
  }
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  return result;
}

}  // namespace carom
