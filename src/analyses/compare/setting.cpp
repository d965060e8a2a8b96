#include "analyses/compare/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analyses/compare/precise_orbit.hpp"
#include "base/counted.hpp"
#include "carom/engines/choose_step.hpp"
#include "trust/displaced_orbit.hpp"

namespace carom::analyses {

using geometry::Vector;

namespace {

/// Neighbouring orbits may separate by so much: their errors are then still in proportion to what
/// schemes do in a step.
constexpr double most_growth = 100.0;
/// The comparison lasts as long as this many of the steps that would be chosen, at most.
constexpr int most_steps = 1024, steps_between_looks = 4;
/// An orbit that ends is compared until shortly before.
constexpr double share_of_ending = 0.95;
/// Free particles: steps in the time in which the fastest goes the table's size.
constexpr double steps_a_size = 8.0;
/// Longer steps than the chosen one that are tried, and halvings of the longest until the
/// reference.
constexpr int longer_steps = 6, most_halvings = 12;
/// Halving the step changes an error of the reference's order 8 by 2^8: what is left after it is
/// far below the change. Twice the change is as safe as what `carom run` states.
constexpr double margin = 2.0;
/// Changes fall by 2^8 where the order counts; by half of that twice running, it is seen.
constexpr double falls = 0x1p7;
/// A change that grows again is that of rounding only if it is at most this many times as large.
constexpr double near_rounding = 64.0;

double first_step(const Runs& runs, double size, double speed) {
  const System& system = runs.system();
  if (runs.free()) {
    double step = size / (steps_a_size * speed);
    while (!turn_allowed(system, step)) step *= 0.5;
    return step;
  }
  if (system.dynamics.integrator.step_chosen) return system.dynamics.integrator.step;
  System without = system;
  without.dynamics.integrator = IntegratorPlan{};
  return choose_step(without,
                     [&] {
                       runs.stop_if_asked();
                       return false;
                     })
      .step;
}

/// How far a displaced orbit is from the orbit, in units of the displacement, at equal
/// times.
struct Growth {
  double between = 0.0;                                  ///< two times
  std::vector<double> grown;                             ///< the largest until then
  std::vector<double> rounded;                           ///< what is rounded then, over the size
  double end = std::numeric_limits<double>::infinity();  ///< of the first particle that ends
};

Growth growth_of(const Runs& runs, const Dynamics& dynamics, double between, double until,
                 const ErrorUnits& units) {
  const Table& table = *runs.system().table;
  World orbit(table, dynamics), beside(table, dynamics);
  runs.add_starts(orbit);
  trust::add_displaced(beside, orbit, units.size);
  Growth result{between, {}, {}};
  double grown = 1.0;
  for (int k = 1; (k - 1) * between < until; ++k) {
    const double t = std::min(k * between, until);
    orbit.run_until(t);
    beside.run_until(t);
    runs.stop_if_asked();
    double farthest = units.size;
    for (int i = 0; i < orbit.size(); ++i) {
      if (orbit.finished(i) && orbit.fate(i) != Fate::pinned) {
        result.end = std::min(result.end, orbit.state(i).time.value());
        continue;
      }
      const State state = state_of(orbit, i, t);
      farthest = std::max(farthest, length(state.position));
      const PlaneState one = in_the_plane(table, state),
                       other = in_the_plane(table, state_of(beside, i, t));
      grown = std::max(
          {grown, length(one.position - other.position) / (trust::displacement * units.size),
           length(one.velocity - other.velocity) / (trust::displacement * units.speed)});
    }
    result.grown.push_back(grown);
    result.rounded.push_back(farthest / units.size);
    if (std::isfinite(result.end)) break;
  }
  return result;
}

/// The latest of the times at which the growth is known until which it is below its limit; their
/// number is one of three binary digits, so that times and their halves are short numbers.
double time_of(const Growth& growth) {
  int k = 1;
  while (k < static_cast<int>(growth.grown.size()) &&
         growth.grown[static_cast<std::size_t>(k)] <= most_growth)
    ++k;
  int unit = 1;
  while (k / unit >= 8) unit *= 2;
  return k / unit * unit * growth.between;
}

void set_growth(const Growth& growth, Setting& setting) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < growth.grown.size(); ++k) {
    if (k > 0 && static_cast<double>(k + 1) * growth.between > 1.0001 * setting.t) break;
    setting.growth = growth.grown[k];
    const double share = growth.rounded[k] / growth.grown[k];
    sum += share * share;
    ++count;
  }
  setting.rounded = setting.growth * std::sqrt(sum / std::max(1, count));
}

