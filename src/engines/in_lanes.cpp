#include "engines/in_lanes.hpp"

#include <utility>

#include "motion/take_state.hpp"

namespace carom::engines {

InLanes::InLanes(const System& system, const EngineOptions& options, const World& like,
                 std::unique_ptr<Lanes> lanes)
    : system_(system), options_(options), world_(like.empty_copy()), lanes_(std::move(lanes)) {
  end_of_one_.particles.resize(1);
  if (system.run.collisions > 0) lanes_->limit_hits(system.run.collisions);
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
    motion::take(start.state, flights_[latest_]->trajectory.starts[begun_++]);
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
  if (!starts.next(flight.trajectory, world_)) return false;
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
  motion::take(mine.state, end.state);
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

}  // namespace carom::engines
