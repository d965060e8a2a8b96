#include "analyses/splitting/population.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "carom/base/digest.hpp"
#include "carom/base/elementary.hpp"
#include "carom/base/random.hpp"
#include "carom/results/ensemble_result.hpp"

namespace carom::analyses {

namespace {

constexpr double no_end = std::numeric_limits<double>::infinity();

// Streams of random numbers: one a member and stage; the comb takes the last one.
constexpr std::uint64_t comb_stream = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t stages_of_population = std::uint64_t{1} << 24;

}  // namespace

void Population::Memory::keep(const State& state, std::uint64_t hits, const Stretch& stretch) {
  ring[next] = {state, hits, stretch};
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

/// Tells an engine where members start, and each of them what happens to it.
class Population::Flights : public Starts, public Listener {
 public:
  Flights(Population& population, const Stage& stage, const Next& next, const Done& done)
      : population_(population), stage_(stage), next_(next), done_(done) {}

  bool next(Trajectory& t, const World& world) override {
    if (under_way_.size() <= t.slot) under_way_.resize(t.slot + 1);
    OnItsWay& mine = under_way_[t.slot];
    while ((mine.member = next_(mine.number, mine.copy, world))) {
      mine.there = is_there(mine.member->hits, mine.member->state.time);
      if (!mine.there) {
        t.number = mine.number;
        t.particles = population_.system_.particles;
        t.starts.assign(1, mine.member->state);
        if (population_.plan_.deviations) population_.begin_deviation(mine.tangent, *mine.member);
        return true;
      }
      mine.member->way = Way::reached;
      done_(mine.number, *mine.member);
    }
    return false;
  }
  void hit(const Trajectory& t, int, const State& state, std::uint64_t hits) override {
    OnItsWay& mine = under_way_[t.slot];
    hits += mine.member->hits;
    if (population_.plan_.deviations) mine.tangent.hit(population_.walls_, state);
    mine.member->memory.keep(state, hits, {mine.tangent.deviation[0], mine.tangent.shrunk[0]});
    mine.there = is_there(hits, state.time);
  }
  bool stop(const Trajectory& t) override { return under_way_[t.slot].there; }
  void end(const Trajectory& t, const TrajectoryEnd& end) override {
    const ParticleEnd& particle = end.particles.front();
    OnItsWay& mine = under_way_[t.slot];
    Member& member = *mine.member;
    member.state = particle.state;
    member.hits += particle.hits;
    member.way = way_of(particle.fate);
    if (member.way == Way::gone) member.state.time = particle.time;
    population_.note(particle);
    done_(mine.number, member);
  }

 private:
  struct OnItsWay {
    std::size_t number = 0;
    Member* member = nullptr;  ///< its state and hits at the start, its memory at the latest hit
    Member copy;
    motion::FreeTangent tangent;
    bool there = false;
  };
  /// A corner may have counted several hits, a long flight have passed several times.
  bool is_there(std::uint64_t hits, Time time) const {
    if (population_.by_time()) return !stage_.last && time > Time(stage_.level);
    return hits > static_cast<std::uint64_t>(stage_.level);
  }
  static Way way_of(Fate fate) {
    switch (fate) {
      case Fate::survived:
      case Fate::capped:
        return Way::reached;
      case Fate::pinned:
        return Way::trapped;
      case Fate::escaped:
      case Fate::unbounded:
        return Way::gone;
      case Fate::singular:
      case Fate::lost:
      case Fate::unresolved:
        return Way::ended;
    }
    return Way::ended;
  }

  Population& population_;
  const Stage& stage_;
  const Next& next_;
  const Done& done_;
  std::deque<OnItsWay> under_way_;  ///< by slot; stays where it is
};

Population::Population(const System& system, const Sampler& sampler, const World& world,
                       const Kick& kick, const SplittingPlan& plan,
                       const std::vector<double>& reports, const SplittingOptions& options)
    : system_(system), sampler_(sampler), kick_(kick), plan_(plan), reports_(reports) {
  EngineOptions asked{.t_end = no_end,
                      .hits = true,
                      .decisions = options.decisions,
                      .lanes = options.lanes,
                      .like = &world};
  to_levels_ = make_engine(system, asked);
  if (by_time()) {
    asked.t_end = reports.back();
    asked.hits = false;  // no copy is made of what reaches it
    to_the_end_ = make_engine(system, asked);
  }
  if (plan.deviations) walls_ = motion::tangent_walls(system.table->walls, system.table->lattice);
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

DecisionCounts Population::decisions() const {
  DecisionCounts sum = to_levels_->decisions();
  if (to_the_end_) sum += to_the_end_->decisions();
  return sum;
}

/// False: it was stopped on the way.
bool Population::fly(const Stage& stage, const Next& next, const Done& done) {
  Flights flights(*this, stage, next, done);
  return (stage.last ? to_the_end_ : to_levels_)->run(flights, flights, stopped_);
}

void Population::note(const ParticleEnd& end) {
  result_.collisions += end.hits;
  if (!is_failure(end.fate)) return;
  ++(end.fate == Fate::lost ? result_.lost : result_.unresolved);
  if (failures_.size() < most_reports) failures_.push_back(end.report);
}

/// Flies all members through a stage; those of the first one are drawn on the way.
bool Population::fly_members(const Stage& stage, bool first, std::uint64_t repetition) {
  if (first) members_.assign(plan_.population, {});
  std::size_t begun = 0;
  const Next next = [&](std::size_t& index, Member&, const World& world) -> Member* {
    if (begun == members_.size()) return nullptr;
    index = begun++;
    Member& member = members_[index];
    if (first) {
      member.state = sampler_.draw(world, repetition * plan_.population + index, 0);
      if (member.state.wall >= 0) {
        motion::FreeTangent tangent;
        if (plan_.deviations) begin_deviation(tangent, member);
        member.memory.keep(member.state, 0, {tangent.deviation[0], tangent.shrunk[0]});
      }
    }
    return &member;
  };
  return fly(stage, next, [](std::size_t, const Member&) {});
}

/// It goes on with the deviation that the member has, if it has any.
void Population::begin_deviation(motion::FreeTangent& tangent, const Member& member) const {
  tangent.begin(member.state, system_.particles.front(), plan_.deviations->unit_length);
  if (member.memory.size == 0) return;
  const Stretch& stretch = member.memory.ago(0).stretch;
  if (stretch.deviation.place == 0.0 && stretch.deviation.rate == 0.0) return;
  tangent.deviation[0] = stretch.deviation;
  tangent.shrunk[0] = stretch.shrunk;
}

GrowthAtLevel Population::growth_of_survivors() const {
  GrowthAtLevel at;
  at.number = survivors_.size();
  at.log_share = log_share_;
  if (survivors_.empty()) return at;
  const auto n = static_cast<double>(survivors_.size());
  double mean = 0.0;
  for (const std::size_t i : survivors_) mean += members_[i].state.time.value() / n;
  double weights = 0.0;
  std::vector<std::array<double, 3>> all;  // weight, time since the mean, growth
  motion::FreeTangent tangent;
  for (const std::size_t i : survivors_) {
    const double time = members_[i].state.time.value();
    begin_deviation(tangent, members_[i]);
    const double weight = elementary::exp(plan_.deviations->tilt * (time - mean));
    all.push_back({weight, time - mean, tangent.logarithms(time)[0]});
    weights += weight;
  }
  double later = 0.0;
  for (const auto& [weight, time, growth] : all) {
    later += weight * time / weights;
    at.growth += weight * growth / weights;
  }
  for (const auto& [weight, time, growth] : all) {
    at.time_variance += weight * (time - later) * (time - later) / weights;
    at.covariance += weight * (time - later) * (growth - at.growth) / weights;
  }
  at.time = mean + later;
  at.log_weight = plan_.deviations->tilt * mean + elementary::log(weights / n);
  return at;
}

/// The report at which a member that is gone has gone, or the stage's own by hits.
std::size_t Population::report_of(std::size_t stage, const Member& member) const {
  if (!by_time()) return stage;
  const double time = member.state.time.value();
  return static_cast<std::size_t>(std::lower_bound(reports_.begin(), reports_.end(), time) -
                                  reports_.begin());
}

/// Counts how members went through stage `number`, and collects those that reached its end.
void Population::count(const Stage& stage, std::size_t number) {
  CopiesOfStage& copies = result_.copies.emplace_back();
  survivors_.clear();
  going_.assign(reports_.size() + 1, 0);
  std::uint64_t stay = 0, ended = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Member& member = members_[i];
    result_.digest += trajectory_hash(mix(stage.stream) + i, static_cast<std::uint64_t>(member.way),
                                      member.state.time.value(), member.hits, member.state.wall);
    if (member.way != Way::ended) {
      Staying& like = member.kicked ? copies.kicked : copies.first;
      ++like.followed;
      if (member.way != Way::gone) ++like.stayed;
    }
    switch (member.way) {
      case Way::reached:
        survivors_.push_back(i);
        break;
      case Way::trapped:
        ++stay;
        break;
      case Way::gone:
        ++going_[report_of(number, member)];
        first_loss_ = std::min(first_loss_, report_of(number, member));
        break;
      case Way::ended:
        ++ended;
        break;
    }
  }
  result_.reached.push_back(survivors_.size());
  result_.singular += share(ended);
  trapped_ += share(stay);
  if (by_time())
    report_times(stage.level);
  else
    result_.survival[number] = share(survivors_.size()) + trapped_;
  before_ = stage.level;
  share_of_stage_ = share(survivors_.size());
  if (!plan_.deviations) return;
  log_share_ += elementary::log(static_cast<double>(survivors_.size()) /
                                static_cast<double>(plan_.population));
  result_.growth.push_back(growth_of_survivors());
}

/// Fills the population again: the same number of copies of each survivor, by a comb with one
/// random offset, so that the mean number of copies is exact. All copies have the same share.
void Population::copy_survivors(const Stage& stage) {
  copies_.clear();
  const double copies =
      static_cast<double>(plan_.population) / static_cast<double>(survivors_.size());
  const double offset =
      RandomStream(system_.run.seed, Purpose::splitting, stage.stream, comb_stream).uniform();
  for (std::size_t i = 0; i < survivors_.size(); ++i) {
    Member& member = members_[survivors_[i]];
    member.kicked = false;
    // Rounding must not change the size of the population.
    const double teeth = i + 1 == survivors_.size() ? static_cast<double>(plan_.population)
                                                    : static_cast<double>(i + 1) * copies - offset;
    while (static_cast<double>(copies_.size()) < teeth && copies_.size() < plan_.population) {
      copies_.push_back(member);
      member.kicked = true;
    }
  }
  std::swap(members_, copies_);
}

/// Separates copies from their first ones: a step of a Metropolis walk among the states that lie
/// `lookback` hits before the level (or at the start). A kick keeps the invariant measure, so every
/// new way that reaches the level after as many hits is taken, and no other: one with more or fewer
/// would never be kicked back to where it came from.
bool Population::separate_copies(const Stage& stage, double shrink) {
  const double speed = system_.particles.front().speed;
  std::size_t begun = 0;
  const Next next = [&](std::size_t& index, Member& copy, const World&) -> Member* {
    while (begun < members_.size() && !(members_[begun].kicked && members_[begun].memory.size > 0))
      ++begun;
    if (begun == members_.size()) return nullptr;
    index = begun++;
    copy = members_[index];
    const auto hits =
        static_cast<std::size_t>(std::min(plan_.lookback, copy.memory.since_start - 1));
    const Moment before = copy.memory.ago(hits);
    RandomStream random(system_.run.seed, Purpose::splitting, stage.stream, index);
    copy.memory.forget(hits + 1);
    copy.state = kick_(before.state, speed, shrink * kicks_[hits], random);
    copy.hits = before.hits;
    copy.memory.keep(copy.state, copy.hits, before.stretch);
    ++result_.tried;
    return &copy;
  };
  const Done done = [&](std::size_t index, const Member& copy) {
    if (copy.way != Way::reached || copy.memory.since_start != members_[index].memory.since_start)
      return;
    ++result_.accepted;
    members_[index] = copy;
  };
  return fly(stage, next, done);
}

/// Reports before_ < t <= to: what has gone later is known by now, and so is what is still there.
void Population::report_times(double to) {
  std::uint64_t later = survivors_.size() + going_.back();
  double of_others = trapped_ + gone_by_.back();
  for (std::size_t i = reports_.size(); i-- > 0;) {
    if (reports_[i] <= before_) break;
    if (reports_[i] <= to) result_.survival[i] = share(later) + of_others;
    later += going_[i];
    of_others += gone_by_[i];
  }
  for (std::size_t i = 0; i < going_.size(); ++i) gone_by_[i] += share(going_[i]);
}

/// Shares of those that have a continuation; all of them as long as none has gone.
void Population::finish() {
  const double followed = 1.0 - result_.singular;
  for (std::size_t i = 0; i < result_.survival.size(); ++i) {
    double& p = result_.survival[i];
    p = followed > 0.0 && i < first_loss_ ? 1.0 : std::min(p / followed, 1.0);
  }
  if (by_time()) result_.gone.assign(gone_by_.begin(), gone_by_.end() - 1);
  for (double& p : result_.gone) p /= followed;
  result_.trapped = trapped_;
  result_.done = true;
}

PopulationRun Population::run(std::uint64_t repetition, std::size_t kick_number,
                              const std::function<bool()>& stopped) {
  const double shrink = std::ldexp(1.0, -static_cast<int>(kick_number));
  const std::uint64_t first_stream = (repetition * kick_sizes + kick_number) * stages_of_population;
  const std::size_t stages = plan_.levels.size() + (by_time() ? 1 : 0);
  stopped_ = stopped;
  result_ = {};
  result_.survival.assign(reports_.size(), 0.0);
  gone_by_.assign(reports_.size() + 1, 0.0);
  share_of_stage_ = 1.0;
  log_share_ = 0.0;
  trapped_ = 0.0;
  before_ = -1.0;
  first_loss_ = reports_.size();
  try {
    for (std::size_t k = 0; k < stages; ++k) {
      const bool last = k == plan_.levels.size();
      const Stage stage{last ? reports_.back() : plan_.levels[k], last, first_stream + k};
      if (!fly_members(stage, k == 0, repetition)) return {};
      count(stage, k);
      if (k + 1 == stages) break;
      copy_survivors(stage);
      if (!separate_copies(stage, shrink)) return {};
    }
  } catch (const SamplingStopped&) {
    return {};
  }
  finish();
  return std::move(result_);
}

}  // namespace carom::analyses
