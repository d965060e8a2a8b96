#include "carom/ensemble/state_error.hpp"

#include <algorithm>
#include <cmath>

#include "carom/ensemble/sampler.hpp"
#include "carom/events/world.hpp"
#include "carom/integrators/scheme.hpp"

namespace carom {

using geometry::Vector;

namespace {

constexpr int looks = 64;
/// Runs have parted where they are further from each other than this share of the way that they have gone.
constexpr double parted = 0.1;
/// The distance leaves out a quarter of the error at order 2, and more where the steps are too long for their order.
constexpr double margin = 2.0;
/// Both runs are rounded, by a few units a step: what they have in common of it is not seen in their distance.
constexpr double rounding = 0x1p-51;

IntegratorPlan finer(IntegratorPlan plan) {
  if (is_adaptive(plan.scheme))
    plan.tolerance = std::max(least_tolerance, (plan.tolerance > 0.0 ? plan.tolerance : default_tolerance) / 64.0);
  plan.step *= 0.5;
  return plan;
}

State state_of(const World& world, int particle, double t) {
  return world.finished(particle) ? world.state(particle) : world.state_at(particle, t);
}

double length(Vector a) { return std::sqrt(dot(a, a)); }

}  // namespace

std::optional<StateError> state_error(const System& system, std::uint64_t trajectory, double t_end,
                                      const std::function<bool()>& stopped) {
  if (!system.dynamics.forces || system.dynamics.forces->empty() || !(t_end > 0.0) || !std::isfinite(t_end)) return {};
  const Table& table = *system.table;
  Dynamics fine = system.dynamics;
  fine.integrator = finer(fine.integrator);
  World as_run(table, system.dynamics), finely(table, fine);
  const Sampler sampler(system, stopped);
  add_starts(as_run, sampler, trajectory);
  add_starts(finely, sampler, trajectory);
  const int count = as_run.size();
  const double n = static_cast<double>(count);
  const auto plane = [&](const State& s) {
    return table.lattice ? s.position + table.lattice->translation(s.cell) : s.position;
  };
  std::vector<Vector> starts;
  for (int i = 0; i < count; ++i) starts.push_back(plane(as_run.state(i)));
  StateError error;
  double way = 0.0, fastest = 0.0, farthest = 0.0;
  Observer observer;
  for (int look = 1; look <= looks; ++look) {
    const double t = t_end * look / looks;
    as_run.run_until(t, observer, stopped);
    finely.run_until(t, observer, stopped);
    if (stopped && stopped()) return {};
    error = {0.0, 0.0, t};
    for (int i = 0; i < count; ++i) {
      if (as_run.fate(i) == Fate::unresolved) return {};
      const State a = state_of(as_run, i, t), b = state_of(finely, i, t);
      error.position = std::max(error.position, margin * length(plane(a) - plane(b)));
      error.velocity = std::max(error.velocity, margin * length(a.velocity - b.velocity));
      fastest = std::max(fastest, length(a.velocity));
      farthest = std::max(farthest, length(a.position));
      way = std::max(way, length(plane(a) - starts[static_cast<std::size_t>(i)]));
    }
    const double steps = static_cast<double>(as_run.step_counts().steps), compared = steps * n * n;
    error.position += rounding * steps * (farthest + fastest * t);
    error.velocity += rounding * steps * fastest;
    if (error.position > parted * way || compared > most_compared) break;
  }
  return error;
}

}  // namespace carom
