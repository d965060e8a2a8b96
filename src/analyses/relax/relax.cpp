#include "carom/analyses/relax.hpp"

#include <gsl/gsl_errno.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <tuple>

#include "analyses/relax/eigen.hpp"
#include "analyses/relax/search.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "engines/parallel_blocks.hpp"

namespace carom {

using namespace analyses;
using geometry::Vector;

namespace {

/// An equilibrium with what does not change when it is turned, reflected or displaced.
struct Found {
  Equilibrium equilibrium;
  std::vector<double> distances;  ///< of pairs, sorted among equal kinds of pairs
};

/// Distances of pairs in one order for all copies: by the kinds of both particles, then by length.
std::vector<double> distances_of(const System& system, const Sites& sites) {
  using Kind = std::tuple<double, double, bool>;
  const auto kind = [&](std::size_t i) {
    const Particle& p = system.particles[i];
    return Kind{p.mass, p.charge, sites[i].wall >= 0};
  };
  std::vector<std::tuple<Kind, Kind, double>> pairs;
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (std::size_t j = i + 1; j < sites.size(); ++j) {
      const Vector d = sites[i].position - sites[j].position;
      const Kind a = kind(i), b = kind(j);
      pairs.emplace_back(std::min(a, b), std::max(a, b), std::sqrt(dot(d, d)));
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<double> distances;
  for (const auto& pair : pairs) distances.push_back(std::get<2>(pair));
  return distances;
}

// Equal to rounding: energies within their bounds, distances within the errors of four coordinates.
bool same(const Found& a, const Found& b) {
  const Equilibrium &p = a.equilibrium, &q = b.equilibrium;
  if (!(std::fabs(p.energy - q.energy) <= p.energy_error + q.energy_error)) return false;
  if (p.descending != q.descending) return false;
  for (std::size_t i = 0; i < a.distances.size(); ++i)
    if (!(std::fabs(a.distances[i] - b.distances[i]) <=
          4.0 * (p.position_error + q.position_error)))
      return false;
  return true;
}

Found found_of(const Landscape& landscape, const Rest& rest, std::uint64_t start) {
  Found found;
  Equilibrium& e = found.equilibrium;
  e.energy = landscape.energy(rest.sites);
  e.energy_error = landscape.energy_error(rest.sites);
  double far = 0.0;
  for (const Site& p : rest.sites) {
    e.positions.push_back(p.position);
    e.walls.push_back(p.wall);
    far = std::fmax(far, std::fmax(std::fabs(p.position.x), std::fabs(p.position.y)));
  }
  double steepest = 0.0, flattest = std::numeric_limits<double>::infinity();
  double flatness = 0.0;  // the sum of 1/curvature
  for (const double curvature : eigen_of(rest.shape.curvature).values) {
    steepest = std::fmax(steepest, std::fabs(curvature));
    if (std::fabs(curvature) <= rest.shape.curvature_error) {
      ++e.neutral;
      continue;
    }
    flattest = std::fmin(flattest, std::fabs(curvature));
    flatness += 1.0 / std::fabs(curvature);
    if (curvature < 0.0) ++e.descending;
  }
  // Newton's last step, the rounding of the coordinates themselves, and that of the slopes, which
  // moves the place where they vanish.
  const auto n = static_cast<double>(freedom(rest.sites));
  const double coordinates = 0x1p-52 * far;
  e.position_error =
      rest.last_step + coordinates + std::sqrt(n) * rest.shape.slope_error / flattest;
  // What the energy rises by within the error of all coordinates: their rounding, and where the
  // slopes' rounding leads, far along a soft direction, but not up.
  e.energy_error += 0.5 * n * steepest * coordinates * coordinates +
                    0.5 * n * rest.shape.slope_error * rest.shape.slope_error * flatness;
  e.modes = normal_modes(landscape, rest.sites, rest.shape);
  e.first = start;
  e.found = 1;
  found.distances = distances_of(landscape.system(), rest.sites);
  return found;
}

/// One start's results.
struct Outcome {
  std::vector<Found> found;
  std::uint64_t without = 0;
};

/// One thread's.
class Searcher {
 public:
  Searcher(const System& system, const Sampler& sampler, const RelaxOptions& options,
           std::vector<std::optional<Outcome>>& outcomes, std::atomic<std::uint64_t>& done,
           std::mutex& mutex)
      : landscape_(system),
        world_(*system.table),
        sampler_(sampler),
        options_(options),
        outcomes_(outcomes),
        done_(done),
        mutex_(mutex) {}

  bool run(std::uint64_t, std::uint64_t first, std::uint64_t end,
           const std::function<bool()>& stopped) {
    for (std::uint64_t k = first; k < end; ++k) {
      Outcome outcome;
      const Sites start = start_of(k);
      add(outcome, downhill(landscape_, world_, start, stopped), k);
      if (options_.saddles) add(outcome, level(landscape_, world_, start, stopped), k);
      if (stopped()) return false;
      outcomes_[k] = std::move(outcome);
      const std::uint64_t all = done_.fetch_add(1) + 1;
      const std::unique_lock lock(mutex_, std::try_to_lock);
      if (lock && options_.progress) options_.progress(all);
    }
    return true;
  }

 private:
  Sites start_of(std::uint64_t k) const {
    Sites sites;
    const Table& table = *sampler_.system().table;
    for (const State& s : sampler_.draw_all(world_, k))
      sites.push_back(
          {table.lattice ? s.position + table.lattice->translation(s.cell) : s.position});
    return sites;
  }
  void add(Outcome& outcome, const std::optional<Rest>& rest, std::uint64_t start) const {
    if (rest)
      outcome.found.push_back(found_of(landscape_, *rest, start));
    else
      ++outcome.without;
  }

  Landscape landscape_;
  World world_;
  const Sampler& sampler_;
  const RelaxOptions& options_;
  std::vector<std::optional<Outcome>>& outcomes_;
  std::atomic<std::uint64_t>& done_;
  std::mutex& mutex_;
};

void refuse(const System& system) {
  refuse_injections(system, "equilibria");
  if (system.of_discs())
    throw InputError(Place{{}, 0, 0, "interaction.kind"},
                     "hard discs have no potential energy that could be minimised",
                     "a [[potential]], or an [interaction] with a potential");
  if (!system.has_forces())
    throw InputError(Place{{}, 0, 0, "potential"}, "nothing acts on the particles: all rest",
                     "a [[potential]] or an [interaction]");
}

}  // namespace

RelaxResult run_relax(const System& given, const RelaxOptions& options) {
  const Stopwatch watch;
  refuse(given);
  // Where particles are let go no energy limits.
  System system = given;
  system.energies.clear();
  // GSL's own handler ends the program; its functions return what went wrong as well.
  gsl_set_error_handler_off();
  const std::uint64_t listed = listed_trajectories(system);
  const std::uint64_t starts = listed > 0 ? std::min(listed, options.starts) : options.starts;
  const Sampler sampler(system, options.interrupted);
  std::vector<std::optional<Outcome>> outcomes(starts);
  std::atomic<std::uint64_t> done{0};
  std::mutex mutex;
  const engines::BlockPlan plan(starts, options.threads, 1);
  RelaxResult result;
  result.complete = engines::run_blocks(
      plan, options.interrupted,
      [&] { return Searcher(system, sampler, options, outcomes, done, mutex); }, [](Searcher&) {});
  // In the order of starts, so that threads do not matter.
  std::vector<Found> all;
  for (const auto& outcome : outcomes) {
    if (!outcome) continue;
    ++result.starts;
    result.without += outcome->without;
    for (const Found& found : outcome->found) {
      const auto known =
          std::find_if(all.begin(), all.end(), [&](const Found& f) { return same(f, found); });
      if (known == all.end())
        all.push_back(found);
      else
        ++known->equilibrium.found;
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Found& a, const Found& b) {
    return a.equilibrium.energy < b.equilibrium.energy;
  });
  for (Found& f : all) result.equilibria.push_back(std::move(f.equilibrium));
  result.threads = plan.threads;
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  return result;
}

}  // namespace carom
