#include "carom/ensemble/section_run.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "carom/base/digest.hpp"
#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "carom/events/world.hpp"
#include "ensemble/block_order.hpp"
#include "ensemble/first_reports.hpp"
#include "ensemble/parallel_blocks.hpp"

namespace carom {

namespace {

// Orbits of random starts, unless a number is asked for: more are hard to tell apart in a picture.
constexpr std::uint64_t default_orbits = 50;

using Order = OrderedBlocks<SectionPoint>;

struct Tally {
  void merge(const Tally& other) {
    const SectionResult& r = other.result;
    result.orbits += r.orbits;
    result.points += r.points;
    result.collisions += r.collisions;
    result.incomplete += r.incomplete;
    result.pinned += r.pinned;
    result.escaped += r.escaped;
    result.capped += r.capped;
    result.singular += r.singular;
    result.unbounded += r.unbounded;
    result.unresolved += r.unresolved;
    result.lost += r.lost;
    result.digest += r.digest;
    result.steps += r.steps;
    result.energy_error += r.energy_error;
    for (const auto& [index, report] : r.reports) keep_first(result.reports, index, report);
  }
  SectionResult result;  // its counts and reports alone
};

std::uint64_t hash_of(std::uint64_t so_far, const SectionPoint& p) {
  for (const double x : {p.t, p.s, p.v_parallel, p.x, p.y, p.vx, p.vy}) so_far = mix(so_far, x);
  return mix(so_far ^ static_cast<std::uint64_t>(std::int64_t{p.wall} * 4 + p.direction));
}

class Follower {
 public:
  Follower(const System& system, const Sampler& sampler, const SectionOptions& options, Order& order,
           const std::function<void(std::uint64_t)>& done)
      : system_(system),
        sampler_(sampler),
        options_(options),
        world_(*system.table, system.dynamics, options.decisions),
        recorder_(*system.table, system.section),
        order_(order),
        done_(done) {
    if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
    world_.watch_energy();
    // One direction takes at least every other crossing.
    const std::uint64_t points = system.section.points;
    const std::size_t most = points == 0 || points > SIZE_MAX / 4 ? SIZE_MAX : static_cast<std::size_t>(2 * points + 2);
    if (!system.section.boundary) world_.watch(&system.section.surface, most);
  }

  bool run(std::uint64_t block, std::uint64_t first, std::uint64_t end, const std::function<bool()>& stopped) {
    try {
      return run_block(block, first, end, stopped);
    } catch (...) {
      order_.close();  // nobody waits for what will never come
      throw;
    }
  }

  const DecisionCounts& decisions() const { return world_.decisions(); }

  Tally tally;

 private:
  bool run_block(std::uint64_t block, std::uint64_t first, std::uint64_t end,
                 const std::function<bool()>& stopped) {
    if (options_.points) order_.await_turn(block);
    std::vector<SectionPoint> points;
    for (std::uint64_t orbit = first; orbit < end; ++orbit) {
      if (!follow(orbit, stopped)) {
        order_.close();
        return false;
      }
      if (options_.points) points.insert(points.end(), recorder_.points().begin(), recorder_.points().end());
      if (options_.progress) done_(recorder_.points().size());
    }
    if (options_.points) order_.deliver(block, std::move(points));
    return true;
  }

  bool follow(std::uint64_t orbit, const std::function<bool()>& stopped) {
    world_.clear();
    add_starts(world_, sampler_, orbit);
    recorder_.begin(orbit, world_);
    // What happens after the last point does not belong to it.
    world_.stop_when([this] { return recorder_.done(); });
    world_.run_until(system_.run.t_max, recorder_, stopped);
    if (stopped()) return false;
    count(orbit);
    return true;
  }

  void count(std::uint64_t orbit) {
    SectionResult& r = tally.result;
    ++r.orbits;
    r.steps += world_.step_counts();
    r.points += recorder_.points().size();
    const std::size_t particles = system_.particles.size();
    std::vector<std::uint64_t> hashes, counts(particles, 0);
    for (std::size_t p = 0; p < particles; ++p) hashes.push_back(mix(orbit * particles + p));
    for (const SectionPoint& point : recorder_.points()) {
      const auto p = static_cast<std::size_t>(point.particle);
      hashes[p] = hash_of(hashes[p], point);
      ++counts[p];
    }
    for (std::size_t p = 0; p < particles; ++p) {
      r.digest += hashes[p];
      r.incomplete += counts[p] < system_.section.points;
      const int body = static_cast<int>(p);
      r.collisions += world_.hits(body);
      switch (world_.fate(body)) {
        case Fate::survived: break;
        case Fate::pinned: ++r.pinned; break;
        case Fate::escaped: ++r.escaped; break;
        case Fate::capped: ++r.capped; break;
        case Fate::singular: ++r.singular; break;
        case Fate::unbounded: ++r.unbounded; break;
        case Fate::unresolved: ++r.unresolved; break;
        case Fate::lost: ++r.lost; break;
      }
      if (is_failure(world_.fate(body)))
        keep_first(r.reports, orbit * particles + p, world_.report(body));
      else
        r.energy_error += world_.energy_balance(body).error_at_end(world_.energy_balance(body).change, 0.0);
    }
  }

  const System& system_;
  const Sampler& sampler_;
  const SectionOptions& options_;
  World world_;
  SectionRecorder recorder_;
  Order& order_;
  const std::function<void(std::uint64_t)>& done_;
};

}  // namespace

std::uint64_t section_orbits(const System& system) {
  if (system.section.orbits > 0) return system.section.orbits;
  const std::uint64_t listed = listed_trajectories(system);
  return listed > 0 ? listed : std::min(system.run.trajectories, default_orbits);
}

SectionResult run_section(const System& system, const SectionOptions& options) {
  const Stopwatch watch;
  refuse_injections(system, "sections");
  if (system.section.boundary && system.table->walls.empty())
    throw InputError(Place{{}, 0, 0, "section.on"}, "there are no walls where the section could be taken",
                     "line:x0,y0:x1,y1, segment:x0,y0:x1,y1, circle:x,y,r, x=c, y=c, vx=c or vy=c");
  check_start(system, options.interrupted);
  const Sampler sampler(system, options.interrupted);
  // Blocks wait for their turn in memory.
  const std::uint64_t each = system.section.points;
  const BlockPlan plan(section_orbits(system), options.threads, each == 0 ? 1 : 50000 / each + 1);
  Order order(options.points, 4 * static_cast<std::uint64_t>(plan.threads));
  std::atomic<std::uint64_t> orbits{0}, points{0};
  std::mutex progress_mutex;
  const std::function<void(std::uint64_t)> report = [&](std::uint64_t new_points) {
    const std::uint64_t all = orbits.fetch_add(1, std::memory_order_relaxed) + 1;
    const std::uint64_t all_points = points.fetch_add(new_points, std::memory_order_relaxed) + new_points;
    const std::unique_lock lock(progress_mutex, std::try_to_lock);
    if (lock) options.progress(all, all_points);
  };
  Tally total;
  const bool complete = run_blocks(
      plan, options.interrupted, [&] { return Follower(system, sampler, options, order, report); },
      [&](Follower& follower) {
        total.merge(follower.tally);
        total.result.decisions += follower.decisions();
      });
  if (options.points) order.flush();
  SectionResult result = std::move(total.result);
  result.complete = complete;
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  result.threads = plan.threads;
  return result;
}

}  // namespace carom
