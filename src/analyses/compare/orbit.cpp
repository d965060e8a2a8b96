#include "analyses/compare/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carom/base/stopwatch.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/observer.hpp"
#include "carom/events/report.hpp"
#include "carom/integrators/scheme.hpp"
#include "carom/starts/sampler.hpp"

namespace carom::analyses {

using geometry::Vector;

namespace {

/// A run is repeated until all have taken this long, or so often: the least time is taken. The
/// first one computes the bounds of forces that the others only look up.
constexpr double enough_seconds = 4e-3, long_enough = 0.1;
constexpr int fewest_repetitions = 3, most_repetitions = 16;
/// Means over this many parts of the run are independent except for oscillations that last longer.
constexpr int blocks = 8;

class HitList : public Observer {
 public:
  HitList(const Table& table, std::vector<ComparedHit>& hits) : table_(table), hits_(hits) {}
  void hit(const HitEvent& event) override {
    Vector place = event.position;
    if (table_.lattice) place = place + table_.lattice->translation(event.cell);
    hits_.push_back({event.particle, event.wall, event.time.value(), place});
  }

 private:
  const Table& table_;
  std::vector<ComparedHit>& hits_;
};

std::string failure_of(const World& world) {
  for (int i = 0; i < world.size(); ++i)
    if (is_failure(world.fate(i))) return std::string(shown(world.report(i)));
  return {};
}

/// The slope of the means of `blocks` parts against time, and its standard error by their scatter.
MeasuredNumber trend(const std::vector<double>& values, double t) {
  const std::size_t each = values.size() / blocks;
  std::vector<double> means(blocks), times(blocks);
  double mean = 0.0, middle = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t i = b * each; i < (b + 1) * each; ++i) {
      means[b] += values[i] / static_cast<double>(each);
      times[b] += t * static_cast<double>(i + 1) / static_cast<double>(values.size() * each);
    }
    mean += means[b] / blocks;
    middle += times[b] / blocks;
  }
  double along = 0.0, square = 0.0, left = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) {
    along += (times[b] - middle) * (means[b] - mean);
    square += (times[b] - middle) * (times[b] - middle);
  }
  const double slope = along / square;
  for (std::size_t b = 0; b < blocks; ++b) {
    const double rest = means[b] - mean - slope * (times[b] - middle);
    left += rest * rest;
  }
  return {slope, std::sqrt(left / ((blocks - 2) * square))};
}

}  // namespace

State state_of(const World& world, int particle, double t) {
  return world.finished(particle) ? world.state(particle) : world.state_at(particle, t);
}

PlaneState in_the_plane(const Table& table, const State& state) {
  Vector position = state.position;
  if (table.lattice) position = position + table.lattice->translation(state.cell);
  return {position, state.velocity};
}

double StateDistance::in(const ErrorUnits& units) const {
  return std::max(position / units.size, velocity / units.speed);
}

StateDistance distance(const Orbit& a, const Orbit& b) {
  StateDistance most;
  for (std::size_t k = 0; k < a.states.size(); ++k) {
    for (std::size_t i = 0; i < a.states[k].size(); ++i) {
      const PlaneState &one = a.states[k][i], &other = b.states[k][i];
      most.position = larger(most.position, length(one.position - other.position));
      most.velocity = larger(most.velocity, length(one.velocity - other.velocity));
    }
  }
  return most;
}

Runs::Runs(const System& system, std::uint64_t trajectory, std::function<bool()> stopped)
    : system_(system), stopped_(std::move(stopped)), trajectory_(trajectory) {
  const World world(*system.table, by("", 1.0, 0.0));
  starts_ = Sampler(system, stopped_).draw_all(world, trajectory);
}

bool Runs::free() const { return !system_.has_forces(); }

double Runs::weight() const {
  const double n = static_cast<double>(system_.particles.size());
  return !free() && system_.dynamics.forces->interacts() ? std::max(1.0, 0.5 * n * (n - 1.0)) : n;
}

Dynamics Runs::by(const std::string& scheme, double step, double tolerance) const {
  Dynamics dynamics = system_.dynamics;
  dynamics.everywhere = dynamics.everywhere || free();
  dynamics.integrator.scheme = scheme;
  dynamics.integrator.step = step;
  dynamics.integrator.halve_unresolved = false;
  dynamics.integrator.tolerance = tolerance;
  return dynamics;
}

void Runs::add_starts(World& world) const {
  world.clear();
  for (std::size_t i = 0; i < starts_.size(); ++i)
    add_start(world, system_, starts_[i], trajectory_, static_cast<int>(i));
}

void Runs::stop_if_asked() const {
  if (stopped_ && stopped_()) throw SamplingStopped();
}

