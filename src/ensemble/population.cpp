#include "population.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carom/base/digest.hpp"
#include "carom/base/elementary.hpp"
#include "carom/base/random.hpp"

namespace carom {

namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();
constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t most_reports = 5;

// Streams of random numbers: one a walker and stage; the comb takes the last one.
constexpr std::uint64_t comb_stream = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t stages_of_population = std::uint64_t{1} << 24;

}  // namespace

void Population::Memory::keep(const State& state, std::uint64_t hits) {
  ring[next] = {state, hits};
  next = (next + 1) % ring.size();
  size = std::min(size + 1, ring.size());
  ++since_start;
}

void Population::Memory::forget(std::size_t newest) {
  newest = std::min(newest, size);
  next = (next + ring.size() - newest) % ring.size();
  size -= newest;
  since_start -= newest;
}

const Population::Moment& Population::Memory::ago(std::size_t back) const {
  return ring[(next + ring.size() - 1 - std::min(back, size - 1)) % ring.size()];
}

// Remembers the hits of the one particle, and when it ended.
class Population::Recorder : public Observer {
 public:
  Recorder(Memory& memory, std::uint64_t hits) : memory_(memory), hits_(hits) {}
  void hit(const HitEvent& event) override {
    State state;
    state.wall = event.wall;
    state.u = event.u;
    state.position = event.position;
    state.velocity = event.after;
    state.cell = event.cell;
    state.time = event.time;
    hits_ += static_cast<std::uint64_t>(event.reflections);
    memory_.keep(state, hits_);
  }
  void end(const EndEvent& event) override { time = event.time; }
  Time time;

 private:
  Memory& memory_;
  std::uint64_t hits_;
};

Population::Population(const System& system, const Sampler& sampler, const Kick& kick,
                       const SplittingPlan& plan, const std::vector<double>& reports,
                       DecisionOptions decisions)
    : system_(system),
      sampler_(sampler),
      kick_(kick),
      plan_(plan),
      reports_(reports),
      world_(*system.table, decisions) {
  // Where the start is fewer hits away than a copy goes back, a kick there has fewer to grow in and
  // is larger. Starts by the cosine law bear a kick of any size; others one as small as is chosen
  // elsewhere.
  using Kind = InitialCondition::Kind;
  const bool any = system.initial.kind == Kind::boundary || system.initial.kind == Kind::hole;
  const double most = any ? 0.5 : SplittingPlan::largest_choice;
  const double logarithm = plan.kick > 0.0 ? elementary::log(plan.kick) : 0.0;
  const auto lookback = static_cast<double>(plan.lookback);
  for (std::uint64_t back = 0; back < plan.lookback; ++back) {
    const double as_far = elementary::exp(logarithm * static_cast<double>(back) / lookback);
    kicks_.push_back(std::max(plan.kick, std::min(most, as_far)));
  }
  kicks_.push_back(plan.kick);
}

/// Follows one walker through a stage.
Population::Way Population::fly(Walker& walker, const Stage& stage,
                                const std::function<bool()>& stopped) {
  const Particle& particle = system_.particles.front();
  Recorder end(walker.memory, walker.hits);
  const bool by_time = plan_.by == SplittingPlan::Level::time;
  const auto hits_wanted = by_time ? no_limit : static_cast<std::uint64_t>(stage.level) + 1;
  // A corner may have counted several hits, a long flight have passed several times.
  if (walker.hits >= hits_wanted ||
      (by_time && !stage.last && walker.state.time > Time(stage.level)))
    return Way::reached;
  world_.limit_hits(hits_wanted);
  world_.clear();
  const int it = world_.add(particle, walker.state, walker.hits);
  world_.run_until(by_time ? stage.level : no_end, end, stopped);
  if (by_time && !stage.last && !world_.finished(it)) {
    world_.limit_hits(world_.hits(it) + 1);
    world_.run_until(no_end, end, stopped);
  }
  walker.state = world_.state(it);
  walker.hits = world_.hits(it);
  if (!world_.finished(it)) return Way::reached;
  switch (world_.fate(it)) {
    case Fate::capped:
      return Way::reached;
    case Fate::survived:
    case Fate::pinned:
      return Way::for_ever;
    case Fate::escaped:
    case Fate::unbounded:
      walker.state.time = end.time;
      return Way::gone;
    case Fate::singular:
    case Fate::lost:
    case Fate::unresolved:
      return Way::ended;
  }
  return Way::ended;
}

