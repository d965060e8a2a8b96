#include "engines/one_by_one.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "carom/base/error.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"

namespace carom::engines {

using base::at;

OneByOne::OneByOne(const System& system, const EngineOptions& options, World world)
    : system_(system), options_(options), world_(std::move(world)) {
  if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
  if (!options_.times.empty()) world_.sample_at(options_.times);
  if (!options_.deviations.empty())
    deviations_.emplace(system, options_.frame ? Deviations::frame : Deviations::two);
  if (options_.energy) world_.watch_energy();
  if (options_.surface) world_.watch(options_.surface, options_.most_crossings);
  if (options_.hits || options_.surface)
    world_.stop_when([this] { return listener_->stop(trajectory_); });
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
    if (deviations_) {
      deviations_->begin(trajectory_.starts, trajectory_.particles, options_.unit_length);
      heard_.assign(trajectory_.starts.size(), {});
    }
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
      if (stayed && deviations_) stretch(at(p), Time(options_.t_end), true);
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

void OneByOne::stretch(std::size_t particle, const Time& time, bool also_at) {
  const std::size_t with = deviations_->reported_with(particle);
  Heard& heard = heard_[with];
  for (; heard.marks < options_.deviations.size(); ++heard.marks) {
    const double mark = options_.deviations[heard.marks];
    if (also_at ? Time(mark) > time : !(Time(mark) < time)) return;
    const std::span<const double> logarithms = deviations_->logarithms(with, mark, *stopped_);
    // The group flies beside the world, with steps that end at the marks, too.
    if (!std::isfinite(logarithms[0]))
      throw InputError(Place{"", 0, 0, "integrator.step"},
                       fmt::format("steps of {} are too long to follow deviations: beside "
                                   "trajectory {} they ran away before t = {:.6g}",
                                   system_.dynamics.integrator.step, trajectory_.number, mark),
                       "a shorter step");
    listener_->stretched(trajectory_, static_cast<int>(with), heard.marks, logarithms, heard.hits);
  }
}

void OneByOne::carry_over_hit(std::size_t particle, const State& state) {
  stretch(particle, state.time, false);
  deviations_->hit(particle, state, world_, *stopped_);
  if (deviations_->in_group(particle))
    ++heard_[deviations_->reported_with(particle)].hits;
  else
    heard_[particle].hits = world_.hits(static_cast<int>(particle));
}

void OneByOne::stepped(int particle, Time time, bool part) {
  if (!deviations_ || !deviations_->takes_step(at(particle), part)) return;
  stretch(at(particle), time, false);
  deviations_->stepped(at(particle), time, world_, *stopped_);
}

void OneByOne::hit(const HitEvent& event) {
  if (!options_.hits && !deviations_) return;
  const State state = state_after(event);
  if (deviations_) carry_over_hit(at(event.particle), state);
  if (options_.hits)
    listener_->hit(trajectory_, event.particle, state, world_.hits(event.particle));
}

void OneByOne::contact(const ContactEvent& event) {
  ++end_.contacts;
  if (!deviations_) return;
  for (const int p : {event.first, event.second}) stretch(at(p), event.time, false);
  deviations_->contact(event, *stopped_);
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
