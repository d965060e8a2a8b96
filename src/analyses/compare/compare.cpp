#include "carom/analyses/compare.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analyses/compare/orders.hpp"
#include "analyses/compare/setting.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"

namespace carom {

using namespace analyses;

namespace {

/// Steps of each scheme: the longest one, halved so often less one. Above order 4 those between are
/// taken, too: errors reach rounding after two or three halvings.
constexpr int most_steps = 10, dense_from = 5;
/// Between a step and its half.
constexpr double between_halves = 2.0 / 3.0;
constexpr double chosen_tolerances[] = {1e-3, 1e-4,  1e-5,  1e-6,  1e-7, 1e-8,
                                        1e-9, 1e-10, 1e-11, 1e-12, 1e-13};
/// The way back leads to the start except for rounding: of the way there, of the way back, and of
/// the growth along both.
constexpr double rounding_of_reversal = 16.0;

void refuse_systems(const System& system) {
  if (system.of_discs())
    throw InputError(Place{{}, 0, 0, "interaction.kind"},
                     "hard discs fly and collide exactly: there is nothing to integrate",
                     "a soft interaction, or no interaction");
  if (!system.injections.empty())
    throw InputError(system.injections.front().place,
                     "particles that enter during a run are not compared",
                     "a system without [[injection]]");
}

std::vector<std::string> names_in(const System& system, const ComparePlan& plan) {
  if (plan.schemes.empty()) return default_comparison(system);
  const Place place{"command line", 0, 0, "--schemes"};
  std::vector<std::string> names;
  for (const std::string& name : plan.schemes) {
    if (!is_adaptive(name)) find_scheme(name, place);
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw InputError(place, "'" + name + "' is named twice");
    names.push_back(name);
  }
  return names;
}

/// From the coarsest on, each once.
std::vector<double> falling(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end(), std::greater<>());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

void check_turns(const System& system, const ComparePlan& plan) {
  double omega = 0.0;
  for (const Particle& p : system.particles) omega = std::max(omega, std::fabs(p.omega));
  for (const double step : plan.steps) {
    try {
      check_turn({.scheme = "", .step = step}, omega, !system.table->walls.empty());
    } catch (const InputError& error) {
      throw InputError(Place{"command line", 0, 0, "--steps"}, error.problem(), error.expected());
    }
  }
}

/// Hits that two orbits have in common, and how far they are apart.
void compare_hits(const Orbit& reference, const Orbit& orbit, ComparedRun& run) {
  const std::size_t most = std::min(reference.hits.size(), orbit.hits.size());
  std::size_t k = 0;
  for (; k < most; ++k) {
    const ComparedHit &a = reference.hits[k], &b = orbit.hits[k];
    if (a.particle != b.particle || a.wall != b.wall) break;
    run.error_hit_time = std::max(run.error_hit_time, std::fabs(a.t - b.t));
    const geometry::Vector apart = a.place - b.place;
    run.error_hit_place = std::max(run.error_hit_place, std::sqrt(dot(apart, apart)));
  }
  run.hits = k;
  run.same_hits = k == reference.hits.size() && k == orbit.hits.size();
}

ComparedRun compared(const Setting& setting, const Orbit& orbit, double step, double tolerance) {
  ComparedRun run;
  run.step = step;
  run.tolerance = tolerance;
  run.failure = orbit.failure;
  run.steps = orbit.counts.steps;
  run.force_evaluations = orbit.counts.force_evaluations;
  if (run.failed()) return run;
  const StateDistance apart = distance(setting.reference, orbit);
  run.error_position = apart.position;
  run.error_velocity = apart.velocity;
  run.error_state = apart.in(setting.units);
  run.error_energy = orbit.energy_change;
  run.energy_trend = orbit.energy_trend;
  run.trend_error = orbit.trend_error;
  run.unresolved = orbit.counts.unresolved;
  run.cpu_seconds = orbit.cpu_seconds;
  run.rounding = setting.rounding(static_cast<double>(run.force_evaluations));
  if (orbit.reversal) run.error_reversal = orbit.reversal->in(setting.units);
  compare_hits(setting.reference, orbit, run);
  return run;
}

class Comparing {
 public:
  Comparing(const System& system, const ComparePlan& plan)
      : plan_(plan),
        runs_(system, plan.trajectory, plan.interrupted),
        setting_(setting_of(runs_, plan.t_max)) {}

  const Setting& setting() const { return setting_; }
  bool free() const { return runs_.free(); }

  ComparedScheme compare(const std::string& name) const {
    ComparedScheme scheme;
    scheme.name = name;
    scheme.adaptive = is_adaptive(name);
    if (!scheme.adaptive) scheme.order = find_scheme(name).order;
    if (scheme.adaptive)
      run_tolerances(scheme);
    else
      run_steps(scheme);
    std::vector<double> noise;
    for (const ComparedRun& run : scheme.runs)
      noise.push_back(setting_.noise(static_cast<double>(run.force_evaluations)));
    if (scheme.adaptive)
      scheme.measured.reason = "its steps vary";
    else
      scheme.measured = measured_order(scheme.runs, noise);
    if (plan_.error >= setting_.reference_error) scheme.work = work_for(scheme.runs, plan_.error);
    judge_reversal(scheme);
    const double step = scheme.adaptive ? setting_.longest_step : longest_followed(scheme);
    if (step > 0.0) {
      const double tolerance = scheme.adaptive ? scheme.runs.back().tolerance : 0.0;
      scheme.areas = defect_of_areas(runs_, setting_, by(name, step, tolerance), step);
      scheme.areas_step = step;
    }
    return scheme;
  }