/// Of the walker that flew last and ended without a continuation.
void Population::count_if_lost(PopulationRun& result, std::vector<std::string>& reports) const {
  if (!is_failure(world_.fate(0))) return;
  ++(world_.fate(0) == Fate::lost ? result.lost : result.unresolved);
  if (reports.size() < most_reports) reports.push_back(world_.report(0));
}

/// Parts a copy from its like: a step of a Metropolis walk among the states that lie `lookback`
/// hits before the level (or at the start). A kick keeps the invariant measure, so every new way
/// that reaches the level after as many hits is taken, and no other: one with more or fewer would
/// never be kicked back to where it came from.
void Population::part(Walker& walker, const Stage& stage, double shrink, RandomStream& random,
                      const std::function<bool()>& stopped, PopulationRun& result,
                      std::vector<std::string>& reports) {
  if (walker.memory.size == 0) return;
  const double speed = system_.particles.front().speed;
  Walker other = walker;
  const auto back =
      static_cast<std::size_t>(std::min(plan_.lookback, walker.memory.since_start - 1));
  const Moment& before = walker.memory.ago(back);
  other.memory.forget(back + 1);
  other.state = kick_(before.state, speed, shrink * kicks_[back], random);
  other.hits = before.hits;
  other.memory.keep(other.state, other.hits);
  const Way way = fly(other, stage, stopped);
  result.collisions += other.hits - before.hits;
  ++result.tried;
  if (way == Way::ended) count_if_lost(result, reports);
  if (way != Way::reached || other.memory.since_start != walker.memory.since_start) return;
  ++result.parted;
  walker = other;
}

/// Fills the population again: as many copies of each survivor as of any other, by a comb with one
/// random offset, so that the mean number of copies is exact. All copies have the same share.
void Population::copy_survivors(const Stage& stage, std::uint64_t stream, double shrink,
                                const std::function<bool()>& stopped, PopulationRun& result,
                                std::vector<std::string>& reports) {
  walkers_.clear();
  if (survivors_.empty()) return;
  const double copies =
      static_cast<double>(plan_.population) / static_cast<double>(survivors_.size());
  const double offset =
      RandomStream(system_.run.seed, Purpose::splitting, stream, comb_stream).uniform();
  for (std::size_t i = 0; i < survivors_.size(); ++i) {
    // Rounding must not change the size of the population.
    const double teeth = i + 1 == survivors_.size() ? static_cast<double>(plan_.population)
                                                    : static_cast<double>(i + 1) * copies - offset;
    for (int copy = 0;
         static_cast<double>(walkers_.size()) < teeth && walkers_.size() < plan_.population;
         ++copy) {
      Walker walker = survivors_[i];
      walker.kicked = copy > 0;
      if (copy > 0) {
        RandomStream random(system_.run.seed, Purpose::splitting, stream, walkers_.size());
        part(walker, stage, shrink, random, stopped, result, reports);
      }
      walkers_.push_back(walker);
    }
  }
}

/// Reports from < t <= to: what has gone later is known by now, and so is what is still there.
void Population::report_times(double from, double to, std::uint64_t still_there, double for_ever,
                              PopulationRun& result) {
  std::uint64_t later = still_there + going_.back();
  double of_others = for_ever + gone_by_.back();
  for (std::size_t i = reports_.size(); i-- > 0;) {
    if (reports_[i] <= from) break;
    if (reports_[i] <= to) result.survival[i] = share(later) + of_others;
    later += going_[i];
    of_others += gone_by_[i];
  }
  for (std::size_t i = 0; i < going_.size(); ++i) gone_by_[i] += share(going_[i]);
}