void Runs::observe(World& world, double t, Orbit& orbit) const {
  const Table& table = *system_.table;
  HitList list(table, orbit.hits);
  std::vector<Particle> particles;
  for (int i = 0; i < world.size(); ++i) particles.push_back(world.particle(i));
  std::vector<State> states = starts_;
  const Dynamics& dynamics = system_.dynamics;
  const Energy start = energy_of(particles, states, dynamics, table);
  const double at_start = start.total();
  double kinetic = start.kinetic, change = 0.0;
  std::vector<double> changes;
  for (int look = 1; look <= looks; ++look) {
    const double now = t * look / looks;
    world.run_until(now, list, stopped_);
    stop_if_asked();
    for (int i = 0; i < world.size(); ++i)
      states[static_cast<std::size_t>(i)] = state_of(world, i, now);
    const Energy energy = energy_of(particles, states, dynamics, table);
    kinetic = std::max(kinetic, energy.kinetic);
    changes.push_back(energy.total() - at_start);
    change = larger(change, std::fabs(changes.back()));
    const bool compared =
        look > looks - states_compared * looks_between_states && look % looks_between_states == 0;
    if (compared) {
      std::vector<PlaneState>& plane = orbit.states.emplace_back();
      for (const State& s : states) plane.push_back(in_the_plane(table, s));
    }
  }
  orbit.energy_change = relative_to(kinetic, change);
  for (int i = 0; i < world.size(); ++i)
    orbit.energy_change =
        larger(orbit.energy_change, world.energy_balance(i).error_at_end(0.0, 0.0).largest);
  const MeasuredNumber slope = trend(changes, t);
  orbit.energy_trend = relative_to(kinetic, slope.value);
  if (slope.value < 0.0) orbit.energy_trend = -std::fabs(orbit.energy_trend);
  orbit.trend_error = relative_to(kinetic, slope.error);
}

void Runs::time(World& world, double t, Orbit& orbit) const {
  double least = std::numeric_limits<double>::infinity(), all = 0.0;
  Observer none;
  for (int k = 0; k < most_repetitions && (k < fewest_repetitions || all < enough_seconds) &&
                  all < long_enough;
       ++k) {
    add_starts(world);
    const Stopwatch watch;
    world.run_until(t, none, stopped_);
    const double seconds = watch.cpu_seconds();
    stop_if_asked();
    least = std::min(least, seconds);
    all += seconds;
  }
  orbit.cpu_seconds = least;
  orbit.counts = world.step_counts();
}

// From the end of the last whole step back to that of the first one: on the way back steps begin
// where they ended, and a start at a wall is not met. A single step leaves no way between.
void Runs::turn_back(World& world, double step, double t, Orbit& orbit) const {
  const double first = step > 0.0 ? std::min(step, t) : t / looks;
  // A quotient that was rounded to just below a whole number is this number. Where 2^-40 is too
  // much, the way back begins so much later than t, and what it tells is the same.
  const double last = std::floor(t / first * (1.0 + 0x1p-40)) * first;
  if (!(last > first)) return;
  Observer none;
  std::vector<Particle> particles;
  std::vector<State> before, ends;
  const auto note = [&](double now, std::vector<State>& states) {
    world.run_until(now, none, stopped_);
    stop_if_asked();
    for (int i = 0; i < world.size(); ++i)
      if (!world.finished(i)) states.push_back(world.state_at(i, now));
  };
  add_starts(world);
  for (int i = 0; i < world.size(); ++i) particles.push_back(world.particle(i));
  note(first, before);
  note(last, ends);
  if (ends.size() < particles.size()) return;
  world.clear();
  try {
    for (std::size_t i = 0; i < ends.size(); ++i) {
      State back = ends[i];
      back.velocity = -1.0 * back.velocity;
      back.time = Time(0.0);
      particles[i].omega = -particles[i].omega;
      particles[i].speed = length(back.velocity);
      world.add(particles[i], back);
    }
  } catch (const std::invalid_argument&) {  // rounding has put the end beside a wall
    return;
  }
  world.run_until(last - first, none, stopped_);
  stop_if_asked();
  StateDistance& most = orbit.reversal.emplace();
  for (int i = 0; i < world.size(); ++i) {
    const PlaneState there = in_the_plane(*system_.table, state_of(world, i, last - first)),
                     start = in_the_plane(*system_.table, before[static_cast<std::size_t>(i)]);
    most.position = larger(most.position, length(there.position - start.position));
    most.velocity = larger(most.velocity, length(there.velocity + start.velocity));
  }
}

Orbit Runs::fly(const Dynamics& dynamics, double t, Part part) const {
  Orbit orbit;
  World watched(*system_.table, dynamics);
  watched.watch_energy();
  add_starts(watched);
  observe(watched, t, orbit);
  orbit.failure = failure_of(watched);
  orbit.counts = watched.step_counts();
  if (part == Part::orbit || !orbit.failure.empty()) return orbit;
  World plain = watched.empty_copy();
  time(plain, t, orbit);
  turn_back(plain, is_adaptive(dynamics.integrator.scheme) ? 0.0 : dynamics.integrator.step, t,
            orbit);
  return orbit;
}

}  // namespace carom::analyses