/// The orbit by exact flights.
void fly_exactly(const Runs& runs, Setting& setting) {
  Dynamics dynamics = runs.system().dynamics;
  dynamics.everywhere = false;
  setting.reference = runs.fly(dynamics, setting.t, Runs::Part::orbit);
  const double flights = static_cast<double>(setting.reference.hits.size()) + 1.0;
  setting.reference_error = rounding_of_flight * std::sqrt(flights) * setting.rounded;
}

/// By how much halving the step changes an orbit, again and again.
struct Changes {
  static constexpr double unknown = std::numeric_limits<double>::infinity();
  double first = unknown, last = unknown, before = unknown, least = unknown;
  /// The largest, each halved as often as the step since: what is left of errors in proportion to
  /// the step.
  double in_proportion = 0.0;
  int count = 0, count_at_least = 0;
  int falling = 0;  ///< of the last ones, those that fell as the order of the reference says
  bool order_seen = false;

  void add(double change) {
    before = last;
    last = change;
    if (count == 0) first = change;
    if (change < least) {
      least = change;
      count_at_least = count;
    }
    ++count;
    falling = before < unknown && before > falls * change ? falling + 1 : 0;
    order_seen = order_seen || falling > 1;
    in_proportion = larger(0.5 * in_proportion, change);
  }
  /// Of the last orbit. A change may be small by chance: without an order the one before counts.
  double error() const {
    return margin * (order_seen || before == unknown ? last : std::max(last, before));
  }
  /// From the first to the least they fall less than those of order 3.
  bool slow() const { return first < std::ldexp(least, 3 * count_at_least); }
};

/// The orbit of the reference scheme with the step at which half of it changes least. Returns that
/// step. Where changes fall neither as its order says nor to rounding: the orbit with the shortest
/// step, whose error is in proportion to the step, as those of forces that jump are; and 0 if 34
/// digits help no more.
double integrate(const Runs& runs, Setting& setting) {
  Orbit before;
  std::string failure;
  Changes changes;
  double step = setting.longest_step, shortest = 0.0, best = 0.0;
  bool rounded = false;
  for (int k = 0; k <= most_halvings; ++k, step *= 0.5) {
    Orbit now = runs.fly(runs.by(reference_scheme, step, 0.0), setting.t, Runs::Part::orbit);
    if (!now.failure.empty()) {
      failure = now.failure;
      continue;
    }
    if (!before.states.empty()) {
      changes.add(distance(before, now).in(setting.units));
      const double evaluations = static_cast<double>(now.counts.force_evaluations);
      const bool least = changes.count_at_least + 1 == changes.count;
      if (least) {
        best = step;
        setting.reference = now;
        setting.reference_step = step;
        setting.reference_error = changes.error();
        setting.reference_evaluations = evaluations;
      }
      // Rounding grows with the number of steps: from here on shorter ones help no more.
      rounded = changes.least <= near_rounding * setting.rounding(evaluations);
      if (!least && rounded) break;
    }
    before = std::move(now);
    shortest = step;
    const double cost = static_cast<double>(before.counts.force_evaluations) * runs.weight();
    if (cost > most_evaluations) {
      failure =
          fmt::format("{} of {:.2g} take {:.1e} evaluations of a force, {:.0e} at most",
                      base::counted(before.counts.steps, "step"), step, cost, most_evaluations);
      break;
    }
  }
  if (!(best > 0.0))
    throw InputError(Place{}, "no reference was found: " + failure,
                     "a shorter time (--t-max), softer forces, or fewer particles");
  const bool kinks = !changes.order_seen && !rounded;
  if (kinks) {
    setting.reference_evaluations = static_cast<double>(before.counts.force_evaluations);
    setting.reference = std::move(before);
    setting.reference_step = shortest;
    setting.reference_error = margin * changes.in_proportion;
  }
  setting.rounding_error = setting.reference_error;
  // Orbits hit a wall with the same normal, rounded once: changes do not show it.
  setting.reference_error +=
      rounding_of_flight * static_cast<double>(setting.reference.hits.size()) * setting.growth;
  return kinks && changes.slow() ? 0.0 : best;
}

