#include "carom/analyses/orbits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include "analyses/orbits/close_returns.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/injection.hpp"
#include "engines/parallel_blocks.hpp"
#include "orbits/across.hpp"
#include "orbits/itinerary.hpp"
#include "orbits/newton.hpp"
#include "orbits/symmetry.hpp"

namespace carom {

using namespace analyses;
using orbits::Boundary;
using orbits::Chain;
using orbits::Isometry;
using orbits::Match;
using orbits::Solution;

namespace {

// One hit comes back to the same place only along an arc that ends a lattice vector away.
std::size_t fewest_hits(const System& system) {
  return system.table->lattice && system.particles.front().omega != 0.0 ? 1 : 2;
}

bool all_discs(const Table& table) {
  return table.extent == Extent::open_plane &&
         std::all_of(table.walls.begin(), table.walls.end(), [](const Wall& wall) {
           return std::holds_alternative<geometry::Circle>(wall.curve);
         });
}

void check(const System& system, const OrbitSearchOptions& options) {
  const auto refuse = [](const char* key, const std::string& problem, const std::string& expected) {
    const bool option = key[0] == '-';
    throw InputError(Place{option ? "command line" : "", 0, 0, key}, problem, expected);
  };
  if (system.table->walls.empty())
    refuse("table", "no orbit of a free particle closes without walls", "a table with walls");
  if (system.particles.size() != 1)
    refuse("particles.count", "periodic orbits are found for one particle only", "1");
  if (system.dynamics.forces && system.dynamics.forces->external())
    refuse("potential", "periodic orbits are found without forces only",
           "a free particle between walls, with or without a magnetic field");
  if (system.dynamics.everywhere)
    refuse("--engine", "orbits are found by exact flights", "auto or events");
  if (!(system.particles.front().speed > 0.0))
    refuse("particles.speed", "a particle at rest has no orbit", "a speed above 0");
  if (const std::size_t fewest = fewest_hits(system); options.most_hits < fewest)
    refuse("--hits", fmt::format("no orbit has fewer than {} hits", fewest),
           fmt::format("a whole number from {}", fewest));
  refuse_all_but_mirrors(*system.table, "periodic orbits");
  refuse_injections(system, "periodic orbits");
  if (options.expand_cycles && !(all_discs(*system.table) && system.particles.front().omega == 0.0))
    refuse("--zeta", "cycles are expanded where all orbits are known and unstable",
           "discs in the open plane, without field");
}

// The holes closed, so that orbits through them are found, too.
std::shared_ptr<const Table> closed(const Table& table) {
  auto copy = std::make_shared<Table>(table);
  copy->holes.clear();
  for (Wall& wall : copy->walls) wall.holes.clear();
  return copy;
}

std::vector<Chain> chains_of_words(const Boundary& boundary, const OrbitSearchOptions& options) {
  std::vector<Chain> chains;
  const int letters = static_cast<int>(boundary.frames.size());
  // Closed words of n letters without equal neighbours: (k-1)^n + (-1)^n (k-1); n of them at most
  // are one cycle.
  double count = 0.0, power = letters - 1.0;
  for (std::size_t n = 2; n <= options.most_hits && count <= most_words; ++n) {
    power *= letters - 1.0;
    count += (power + (n % 2 == 0 ? 1.0 : -1.0) * (letters - 1.0)) / static_cast<double>(n);
  }
  if (count > most_words)
    throw InputError(Place{"command line", 0, 0, "--hits"},
                     fmt::format("more than {} words of discs have up to {} hits", most_words,
                                 options.most_hits),
                     "a smaller number");
  for (std::size_t n = 2; n <= options.most_hits; ++n)
    orbits::for_each_word(letters, n, [&](const std::vector<int>& word) {
      Chain chain = orbits::chain_of_word(boundary, word);
      if (!chain.empty()) chains.push_back(std::move(chain));
      return true;
    });
  return chains;
}

struct Found {
  Solution solution;
  PeriodicOrbit orbit;
};

// One thread's: solves chains and flies what it finds.
struct Solver {
  const Boundary& boundary;
  const std::vector<Chain>& chains;
  const std::uint64_t words;  ///< how many of them come from words
  std::vector<std::optional<Found>>& found;
  World world;
  const std::function<void(std::uint64_t)>& done;
  std::uint64_t unsolved = 0, shadowed = 0;