 private:
  ComparedRun one(const std::string& name, double step, double tolerance) const {
    return compared(setting_,
                    runs_.fly(by(name, step, tolerance), setting_.t, Runs::Part::everything), step,
                    tolerance);
  }
  /// The adaptive ones choose their steps; but particles that meet within a range are looked for
  /// once a step.
  Dynamics by(const std::string& name, double step, double tolerance) const {
    const auto& forces = runs_.system().dynamics.forces;
    const bool by_range = forces && forces->interacts() && std::isfinite(forces->pair_range());
    if (is_adaptive(name)) step = by_range ? setting_.longest_step : 0.0;
    return runs_.by(name, step, tolerance);
  }

  void run_steps(ComparedScheme& scheme) const {
    if (!plan_.steps.empty()) {
      for (const double step : falling(plan_.steps))
        scheme.runs.push_back(one(scheme.name, step, 0.0));
      return;
    }
    std::vector<double> steps;
    double step = setting_.longest_step;
    for (int k = 0; k < most_steps; ++k, step *= 0.5) {
      steps.push_back(step);
      if (scheme.order >= dense_from) steps.push_back(between_halves * step);
    }
    for (const double length : steps) {
      scheme.runs.push_back(one(scheme.name, length, 0.0));
      const ComparedRun& last = scheme.runs.back();
      const double evaluations = static_cast<double>(std::max(last.force_evaluations, last.steps));
      if (2.0 * evaluations * runs_.weight() > most_evaluations) break;
      if (!last.failed() && last.error_state < setting_.noise(evaluations)) break;
    }
  }

  void run_tolerances(ComparedScheme& scheme) const {
    std::vector<double> tolerances = falling(plan_.tolerances);
    if (tolerances.empty())
      tolerances.assign(std::begin(chosen_tolerances), std::end(chosen_tolerances));
    for (const double tolerance : tolerances) {
      scheme.runs.push_back(one(scheme.name, 0.0, tolerance));
      const double evaluations = static_cast<double>(scheme.runs.back().force_evaluations);
      if (plan_.tolerances.empty() && 2.0 * evaluations * runs_.weight() > most_evaluations) break;
    }
  }

  static double longest_followed(const ComparedScheme& scheme) {
    for (const ComparedRun& run : scheme.runs)
      if (!run.failed()) return run.step;
    return 0.0;
  }

  /// The longest step that leads there and back tells, if its own error is far above rounding, and
  /// that so small that it is known how it grows.
  void judge_reversal(ComparedScheme& scheme) const {
    for (const ComparedRun& run : scheme.runs) {
      if (run.failed() || std::isnan(run.error_reversal)) continue;
      const double noise =
          rounding_of_reversal *
          std::max(run.rounding, setting_.rounding(static_cast<double>(run.steps)));
      if (!(run.error_state > noise) || noise > largest_error) return;
      scheme.reversible = run.error_reversal <= noise;
      return;
    }
  }

  const ComparePlan& plan_;
  Runs runs_;
  Setting setting_;
};

}  // namespace

std::vector<std::string> default_comparison(const System& system) {
  std::vector<std::string> names{"velocity-verlet",     "mclachlan-2",  "ruth-3",
                                 "forest-ruth-4",       "mclachlan-s5", "blanes-moan-srkn6b",
                                 "mclachlan-atela-5",   "yoshida-6",    "blanes-moan-srkn11b",
                                 "blanes-moan-srkn14a", "kahan-li-8",   "mclachlan-ss17"};
  const bool field = std::any_of(system.particles.begin(), system.particles.end(),
                                 [](const Particle& p) { return p.omega != 0.0; });
  if (field) names.insert(names.begin() + 2, {"spreiter-walter", "he-2", "he-4"});
  for (const char* adaptive : {"arkode", "cvode"}) names.emplace_back(adaptive);
  const std::string& own = system.dynamics.integrator.scheme;
  if (!own.empty() && std::find(names.begin(), names.end(), own) == names.end())
    names.push_back(own);
  return names;
}

void name_best_schemes(Comparison& result) {
  for (std::size_t k = 0; k < result.schemes.size(); ++k) {
    const std::optional<WorkForError>& work = result.schemes[k].work;
    if (!work) continue;
    const auto less = [&](const std::optional<std::size_t>& best, double WorkForError::*what) {
      return !best || (*work).*what < (*result.schemes[*best].work).*what;
    };
    if (less(result.cheapest, &WorkForError::force_evaluations)) result.cheapest = k;
    if (less(result.fastest, &WorkForError::cpu_seconds)) result.fastest = k;
  }
}

Comparison compare(const System& system, const ComparePlan& plan) {
  const Stopwatch watch;
  refuse_systems(system);
  const std::vector<std::string> names = names_in(system, plan);
  check_turns(system, plan);
  const Comparing comparing(system, plan);
  const Setting& setting = comparing.setting();
  Comparison result;
  result.t = setting.t;
  result.growth = setting.growth;
  result.size = setting.units.size;
  result.speed = setting.units.speed;
  result.error = plan.error;
  result.exact = comparing.free();
  if (!result.exact)
    result.reference =
        std::string(reference_scheme) + (setting.in_34_digits ? " in 34 digits" : "");
  result.reference_step = setting.reference_step;
  result.reference_error = setting.reference_error;
  for (const PlaneState& s : setting.reference.states.back())
    result.end.push_back({s.position.x, s.position.y, s.velocity.x, s.velocity.y});
  result.hits = setting.reference.hits.size();
  result.longest_resolved = setting.longest_resolved;
  for (const std::string& name : names) {
    try {
      result.schemes.push_back(comparing.compare(name));
    } catch (const SamplingStopped&) {
      result.complete = false;
      break;
    }
    if (plan.progress) plan.progress(result.schemes.size(), names.size());
  }
  name_best_schemes(result);
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  return result;
}

}  // namespace carom
