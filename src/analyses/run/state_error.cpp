#include "carom/analyses/run/state_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "carom/events/world.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"
#include "trust/displaced_orbit.hpp"

namespace carom {

using geometry::Vector;

namespace {

using trust::add_displaced;
using trust::displacement;
using trust::rounding_of_evaluation;
using trust::size_of_positions;

constexpr int compared_times = 64;
/// Two runs have separated where they are further from each other than this share of the way that
/// they have gone.
constexpr double separated = 0.1;
/// The distance leaves out a quarter of the error at order 2, and more where the steps are too long
/// for their order. With a tolerance the error falls less regularly.
constexpr double margin = 2.0, margin_of_adaptive = 3.0;
/// At one look a distance may happen to be small: the largest of this many is taken.
constexpr int latest = 8;
/// Both runs are rounded, by a few units a step: what they have in common of it is not seen in
/// their distance.
constexpr double rounding = 0x1p-51;
/// A pass through the outermost part of a bump, which is left out, turns a velocity v by this times
/// tail/(m v^2) at most: a force of tail/w in units of the width w, times the distance in units of
/// w (8.6), over a way of 2.5 w, for a Gaussian.
constexpr double turn_by_tail = 32.0;

IntegratorPlan finer(IntegratorPlan plan) {
  if (is_adaptive(plan.scheme))
    plan.tolerance = std::max(least_tolerance,
                              (plan.tolerance > 0.0 ? plan.tolerance : default_tolerance) / 64.0);
  plan.step *= 0.5;
  // Where one run halves its steps the other one takes half of what is left of them.
  if (plan.halve_unresolved) plan.resolution_margin *= 2.0;
  return plan;
}

State state_of(const World& world, int particle, double t) {
  return world.finished(particle) ? world.state(particle) : world.state_at(particle, t);
}

}  // namespace

std::optional<StateError> state_error(const System& system, std::uint64_t trajectory, double t_end,
                                      const std::function<bool()>& stopped,
                                      const std::vector<State>& reached) {
  if (!system.has_forces() || !(t_end > 0.0) || !std::isfinite(t_end)) return {};
  const Table& table = *system.table;
  Dynamics fine = system.dynamics;
  fine.integrator = finer(fine.integrator);
  World as_run(table, system.dynamics), finely(table, fine), displaced(table, system.dynamics);
  const Sampler sampler(system, stopped);
  add_starts(as_run, sampler, trajectory);
  add_starts(finely, sampler, trajectory);
  const double size = trust::size_of_positions(system, as_run, t_end / compared_times),
               tail = system.dynamics.forces->tail_bound();
  trust::add_displaced(displaced, as_run, size);
  const int count = as_run.size();
  const double n = static_cast<double>(count);
  const auto plane = [&](const State& s) {
    return table.lattice ? s.position + table.lattice->translation(s.cell) : s.position;
  };
  std::vector<Vector> starts;
  for (int i = 0; i < count; ++i) starts.push_back(plane(as_run.state(i)));
  StateError error;
  double way = 0.0, fastest = 0.0, farthest = 0.0, lightest = as_run.particle(0).mass;
  for (int i = 1; i < count; ++i) lightest = std::min(lightest, as_run.particle(i).mass);
  std::array<StateError, latest> apart;  // distances from the finer run
  StateError grown;                      // the largest from the displaced one so far
  double growth = 1.0;                   // that, in units of the displacement
  double evaluated = 0.0,
         rounded = 0.0;  // evaluations; each over the square of the growth before it
  Observer observer;
  for (int look = 1; look <= compared_times; ++look) {
    const double t = t_end * look / compared_times;
    as_run.run_until(t, observer, stopped);
    finely.run_until(t, observer, stopped);
    displaced.run_until(t, observer, stopped);
    if (stopped && stopped()) return {};
    StateError& now = apart[static_cast<std::size_t>(look % latest)] = {};
    for (int i = 0; i < count; ++i) {
      if (as_run.fate(i) == Fate::unresolved) return {};
      const State a = state_of(as_run, i, t), b = state_of(finely, i, t),
                  c = state_of(displaced, i, t);
      now.position = std::max(now.position, length(plane(a) - plane(b)));
      now.velocity = std::max(now.velocity, length(a.velocity - b.velocity));
      grown.position = std::max(grown.position, length(plane(a) - plane(c)));
      grown.velocity = std::max(grown.velocity, length(a.velocity - c.velocity));
      fastest = std::max(fastest, length(a.velocity));
      farthest = std::max(farthest, length(a.position));
      way = std::max(way, length(plane(a) - starts[static_cast<std::size_t>(i)]));
    }
    const double steps = static_cast<double>(as_run.step_counts().steps), compared = steps * n * n;
    // A rounding grows only from the time at which it is made.
    const double evaluations = static_cast<double>(as_run.step_counts().force_evaluations);
    rounded += (evaluations - evaluated) / (growth * growth);
    evaluated = evaluations;
    growth = std::max({growth, grown.position / (displacement * size),
                       grown.velocity / (displacement * fastest)});
    double share = rounding_of_evaluation * std::sqrt(rounded) * std::max(1.0, farthest / size);
    if (tail > 0.0)
      share += turn_by_tail * tail / (lightest * fastest * fastest) *
               std::sqrt(1.0 + fastest * t / size);
    error = {share / displacement * grown.position + rounding * steps * (farthest + fastest * t),
             share / displacement * grown.velocity + rounding * steps * fastest, t};
    StateError most;
    for (const StateError& one : apart) {
      most.position = std::max(most.position, one.position);
      most.velocity = std::max(most.velocity, one.velocity);
    }
    const double times =
        is_adaptive(system.dynamics.integrator.scheme) ? margin_of_adaptive : margin;
    error.position += times * most.position;
    error.velocity += times * most.velocity;
    if (look == compared_times && !reached.empty()) {
      StateError parts;
      for (int i = 0; i < count; ++i) {
        const State a = state_of(as_run, i, t), b = reached[static_cast<std::size_t>(i)];
        parts.position = std::max(parts.position, length(plane(a) - plane(b)));
        parts.velocity = std::max(parts.velocity, length(a.velocity - b.velocity));
      }
      error.position += parts.position;
      error.velocity += parts.velocity;
    }
    if (error.position > separated * way || compared > most_compared) break;
  }
  return error;
}

}  // namespace carom