  bool run(std::uint64_t, std::uint64_t first, std::uint64_t end,
           const std::function<bool()>& stopped) {
    for (std::uint64_t i = first; i < end; ++i) {
      if (stopped()) return false;
      std::optional<Solution> solution = orbits::solve(boundary, chains[i]);
      // Words come first; between discs the shortest chain is the orbit.
      if (!solution && i < words && boundary.particle.omega == 0.0)
        solution = orbits::solve(boundary, orbits::shortest(boundary, chains[i]));
      if (!solution) {
        ++unsolved;
        continue;
      }
      PeriodicOrbit orbit = orbits::describe(boundary, *solution);
      if (orbits::repeats(orbit)) continue;
      if (orbits::confirmed(boundary, world, *solution, orbit))
        found[i] = Found{std::move(*solution), std::move(orbit)};
      else
        ++shadowed;
    }
    done(end - first);
    return true;
  }
};

// What the isometries leave of an orbit that some of them map onto itself.
void add_symmetry(const Boundary& boundary, const std::vector<Isometry>& maps, Found& found) {
  PeriodicOrbit& orbit = found.orbit;
  // Within its error the trace of a parabolic orbit is 2 or -2, and so is that of its part.
  const auto multiplier = [&](double trace) {
    if (orbit.stability == Stability::parabolic) return trace > 0.0 ? 1.0 : -1.0;
    return orbits::leading_multiplier(trace);
  };
  orbit.reduced = {1, orbit.period, orbit.trace, multiplier(orbit.trace)};
  if (orbit.family) return;
  const std::vector<Match> own = orbits::matches(boundary, maps, orbit, orbit);
  const std::size_t all = maps.size() * (boundary.particle.omega == 0.0 ? 2 : 1);
  if (!own.empty()) orbit.copies = static_cast<int>(all / own.size());
  const std::size_t n = orbit.hits.size();
  std::size_t part = n;
  bool mirrors = false;
  for (const Match& match : own)
    if (!match.reversed && match.shift > 0 && match.shift < part && n % match.shift == 0)
      part = match.shift, mirrors = maps[match.isometry].mirrors;
  if (part == n) return;
  double period = 0.0;
  for (std::size_t i = 0; i < part; ++i) period += orbit.hits[i].flight_time;
  const Solution& s = found.solution;
  const double trace =
      (mirrors ? -1.0 : 1.0) * orbits::tangent_map(boundary, s.chain, s.geometry, part).trace();
  orbit.reduced = {static_cast<int>(n / part), period, trace, multiplier(trace)};
}

void add_holes(const Table& table, PeriodicOrbit& orbit) {
  for (OrbitHit& hit : orbit.hits)
    for (const int hole : table.wall(hit.wall).holes) {
      const Hole& one = table.holes[static_cast<std::size_t>(hole)];
      if (hit.u >= one.from && hit.u < one.to) hit.hole = hole;
    }
}

}  // namespace

OrbitSearchResult find_orbits(const System& system, const OrbitSearchOptions& options) {
  const Stopwatch watch;
  check(system, options);
  System search = system;
  search.table = closed(*system.table);
  const Boundary boundary(*search.table, system.particles.front());
  const std::function<bool()> stopped = [&] {
    return options.interrupted && options.interrupted->load(std::memory_order_relaxed);
  };
  OrbitSearchResult result;
  std::vector<Chain> chains;
  if (all_discs(*search.table)) chains = chains_of_words(boundary, options);
  result.words = chains.size();
  // Between discs words are all there is, unless flights are curved.
  if (chains.empty() || system.particles.front().omega != 0.0) {
    const CloseReturnPlan plan{fewest_hits(system), options.most_hits, options.starts,
                               options.tries, options.progress};
    std::vector<Chain> more = close_returns(search, boundary, plan, stopped);
    result.recurrences = more.size();
    std::move(more.begin(), more.end(), std::back_inserter(chains));
  }

  const bool all_starts = !stopped();
  const World world(*search.table);
  std::vector<std::optional<Found>> found(chains.size());
  std::atomic<std::uint64_t> tried{0};
  std::mutex mutex;
  const std::function<void(std::uint64_t)> report = [&](std::uint64_t more) {
    const std::uint64_t now = tried.fetch_add(more) + more;
    const std::unique_lock lock(mutex, std::try_to_lock);
    if (lock && options.progress) options.progress(now, chains.size());
  };
  const engines::BlockPlan plan(chains.size(), options.threads, 64);
  result.threads = plan.threads;
  result.complete = engines::run_blocks(
      plan, options.interrupted,
      [&] { return Solver{boundary, chains, result.words, found, world.empty_copy(), report}; },
      [&](const Solver& solver) {
        result.unsolved += solver.unsolved;
        result.shadowed += solver.shadowed;
      });
  result.complete = result.complete && all_starts;

  const std::vector<Isometry> maps = orbits::isometries(boundary);
  result.symmetries = maps.size();
  std::vector<Found> kept;
  for (std::optional<Found>& one : found) {
    if (!one) continue;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Found& other) {
      return !orbits::matches(boundary, maps, one->orbit, other.orbit).empty();
    });
    if (!known) kept.push_back(std::move(*one));
  }
  for (Found& one : kept) {
    add_symmetry(boundary, maps, one);
    add_holes(*system.table, one.orbit);
    result.orbits.push_back(std::move(one.orbit));
  }
  std::stable_sort(result.orbits.begin(), result.orbits.end(),
                   [](const PeriodicOrbit& a, const PeriodicOrbit& b) {
                     return std::tuple(a.hits.size(), a.length) <
                            std::tuple(b.hits.size(), b.length);
                   });
  if (options.expand_cycles && result.complete)
    result.cycles = expand_cycles(result.orbits, options.most_hits);
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  return result;
}

}  // namespace carom
