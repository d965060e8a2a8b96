#include "carom/engines/engine.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "carom/events/world.hpp"
#include "carom/lanes/free_lanes.hpp"
#include "carom/lanes/lanes.hpp"
#include "carom/lanes/soft_lanes.hpp"
#include "engines/one_by_one.hpp"
#include "motion/take_state.hpp"

namespace carom {

using namespace engines;

namespace {

/// Puts the particles of trajectories into lanes, and the ends of particles together to ends of
/// trajectories.
class InLanes : public Engine {
 public:
  /// `like`: a world of the system.
  InLanes(const System&, const EngineOptions&, const World& like, std::unique_ptr<Lanes>);
  InLanes(const InLanes&) = delete;
  InLanes& operator=(const InLanes&) = delete;

  bool run(Starts&, Listener&, const std::function<bool()>& stopped) override;
  DecisionCounts decisions() const override { return lanes_->decisions(); }
  LaneEffort effort() const override { return lanes_->effort(); }

 private:
  /// A trajectory under way. Its place is used again, so there are as many as lanes hold.
  struct Flight {
    Trajectory trajectory;
    TrajectoryEnd end;     ///< so far, of several particles
    std::size_t left = 0;  ///< particles that have not ended
  };
  std::size_t each() const { return system_.particles.size(); }
  bool begin(Starts&);
  void note(const LaneEnd&);
  // A tag tells the slot and the particle.
  static std::uint64_t tag_of(std::size_t slot, std::size_t particle) {
    return std::uint64_t{slot} << 32 | particle;
  }
  static std::size_t particle_of(std::uint64_t tag) { return tag & 0xffffffff; }
  Flight& flight(std::uint64_t tag) { return *flights_[tag >> 32]; }
  Trajectory& begun_trajectory() {
    return options_.states ? flights_[latest_]->trajectory : without_states_;
  }

