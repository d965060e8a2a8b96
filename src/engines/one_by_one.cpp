#include "engines/one_by_one.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/index.hpp"
#include "carom/base/error.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "engines/force_tangent.hpp"
#include "engines/free_group_tangent.hpp"

namespace carom::engines {

namespace {

using base::at;

}  // namespace

OneByOne::OneByOne(const System& system, const EngineOptions& options, World world)
    : system_(system), options_(options), world_(std::move(world)) {
  if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
  if (!options_.times.empty()) world_.sample_at(options_.times);
  if (!options_.deviations.empty()) {
    walls_ = motion::tangent_walls(system.table->walls, system.table->lattice);
    make_groups();
  }
  if (options_.energy) world_.watch_energy();
  if (options_.surface) world_.watch(options_.surface, options_.most_crossings);
  if (options_.hits || options_.surface)
    world_.stop_when([this] { return listener_->stop(trajectory_); });
}

void OneByOne::make_groups() {
  const auto& forces = system_.dynamics.forces;
  const bool forced = forces && !forces->empty();
  if (!forced && !system_.of_discs() && !options_.frame) return;  // across their orbits
  const Deviations kind = options_.frame ? Deviations::frame : Deviations::two;
  const auto add = [&](std::vector<std::size_t> members) {
    if (forced)
      groups_.push_back(std::make_unique<ForceTangent>(system_, std::move(members), kind));
    else
      groups_.push_back(std::make_unique<FreeGroupTangent>(system_, std::move(members), kind));
  };
  std::vector<std::size_t> all(system_.particles.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (act_on_each_other(system_)) return add(std::move(all));
  for (const std::size_t p : all) add({p});
}

bool OneByOne::run(Starts& starts, Listener& listener, const std::function<bool()>& stopped) {
  listener_ = &listener;
  const auto asked_to_stop = [&] { return stopped && stopped(); };
  while (!asked_to_stop()) {
    if (!starts.next(trajectory_, world_)) return true;
    world_.clear();
    add_particles();
    if (asked_to_stop()) return false;
    end_ = {std::vector<ParticleEnd>(trajectory_.starts.size()), {}, 0};
    samples_ = 0;
    listener.begin(trajectory_);
    for (ParticleEnd& end : end_.particles) end.time = options_.t_end;
    stopped_ = &stopped;
    if (!options_.deviations.empty()) begin_deviations();
    world_.run_until(options_.t_end, *this, stopped);
    if (asked_to_stop()) return false;
    for (int p = 0; p < world_.size(); ++p) {
      ParticleEnd& end = end_.particles[at(p)];
      end.state = world_.state(p);
      end.hits = world_.hits(p);
      end.last_wall = world_.last_wall(p);
      end.energy = world_.energy_balance(p);
      if (is_failure(end.fate)) end.report = world_.report(p);
      const bool stayed = end.fate == Fate::survived || end.fate == Fate::pinned;
      if (stayed && !followed_.empty()) stretch(at(p), Time(options_.t_end), true);
    }
    end_.steps = world_.step_counts();
    listener.end(trajectory_, end_);
  }
  return false;
}

void OneByOne::add_particles() {
  const std::size_t at_start = system_.particles.size();
  for (std::size_t p = 0; p < trajectory_.starts.size(); ++p) {
    if (p < at_start)
      add_start(world_, system_, trajectory_.starts[p], trajectory_.number, static_cast<int>(p));
    else
      add_injected(world_, system_, {trajectory_.particles[p], trajectory_.starts[p]},
                   trajectory_.number);
    trajectory_.starts[p] = world_.state(static_cast<int>(p));
  }
}

void OneByOne::begin_deviations() {
  in_parts_ = false;
  followed_.assign(trajectory_.starts.size(), {});
  for (std::size_t p = 0; p < followed_.size(); ++p)
    followed_[p].tangent.begin(trajectory_.starts[p], trajectory_.particles[p],
                               options_.unit_length);
  for (const auto& group : groups_) {
    const geometry::Vector v = trajectory_.starts[group->members().front()].velocity;
    const double speed = std::sqrt(dot(v, v));
    group->begin(trajectory_.starts, options_.unit_length / (speed > 0.0 ? speed : 1.0));
    for (const std::size_t p : group->members()) followed_[p].group = group.get();
  }
}

void OneByOne::stretch(std::size_t particle, const Time& time, bool also_at) {
  GroupTangent* const group = followed_[particle].group;
  const std::size_t told = group ? group->members().front() : particle;
  Followed& mine = followed_[told];
  for (; mine.marked < options_.deviations.size(); ++mine.marked) {
    const double mark = options_.deviations[mine.marked];
    if (also_at ? Time(mark) > time : !(Time(mark) < time)) return;
    if (group) group->fly_to(mark, *stopped_);
    // Of deviations that were made orthogonal the first one's length is that of both, as it is
    // where all turn into one direction.
    const auto lengths = group ? std::array{group->logarithms()[0], group->logarithms()[0]}
                               : mine.tangent.logarithms(mark);
    // The group flies beside the world, with steps that end at the marks, too.
    if (!std::isfinite(lengths[0]))
      throw InputError(Place{"", 0, 0, "integrator.step"},
                       fmt::format("steps of {} are too long to follow deviations: beside "
                                   "trajectory {} they ran away before t = {:.6g}",
                                   system_.dynamics.integrator.step, trajectory_.number, mark),
                       "a shorter step");
    listener_->stretched(trajectory_, static_cast<int>(told), mine.marked,
                         options_.frame ? group->logarithms() : std::span<const double>(lengths),
                         mine.hits);
  }
}

void OneByOne::carry_over_hit(std::size_t particle, const State& state) {
  stretch(particle, state.time, false);
  GroupTangent* const group = followed_[particle].group;
  if (!group) {
    followed_[particle].tangent.hit(walls_, state);
    followed_[particle].hits = world_.hits(static_cast<int>(particle));
    return;
  }
  group->arrive(particle, state.time, *stopped_);
  put_back(*group, state.time);
  group->hit(particle, state);
  ++followed_[group->members().front()].hits;
}

/// The path of a chaotic group leaves that of the world by its rounding: it is brought back.
void OneByOne::put_back(GroupTangent& group, const Time& time) {
  for (const std::size_t p : group.members())
    if (const State other = world_.state(static_cast<int>(p)); other.time == time)
      group.put(p, other);
}

/// Deviations fly beside the world, with the plan's steps. Once these were halved they take the
/// world's, along its path.
void OneByOne::stepped(int particle, Time time, bool part) {
  if (followed_.empty()) return;
  in_parts_ = in_parts_ || part;
  GroupTangent* const group = followed_[at(particle)].group;
  if (!in_parts_ || !group) return;
  stretch(at(particle), time, false);
  group->arrive(at(particle), time, *stopped_);
  put_back(*group, time);
}

void OneByOne::hit(const HitEvent& event) {
  if (!options_.hits && followed_.empty()) return;
  State state;
  state.wall = event.wall;
  state.u = event.u;
  state.position = event.position;
  state.velocity = event.after;
  state.cell = event.cell;
  state.time = event.time;
  if (!followed_.empty()) carry_over_hit(at(event.particle), state);
  if (options_.hits)
    listener_->hit(trajectory_, event.particle, state, world_.hits(event.particle));
}

void OneByOne::contact(const ContactEvent& event) {
  ++end_.contacts;
  if (followed_.empty()) return;
  GroupTangent* const group = followed_[at(event.first)].group;
  for (const int p : {event.first, event.second}) {
    stretch(at(p), event.time, false);
    group->arrive(at(p), event.time, *stopped_);
  }
  group->contact(event);
}

void OneByOne::sample(int particle, Time, const State& state) {
  listener_->sample(trajectory_, particle, samples_, state);
}

void OneByOne::crossing(int particle, Time, const State& state, int direction) {
  listener_->crossing(trajectory_, particle, state, direction);
}

void OneByOne::end(const EndEvent& event) {
  ParticleEnd& end = end_.particles[at(event.particle)];
  end.fate = event.fate;
  end.hole = event.hole;
  if (event.fate != Fate::survived && event.fate != Fate::pinned) end.time = event.time.value();
  listener_->particle_end(trajectory_, event.particle, event.fate);
}

}  // namespace carom::engines
