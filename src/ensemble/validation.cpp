#include "carom/ensemble/validation.hpp"

#include <cmath>

#include "carom/base/error.hpp"
#include "carom/ensemble/escape.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/events/world.hpp"

namespace carom {

namespace {

struct Flights : Observer {
  double sum = 0.0;
  std::uint64_t hits = 0;
  void hit(const HitEvent& event) override {
    sum += event.flight_time;
    ++hits;
  }
};

}  // namespace

Comparison mean_flight(const System& system, double expected) {
  if (system.run.trajectories < 2 || system.run.collisions == 0)
    throw InternalError("a mean flight needs trajectories and a number of hits");
  const Sampler sampler(system);
  World world(*system.table);
  world.limit_hits(system.run.collisions);
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t i = 0; i < system.run.trajectories; ++i) {
    Flights flights;
    world.clear();
    add_start(world, sampler, i, 0);
    world.run_until(system.run.t_max, flights);
    const double mean = flights.sum / static_cast<double>(flights.hits) - expected;
    sum += mean;
    squares += mean * mean;
  }
  const double n = static_cast<double>(system.run.trajectories);
  const double mean = sum / n;
  return {expected + mean, std::sqrt((squares / n - mean * mean) / (n - 1.0)), expected};
}

Soak soak(const System& system, int threads) {
  EscapeOptions options;
  options.threads = threads;
  const EscapeResult result = run_escape(system, options);
  Soak s;
  s.hits = result.counts.collisions;
  s.lost = result.counts.lost;
  s.singular = result.counts.singular;
  s.digest = result.digest;
  const double filter = static_cast<double>(result.decisions.filter);
  s.filter_share = filter / (filter + static_cast<double>(result.decisions.exact));
  s.cpu_seconds = result.cpu_seconds;
  if (!result.reports.empty()) s.report = result.reports.front();
  return s;
}

}  // namespace carom
