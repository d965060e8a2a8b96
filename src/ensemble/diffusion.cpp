#include "carom/ensemble/diffusion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carom/base/digest.hpp"
#include "carom/base/error.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "carom/events/energy.hpp"
#include "carom/events/world.hpp"
#include "ensemble/parallel_blocks.hpp"

namespace carom {

namespace {

constexpr std::size_t most_reports = 5;
// Each takes 150 kB a thread.
constexpr std::size_t most_times = 2000;

// What threads add up.
struct Tally {
  explicit Tally(const System& system) { sums = DisplacementSums(system.run.times); }

  void count(Fate fate) {
    ++result.trajectories;
    switch (fate) {
      case Fate::survived: ++result.survived; break;
      case Fate::pinned: ++result.survived, ++result.pinned; break;
      case Fate::capped: ++result.capped; break;
      case Fate::escaped: ++result.escaped; break;
      case Fate::singular: ++result.singular; break;
      case Fate::unbounded: ++result.unbounded; break;
      case Fate::lost: ++result.lost; break;
    }
  }

  void merge(const Tally& other) {
    sums.merge(other.sums);
    const DiffusionResult& r = other.result;
    result.trajectories += r.trajectories;
    result.survived += r.survived;
    result.pinned += r.pinned;
    result.escaped += r.escaped;
    result.singular += r.singular;
    result.unbounded += r.unbounded;
    result.capped += r.capped;
    result.lost += r.lost;
    result.collisions += r.collisions;
    result.energy_change = std::max(result.energy_change, r.energy_change);
    result.digest += r.digest;
    result.decisions += r.decisions;
    reports.insert(reports.end(), other.reports.begin(), other.reports.end());
    std::sort(reports.begin(), reports.end());
    if (reports.size() > most_reports) reports.resize(most_reports);
  }

  DisplacementSums sums;
  DiffusionResult result;  // its counts alone
  std::vector<std::pair<std::uint64_t, std::string>> reports;
};

// Runs trajectories in one thread and listens to their samples.
class Walker : public Observer {
 public:
  Walker(const System& system, const Sampler& sampler, DecisionOptions decisions,
         std::function<void(std::uint64_t)> done)
      : tally(system),
        system_(system),
        sampler_(sampler),
        world_(*system.table, system.dynamics, decisions),
        starts_(system.particles.size()),
        squares_(system.particles.size()),
        ends_(system.particles.size()),
        done_(std::move(done)) {
    if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
    world_.sample_at(system.run.times);
  }

  bool run(std::uint64_t, std::uint64_t first, std::uint64_t end, const std::function<bool()>& stopped) {
    for (std::uint64_t trajectory = first; trajectory < end; ++trajectory) {
      if (stopped()) return false;
      trajectory_ = trajectory;
      const int particles = static_cast<int>(system_.particles.size());
      world_.clear();
      add_starts(world_, sampler_, trajectory);
      for (int p = 0; p < particles; ++p) {
        starts_[index(p)] = world_.state(p);
        squares_[index(p)].clear();
        ends_[index(p)] = {Fate::survived, system_.run.times.back()};
      }
      const bool forces = system_.dynamics.forces && !system_.dynamics.forces->empty();
      const double energy = forces ? energy_now() : 0.0;
      world_.run_until(system_.run.times.back(), *this, stopped);
      if (stopped()) return false;
      if (forces && everybody_is_left())
        tally.result.energy_change = std::max(tally.result.energy_change, std::fabs(energy_now() - energy));
      std::uint64_t hits = 0;
      for (int p = 0; p < particles; ++p) hits += finish(p);
      if (done_) done_(hits);
    }
    return true;
  }

  void sample(int particle, Time, const State& state) override {
    const State& start = starts_[index(particle)];
    geometry::Vector displacement = state.position - start.position;
    if (system_.table->lattice)
      displacement = displacement + system_.table->lattice->translation({state.cell.first - start.cell.first,
                                                                         state.cell.second - start.cell.second});
    squares_[index(particle)].push_back(dot(displacement, displacement));
  }

  void end(const EndEvent& event) override {
    if (event.fate == Fate::survived || event.fate == Fate::pinned)
      ends_[index(event.particle)].fate = event.fate;
    else
      ends_[index(event.particle)] = {event.fate, event.time.value()};
  }

  void close() { tally.result.decisions = world_.decisions(); }

  Tally tally;

 private:
  struct End {
    Fate fate = Fate::survived;
    double time = 0.0;
  };
  static std::size_t index(int particle) { return static_cast<std::size_t>(particle); }

  double energy_now() const {
    std::vector<State> states;
    for (int p = 0; p < world_.size(); ++p) states.push_back(world_.state(p));
    return energy_of(system_.particles, states, system_.dynamics, *system_.table).total();
  }
  bool everybody_is_left() const {
    return std::all_of(ends_.begin(), ends_.end(), [](const End& e) { return e.fate == Fate::survived; });
  }

  std::uint64_t finish(int particle) {
    const std::uint64_t number =
        trajectory_ * system_.particles.size() + static_cast<std::uint64_t>(particle);
    const End& end = ends_[index(particle)];
    const std::uint64_t hits = world_.hits(particle);
    tally.count(end.fate);
    const std::vector<double>& squares = squares_[index(particle)];
    for (std::size_t k = 0; k < squares.size(); ++k) tally.sums.add(trajectory_, k, squares[k]);
    tally.result.collisions += hits;
    tally.result.digest += trajectory_hash(number, static_cast<std::uint64_t>(end.fate), end.time, hits,
                                           world_.last_wall(particle));
    if (end.fate == Fate::lost && tally.reports.size() < most_reports)
      tally.reports.emplace_back(number, world_.report(particle));
    return hits;
  }

  const System& system_;
  const Sampler& sampler_;
  World world_;
  std::vector<State> starts_;
  std::vector<std::vector<double>> squares_;  // of the trajectory under way
  std::vector<End> ends_;
  std::uint64_t trajectory_ = 0;
  std::function<void(std::uint64_t)> done_;
};

}  // namespace

DiffusionResult run_diffusion(const System& system, const DiffusionOptions& options) {
  const Stopwatch watch;
  if (system.run.times.size() > most_times)
    throw InputError(Place{"", 0, 0, "run.times"}, std::to_string(system.run.times.size()) + " times are too many",
                     "at most " + std::to_string(most_times) + " report times");
  refuse_injections(system, "an ensemble that diffuses");
  const Sampler sampler(system);
  const BlockPlan plan(system.run.trajectories, options.threads, options.block);
  std::atomic<std::uint64_t> done{0}, hits{0};
  std::mutex progress_mutex;
  const auto report = [&](std::uint64_t new_hits) {
    const std::uint64_t all = done.fetch_add(1, std::memory_order_relaxed) + 1;
    const std::uint64_t all_hits = hits.fetch_add(new_hits, std::memory_order_relaxed) + new_hits;
    const std::unique_lock lock(progress_mutex, std::try_to_lock);
    if (lock) options.progress(all, all_hits);
  };
  Tally total(system);
  const bool complete = run_blocks(
      plan, options.interrupted,
      [&] {
        return Walker(system, sampler, options.decisions,
                      options.progress ? std::function<void(std::uint64_t)>(report) : nullptr);
      },
      [&](Walker& walker) {
        walker.close();
        total.merge(walker.tally);
      });
  DiffusionResult result = std::move(total.result);
  result.sums = std::move(total.sums);
  result.complete = complete;
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  result.threads = plan.threads;
  for (auto& [index, text] : total.reports) result.reports.push_back(std::move(text));
  return result;
}

}  // namespace carom
