#include "ensemble/one_by_one.hpp"

#include <utility>

#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"

namespace carom::ensemble {

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

OneByOne::OneByOne(const System& system, const EngineOptions& options, World world)
    : system_(system), options_(options), world_(std::move(world)) {
  if (system.run.collisions > 0) world_.limit_hits(system.run.collisions);
  if (!options_.times.empty()) world_.sample_at(options_.times);
  if (options_.energy) world_.watch_energy();
  if (options_.surface) world_.watch(options_.surface, options_.most_crossings);
  if (options_.hits || options_.surface)
    world_.stop_when([this] { return listener_->enough(trajectory_); });
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
    world_.run_until(options_.t_end, *this, stopped);
    if (asked_to_stop()) return false;
    for (int p = 0; p < world_.size(); ++p) {
      ParticleEnd& end = end_.particles[at(p)];
      end.state = world_.state(p);
      end.hits = world_.hits(p);
      end.last_wall = world_.last_wall(p);
      end.energy = world_.energy_balance(p);
      if (is_failure(end.fate)) end.report = world_.report(p);
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

void OneByOne::hit(const HitEvent& event) {
  if (!options_.hits) return;
  State state;
  state.wall = event.wall;
  state.u = event.u;
  state.position = event.position;
  state.velocity = event.after;
  state.cell = event.cell;
  state.time = event.time;
  listener_->hit(trajectory_, event.particle, state, world_.hits(event.particle));
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

}  // namespace carom::ensemble
