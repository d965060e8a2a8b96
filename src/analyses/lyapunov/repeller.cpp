#include "carom/analyses/lyapunov/repeller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "analyses/splitting/means.hpp"
#include "base/counted.hpp"
#include "base/student.hpp"
#include "carom/base/elementary.hpp"
#include "carom/base/error.hpp"

namespace carom {

using namespace analyses;

namespace {

constexpr std::uint64_t repetitions = 16, largest_population = 20000;
// Where a hit loses most of them, smaller populations die out.
constexpr std::uint64_t least_population = 300;
// Levels of the window that tell a slope and how it changes.
constexpr std::size_t least_levels = 4, most_levels = 64;
// A stage keeps at least this share, as far as hits allow.
constexpr double kept_by_stage = 0.3;

// Growth, time and weight at two levels, and how they change between them.
struct Slope {
  double weight, time, growth, variance, covariance;
  Slope(const PopulationRun& run, std::size_t from, std::size_t to) {
    const GrowthAtLevel &a = run.growth[from], &b = run.growth[to];
    weight = b.log_share + b.log_weight - a.log_share - a.log_weight;
    time = b.time - a.time;
    growth = b.growth - a.growth;
    variance = b.time_variance - a.time_variance;
    covariance = b.covariance - a.covariance;
  }
  // By how much the escape rate is above the tilt: there the weights of both levels are equal.
  double untilted() const { return -weight / time; }
  double duration() const { return time + untilted() * variance; }
  double per_time() const { return (growth + untilted() * covariance) / duration(); }
  double stretching() const { return growth + untilted() * covariance; }
};

bool all_reach(const SplittingResult& result, std::size_t level) {
  return std::all_of(result.runs.begin(), result.runs.end(), [&](const auto& runs) {
    return std::all_of(runs.begin(), runs.end(),
                       [&](const PopulationRun& run) { return run.growth.at(level).number > 0; });
  });
}

double mean_time(const SplittingResult& result, std::size_t level) {
  double sum = 0.0;
  for (const PopulationRun& run : result.runs.back()) sum += run.growth[level].time;
  return sum / static_cast<double>(result.runs.back().size());
}

// What small populations tell: how fast trajectories leave, and how long a hit takes.
struct TrialRun {
  double rate = 0.0;          // per time
  double flight = 0.0;        // mean time of a hit
  double rate_of_hits = 0.0;  // per hit
  bool complete = true;
};

[[noreturn]] void refuse(const std::string& key, const std::string& problem,
                         const std::string& expected) {
  throw InputError(Place{{}, 0, 0, key}, problem, expected);
}

TrialRun trial_run_of(const System& system, SplittingPlan plan, double until,
                      const SplittingOptions& options) {
  constexpr std::size_t count = 12;
  plan.population = 1000;
  plan.repetitions = 2;
  plan.kick = SplittingPlan::largest_choice;
  for (double stride = 1.0;; stride *= 4.0) {
    plan.levels.clear();
    for (std::size_t i = 0; i < count; ++i) plan.levels.push_back(stride * static_cast<double>(i));
    const SplittingResult result = run_splitting(system, plan, options);
    if (!result.complete) return {0.0, 0.0, 0.0, false};
    std::size_t last = count;
    while (last > 0 && !all_reach(result, last - 1)) --last;
    if (last < 2)
      refuse("table",
             fmt::format("no trajectory stays for {} hits: there is no exponent to measure",
                         static_cast<std::uint64_t>(plan.levels[1]) + 1),
             "a table that keeps some of them");
    const PopulationRun& run = result.runs.back().front();
    const Slope slope(run, 0, last - 1);
    const double hits = plan.levels[last - 1] - plan.levels[0];
    const double left = -slope.weight;
    if (last == count && left < 1.0 && mean_time(result, last - 1) < until) continue;
    return {std::max(0.0, left / slope.time), slope.time / hits, std::max(0.0, left / hits), true};
  }
}

}  // namespace

Estimate RepellerExponent::estimate() const {
  const double statistics = per_time.limit.error, kicks = per_time.extrapolation;
  return {per_time.limit.value, std::sqrt(statistics * statistics + kicks * kicks)};
}

bool RepellerExponent::drifts() const {
  const double chance = base::student_quantile(0.999, static_cast<double>(change.repetitions - 1)) *
                        change.limit.error;
  return std::fabs(change.limit.value) > chance + change.extrapolation;
}

bool is_open(const System& system) {
  if (system.is_integrated() || system.of_discs() || system.particles.size() != 1 ||
      !system.injections.empty() || system.run.collisions > 0)
    return false;
  const Table& table = *system.table;
  return table.extent == Extent::open_plane ||
         std::any_of(table.walls.begin(), table.walls.end(),
                     [](const Wall& wall) { return !wall.holes.empty(); });
}

std::uint64_t least_of_repeller() { return repetitions * kick_sizes * least_population; }

std::optional<RepellerExponent> measure_repeller(const System& system, TimeWindow window,
                                                 double unit_length,
                                                 const SplittingOptions& options) {
  if (system.run.trajectories < least_of_repeller())
    refuse("run.trajectories",
           fmt::format("{} {} too few to keep populations alive",
                       base::counted(system.run.trajectories, "trajectory"),
                       system.run.trajectories == 1 ? "is" : "are"),
           fmt::format("at least {}", least_of_repeller()));
  SplittingPlan plan;
  plan.by = SplittingPlan::Level::hits;
  plan.repetitions = repetitions;
  plan.population =
      std::min(largest_population, system.run.trajectories / (repetitions * kick_sizes));
  plan.deviations = {unit_length, 0.0};
  const TrialRun trial = trial_run_of(system, plan, window.to, options);
  if (!trial.complete) return std::nullopt;
  plan.deviations->tilt = trial.rate;
  // Levels: as far apart as a stage may lose, and not too many.
  const double hits = std::floor(window.to / trial.flight) - 1.0;
  const double by_loss = trial.rate_of_hits > 0.0
                             ? -elementary::log(kept_by_stage) / trial.rate_of_hits
                             : hits / least_levels;
  const double stride = std::max({1.0, std::floor(std::min(by_loss, hits / 8.0)),
                                  std::ceil(hits / static_cast<double>(most_levels))});
  for (double level = 0.0; level <= hits; level += stride) plan.levels.push_back(level);
  // The first level at which the window has begun.
  const auto first =
      static_cast<std::size_t>(std::max(1.0, std::ceil(window.from / (trial.flight * stride))));
  if (plan.levels.size() < first + least_levels)
    refuse("run.t_max",
           fmt::format("trajectories make {} hits in the window: too few for an exponent",
                       static_cast<std::uint64_t>((window.to - window.from) / trial.flight)),
           fmt::format("at least {:.3g} (--t-max), with an early start of the window",
                       2.0 * least_levels * trial.flight * stride));
  const SplittingResult result = run_splitting(system, plan, options);
  if (!result.complete) return std::nullopt;
  const std::size_t last = plan.levels.size() - 1, middle = (first + last) / 2;
  if (!all_reach(result, last))
    refuse("run.trajectories", "a population died out before the end of the window",
           "more trajectories, or a shorter run (--t-max)");
  const auto of = [&](auto number, std::size_t from, std::size_t to) {
    return extrapolated(result, [&, number, from, to](std::size_t k, std::size_t r) {
      return number(Slope(result.runs[k][r], from, to));
    });
  };
  const auto per_time = [](const Slope& s) { return s.per_time(); };
  RepellerExponent out;
  out.per_time = of(per_time, first, last);
  out.per_hit =
      of([&](const Slope& s) { return s.stretching() / (plan.levels[last] - plan.levels[first]); },
         first, last);
  out.early = of(per_time, first, middle);
  out.late = of(per_time, middle, last);
  out.change = extrapolated(result, [&](std::size_t k, std::size_t r) {
    const PopulationRun& run = result.runs[k][r];
    return Slope(run, middle, last).per_time() - Slope(run, first, middle).per_time();
  });
  out.population = plan.population;
  out.hits = static_cast<std::uint64_t>(plan.levels[last]) + 1;
  out.hits_from = static_cast<std::uint64_t>(plan.levels[first]) + 1;
  out.time = mean_time(result, last);
  out.time_from = mean_time(result, first);
  out.kick = result.plan.kick;
  out.kick_cost = cost_of_kicks(result, last);
  for (const auto& runs : result.runs)
    for (const PopulationRun& run : runs) out.trapped = std::max(out.trapped, run.trapped);
  return out;
}

}  // namespace carom