  const System& system_;
  const EngineOptions options_;
  World world_;  ///< answers what starts are asked for
  std::unique_ptr<Lanes> lanes_;
  Listener* listener_ = nullptr;
  std::vector<std::unique_ptr<Flight>> flights_;  ///< by slot
  TrajectoryEnd end_of_one_;   ///< of the latest trajectory of one particle: always at hand
  Trajectory without_states_;  ///< the latest, where states are of no interest: always at hand
  std::vector<std::size_t> free_;
  std::size_t latest_ = 0,
              begun_ = 0;  ///< the latest flight, and how many of its particles are in lanes
};

InLanes::InLanes(const System& system, const EngineOptions& options, const World& like,
                 std::unique_ptr<Lanes> lanes)
    : system_(system), options_(options), world_(like.empty_copy()), lanes_(std::move(lanes)) {
  end_of_one_.particles.resize(1);
  if (system.run.collisions > 0) lanes_->limit_hits(system.run.collisions);
  if (!options_.states) lanes_->omit_end_states();
  if (!options_.times.empty())
    lanes_->sample_at(options_.times, [this](std::uint64_t tag, std::size_t number,
                                             const State& state) {
      listener_->sample(flight(tag).trajectory, static_cast<int>(particle_of(tag)), number, state);
    });
  if (!options_.deviations.empty())
    lanes_->follow_deviations(options_.deviations, options_.unit_length,
                              [this](std::uint64_t tag, std::size_t number,
                                     std::span<const double> logarithms, std::uint64_t hits) {
                                listener_->stretched(flight(tag).trajectory,
                                                     static_cast<int>(particle_of(tag)), number,
                                                     logarithms, hits);
                              });
  if (options_.hits)
    lanes_->report_hits([this](std::uint64_t tag, const State& state, std::uint64_t hits) {
      const Trajectory& trajectory = flight(tag).trajectory;
      listener_->hit(trajectory, static_cast<int>(particle_of(tag)), state, hits);
      return !listener_->stop(trajectory);
    });
}

bool InLanes::run(Starts& starts, Listener& listener, const std::function<bool()>& stopped) {
  listener_ = &listener;
  flights_.clear();
  free_.clear();
  begun_ = each();
  const auto next = [&](LaneStart& start) {
    if (begun_ == each() && !begin(starts)) return false;
    start.tag = tag_of(latest_, begun_);
    start.particle = system_.particles[begun_];
    motion::take(start.state, begun_trajectory().starts[begun_++]);
    start.hits = 0;
    return true;
  };
  lanes_->run_until(
      options_.t_end, next, [this](const LaneEnd& end) { note(end); }, stopped);
  return free_.size() == flights_.size();
}

bool InLanes::begin(Starts& starts) {
  if (free_.empty()) {
    free_.push_back(flights_.size());
    flights_.push_back(std::make_unique<Flight>());
    flights_.back()->trajectory.slot = free_.back();
  }
  latest_ = free_.back();
  Flight& flight = *flights_[latest_];
  if (!starts.next(begun_trajectory(), world_)) return false;
  if (!options_.states) flight.trajectory.number = without_states_.number;
  free_.pop_back();
  begun_ = 0;
  if (each() > 1) {
    flight.left = each();
    flight.end.particles.resize(each());
    flight.end.steps = {};
  }
  listener_->begin(flight.trajectory);
  return true;
}

void InLanes::note(const LaneEnd& end) {
  Flight& f = flight(end.tag);
  const bool alone = each() == 1;
  TrajectoryEnd& all = alone ? end_of_one_ : f.end;
  ParticleEnd& mine = all.particles[particle_of(end.tag)];
  const bool to_the_end = end.fate == Fate::survived || end.fate == Fate::pinned;
  mine.fate = end.fate;
  mine.time = to_the_end ? options_.t_end : end.time.value();
  if (options_.states) motion::take(mine.state, end.state);
  mine.hole = end.hole;
  mine.hits = end.hits;
  mine.last_wall = end.last_wall;
  if (is_failure(end.fate)) mine.report = end.report;
  mine.energy.kinetic = end.kinetic;
  if (alone)
    all.steps = end.steps;
  else
    all.steps += end.steps;
  listener_->particle_end(f.trajectory, static_cast<int>(particle_of(end.tag)), end.fate);
  if (!alone && --f.left > 0) return;
  free_.push_back(f.trajectory.slot);
  listener_->end(f.trajectory, all);
}

/// Does nothing act between walls?
bool is_free(const System& system) { return !system.is_integrated() && !system.of_discs(); }

/// Starts that are drawn together.
constexpr std::uint64_t most_ahead = 64;

World world_like(const System& system, const EngineOptions& options) {
  return options.like ? options.like->empty_copy()
                      : World(*system.table, system.dynamics, options.decisions);
}

}  // namespace

DrawnStarts::DrawnStarts(const Sampler& sampler, Blocks blocks)
    : sampler_(sampler), injector_(sampler.system()), blocks_(std::move(blocks)) {}
DrawnStarts::DrawnStarts(const Sampler& sampler, TrajectoryRange range)
    : DrawnStarts(sampler, [range, given = false](TrajectoryRange& block) mutable {
        block = range;
        return !std::exchange(given, true);
      }) {}

bool DrawnStarts::next(Trajectory& trajectory, const World& world) {
  while (block_.first == block_.last)
    if (!blocks_(block_)) return false;
  trajectory.number = block_.first++;
  const System& system = sampler_.system();
  if (system.particles.size() == 1 && !system.of_discs()) {
    if (given_ == ahead_.size()) {
      ahead_.resize(std::min(most_ahead, block_.last - trajectory.number));
      sampler_.draw_several(world, trajectory.number, ahead_);
      given_ = 0;
    }
    // Into the memory that the trajectory has: many are short.
    trajectory.starts.resize(1);
    motion::take(trajectory.starts.front(), ahead_[given_++]);
  } else {
    trajectory.starts = sampler_.draw_all(world, trajectory.number);
  }
  if (system.injections.empty()) {
    // A trajectory that is used again has them.
    if (trajectory.particles.empty()) trajectory.particles = system.particles;
    return true;
  }
  trajectory.particles = system.particles;
  for (const InjectedParticle& one : injector_.draw(trajectory.number)) {
    trajectory.particles.push_back(one.particle);
    trajectory.starts.push_back(one.state);
  }
  return true;
}

std::string why_one_by_one(const System& system, const EngineOptions& options) {
  if (!system.injections.empty()) return "particles enter later ([[injection]])";
  if (scatters(*system.table)) return "walls reflect at random";
  if (!system.table->regions.empty()) return "particles pass walls of regions";
  if (options.surface) return "crossings of a surface are located";
  if (options.energy && !is_free(system)) return "energies are checked after each step";
  if (options.frame) return "a frame of deviations is followed";
  if (!options.deviations.empty() && !is_free(system))
    return system.of_discs() ? "deviations of discs are followed"
                             : "deviations are followed under forces";
  if (is_free(system)) return FreeLanes::hindrance(*system.table, system.particles);
  return SoftLanes::hindrance(*system.table, system.dynamics, system.particles);
}

std::unique_ptr<Engine> make_engine(const System& system, const EngineOptions& options) {
  if (!options.lanes || !why_one_by_one(system, options).empty())
    return std::make_unique<OneByOne>(system, options, world_like(system, options));
  const World world = world_like(system, options);
  std::unique_ptr<Lanes> lanes;
  if (is_free(system))
    lanes = std::make_unique<FreeLanes>(world, system.particles, *options.lanes);
  else
    lanes = std::make_unique<SoftLanes>(*system.table, system.dynamics, system.particles.at(0),
                                        *options.lanes, options.decisions);
  return std::make_unique<InLanes>(system, options, world, std::move(lanes));
}

}  // namespace carom