/// The same orbit in 34 digits; `step` is that of the best one in doubles, or 0. How far the orbit
/// in doubles is from it is what rounding has made of that.
void integrate_precisely(const Runs& runs, double step, Setting& setting) {
  if (!(step > 0.0)) return;
  const std::optional<PreciseOrbit> precise =
      precise_orbit(runs, reference_scheme, step, setting.t, setting.units, setting.reference.hits);
  if (!precise || !(precise->error < setting.reference_error)) return;
  Orbit orbit = setting.reference;
  orbit.states = precise->states;
  const double rounding = distance(setting.reference, orbit).in(setting.units);
  // Twice the stated error: then both are orbits of the same system.
  const double allowed = 2.0 * setting.reference_error;
  if (!(rounding <= allowed) || !same_hits(orbit.hits, precise->hits, allowed * setting.units.size))
    return;
  for (std::size_t k = 0; k < orbit.hits.size(); ++k) orbit.hits[k] = precise->hits[k].seen;
  setting.reference = std::move(orbit);
  setting.reference_step = precise->step;
  setting.reference_error = precise->error;
  setting.rounding_error =
      std::min(rounding, near_rounding * setting.rounding(setting.reference_evaluations));
  setting.in_34_digits = true;
}

}  // namespace

double Setting::rounding(double evaluations) const {
  return trust::rounding_of_evaluation * std::sqrt(evaluations + 1.0) * rounded;
}
double Setting::noise(double evaluations) const {
  if (!(reference_evaluations > 0.0)) return std::max(reference_error, rounding(evaluations));
  return std::max(reference_error,
                  rounding_error * std::sqrt(std::max(1.0, evaluations / reference_evaluations)));
}

Setting setting_of(const Runs& runs, double wanted) {
  const System& system = runs.system();
  Setting setting;
  double fastest = 0.0;
  for (const State& s : runs.starts()) fastest = std::max(fastest, length(s.velocity));
  World start(*system.table, runs.by("", 1.0, 0.0));
  runs.add_starts(start);
  for (int i = 0; i < start.size(); ++i)
    fastest = std::max(fastest, length(start.state(i).velocity));
  setting.units.speed = fastest > 0.0 ? fastest : 1.0;
  setting.units.size = trust::size_of_positions(system, start, 1.0);

  const double step = first_step(runs, setting.units.size, setting.units.speed);
  Dynamics dynamics = runs.free() ? system.dynamics : runs.by("", step, 0.0);
  if (runs.free()) dynamics.everywhere = false;
  const double between = steps_between_looks * step;
  const double until =
      wanted > 0.0 ? wanted : std::min(system.run.t_max, static_cast<double>(most_steps) * step);
  const Growth growth = growth_of(runs, dynamics, std::min(between, until), until, setting.units);
  setting.t = wanted > 0.0 ? wanted : std::min(time_of(growth), until);
  if (setting.t >= share_of_ending * growth.end) setting.t = share_of_ending * growth.end;
  if (!(setting.t > 0.0))
    throw InputError(Place{}, "the trajectory ends where it starts: there is nothing to compare",
                     "another start: --trajectory, --position and --velocity");
  set_growth(growth, setting);

  double longest = step;
  if (!runs.free()) {
    for (int k = 0; k < longer_steps; ++k) {
      const double twice = 2.0 * longest;
      if (twice > setting.t || !turn_allowed(system, twice) ||
          !runs.fly(runs.by("", twice, 0.0), setting.t, Runs::Part::orbit).failure.empty())
        break;
      longest = twice;
    }
    setting.longest_resolved = longest;
  }
  setting.longest_step = setting.t;
  while (setting.longest_step > longest) setting.longest_step *= 0.5;
  if (runs.free()) {
    fly_exactly(runs, setting);
  } else {
    integrate_precisely(runs, integrate(runs, setting), setting);
  }
  return setting;
}

}  // namespace carom::analyses