/// Shares of those that have a continuation; all of them as long as nobody has gone.
void Population::finish(std::size_t first_loss, PopulationRun& result) const {
  const double followed = 1.0 - result.singular;
  for (std::size_t i = 0; i < result.survival.size(); ++i) {
    double& p = result.survival[i];
    p = followed > 0.0 && i < first_loss ? 1.0 : std::min(p / followed, 1.0);
  }
  for (double& p : result.gone) p /= followed;
  result.done = true;
}

void Population::start(std::uint64_t repetition) {
  walkers_.clear();
  world_.clear();
  for (std::uint64_t i = 0; i < plan_.population; ++i) {
    Walker walker;
    walker.state = sampler_.draw(world_, repetition * plan_.population + i, 0);
    if (walker.state.wall >= 0) walker.memory.keep(walker.state, 0);
    walkers_.push_back(walker);
  }
}

PopulationRun Population::run(std::uint64_t repetition, std::size_t kick_number,
                              const std::function<bool()>& stopped,
                              std::vector<std::string>& reports) {
  const double shrink = std::ldexp(1.0, -static_cast<int>(kick_number));
  const std::uint64_t number = repetition * kick_sizes + kick_number;
  const bool by_time = plan_.by == SplittingPlan::Level::time;
  const std::size_t stages = plan_.levels.size() + (by_time ? 1 : 0);
  PopulationRun result;
  result.survival.assign(reports_.size(), 0.0);
  gone_by_.assign(reports_.size() + 1, 0.0);
  share_of_stage_ = 1.0;

  try {
    start(repetition);
  } catch (const SamplingStopped&) {
    return {};
  }
  double for_ever = 0.0, before = -1.0;
  std::size_t first_loss = reports_.size();  // the first report by which somebody has gone
  for (std::size_t k = 0; k < stages; ++k) {
    const bool last = by_time && k == plan_.levels.size();
    const Stage stage{last ? reports_.back() : plan_.levels[k], last};
    const std::uint64_t stream = number * stages_of_population + k;
    CopiesOfStage& copies = result.copies.emplace_back();
    survivors_.clear();
    going_.assign(reports_.size() + 1, 0);
    std::uint64_t stay = 0, ended = 0;
    for (std::size_t i = 0; i < walkers_.size(); ++i) {
      Walker& walker = walkers_[i];
      const std::uint64_t hits = walker.hits;
      const Way way = fly(walker, stage, stopped);
      if (stopped()) return {};
      result.collisions += walker.hits - hits;
      const double time = walker.state.time.value();
      result.digest += trajectory_hash(mix(stream) + i, static_cast<std::uint64_t>(way), time,
                                       walker.hits, walker.state.wall);
      if (way != Way::ended) {
        Staying& like = walker.kicked ? copies.kicked : copies.first;
        ++like.followed;
        if (way != Way::gone) ++like.stayed;
      }
      const auto report_of = [&] {
        return by_time ? static_cast<std::size_t>(
                             std::lower_bound(reports_.begin(), reports_.end(), time) -
                             reports_.begin())
                       : k;
      };
      switch (way) {
        case Way::reached:
          survivors_.push_back(walker);
          break;
        case Way::for_ever:
          ++stay;
          break;
        case Way::gone:
          ++going_[report_of()];
          first_loss = std::min(first_loss, report_of());
          break;
        case Way::ended:
          ++ended;
          count_if_lost(result, reports);
          break;
      }
    }
    result.reached.push_back(survivors_.size());
    result.singular += share(ended);
    for_ever += share(stay);
    if (by_time)
      report_times(before, stage.level, survivors_.size(), for_ever, result);
    else
      result.survival[k] = share(survivors_.size()) + for_ever;
    before = stage.level;
    share_of_stage_ = share(survivors_.size());
    if (k + 1 < stages) copy_survivors(stage, stream, shrink, stopped, result, reports);
  }
  if (by_time) result.gone.assign(gone_by_.begin(), gone_by_.end() - 1);
  finish(first_loss, result);
  return result;
}

}  // namespace carom
