#include "carom/ensemble/single_run.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <stdexcept>

#include "base/interrupt.hpp"
#include "carom/base/error.hpp"
#include "carom/base/twofold.hpp"
#include "carom/ensemble/injection.hpp"
#include "carom/ensemble/sampler.hpp"
#include "carom/ensemble/stopwatch.hpp"
#include "carom/events/world.hpp"
#include "motion/free_motion.hpp"

namespace carom {

namespace {

// What is seen of the energies of particles that nothing acts on between hits and contacts.
class FreeEnergies {
 public:
  /// `shared`: contacts pass energy on.
  FreeEnergies(const std::vector<Particle>& particles, bool shared)
      : particles_(particles),
        shared_(shared),
        seen_(particles.size()),
        changes_(particles.size()) {}

  void begin(int particle, const EnergyBalance& before, const State& state) {
    EnergyBalance& seen = seen_[at(particle)];
    const double kinetic = kinetic_energy(particle, state.velocity);
    if (shared_ && begun_) {
      sum_ += kinetic;
    } else {
      seen = before;
      changes_[at(particle)] = before.change;
      sum_ = kinetic;
      goes_on_ = before.kinetic > 0.0;
    }
    begun_ = true;
    // A part that goes on begins where an undisturbed run has no beginning: its energy there is
    // that of before, but rounded anew.
    if (!goes_on_) seen.kinetic = larger(seen.kinetic, sum_);
  }
  void hit(const HitEvent& event) {
    if (shared_) return pass({{event.particle, event.before, event.after}});
    const Particle& p = particles_[static_cast<std::size_t>(event.particle)];
    see(event.particle,
        kinetic_energy(event.particle, event.after) - 0.5 * p.mass * (p.speed * p.speed));
  }
  void contact(const ContactEvent& event) {
    pass({{event.first, event.first_before, event.first_after},
          {event.second, event.second_before, event.second_after}});
  }
  const EnergyBalance& of(int particle) const { return seen_[at(particle)]; }

 private:
  struct Change {
    int particle;
    geometry::Vector before, after;
  };
  /// Differences are added without rounding, so that nothing but the energies' own roundings is
  /// left of them.
  void pass(std::initializer_list<Change> all) {
    for (const Change& one : all)
      changes_[0] = changes_[0] + Twofold::sum(kinetic_energy(one.particle, one.after),
                                               -kinetic_energy(one.particle, one.before));
    see(0, changes_[0].value());
  }
  void see(int particle, double change) {
    EnergyBalance& seen = seen_[at(particle)];
    seen.change = change;
    seen.largest = larger(seen.largest, std::fabs(change));
  }
  std::size_t at(int particle) const { return shared_ ? 0 : static_cast<std::size_t>(particle); }
  double kinetic_energy(int particle, const geometry::Vector& v) const {
    return 0.5 * particles_[static_cast<std::size_t>(particle)].mass * dot(v, v);
  }

  const std::vector<Particle>& particles_;
  const bool shared_;
  bool begun_ = false, goes_on_ = false;
  double sum_ = 0.0;
  std::vector<EnergyBalance> seen_;
  std::vector<Twofold> changes_;
};

// Passes events on under the numbers of the system's particles: those that ended in an earlier part
// of the run are no longer in the world.
class Renumbering : public Observer {
 public:
  Renumbering(Observer& observer, const std::vector<int>& numbers, std::vector<Time> entries)
      : observer_(observer),
        numbers_(numbers),
        entries_(std::move(entries)),
        ends_(entries_.size()),
        contacts_(entries_.size()) {}

  void hit(const HitEvent& event) override {
    if (trust_ != nullptr) trust_->hit(event);
    HitEvent copy = event;
    copy.particle = number(event.particle);
    if (energies_ != nullptr) energies_->hit(copy);
    observer_.hit(copy);
  }
  void contact(const ContactEvent& event) override {
    ContactEvent copy = event;
    copy.first = number(event.first);
    copy.second = number(event.second);
    ++contacts_[static_cast<std::size_t>(copy.first)];
    ++contacts_[static_cast<std::size_t>(copy.second)];
    if (energies_ != nullptr) energies_->contact(copy);
    observer_.contact(copy);
  }
  void sample(int particle, Time time, const State& state) override {
    // Before it enters it is nowhere.
    if (time < entries_[static_cast<std::size_t>(number(particle))]) return;
    observer_.sample(number(particle), time, state);
  }
  void sampled(Time time) override { observer_.sampled(time); }
  void end(const EndEvent& event) override {
    if (trust_ != nullptr) trust_->end(event);
    EndEvent copy = event;
    copy.particle = number(event.particle);
    ends_[static_cast<std::size_t>(copy.particle)] = copy;
    observer_.end(copy);
  }
  const std::optional<EndEvent>& end_of(std::size_t particle) const { return ends_[particle]; }
  void estimate(TrustRecorder* trust) { trust_ = trust; }
  void watch(FreeEnergies* energies) { energies_ = energies; }
  std::uint64_t contacts_of(std::size_t particle) const { return contacts_[particle]; }

 private:
  int number(int particle) const { return numbers_[static_cast<std::size_t>(particle)]; }
  Observer& observer_;
  TrustRecorder* trust_ = nullptr;  ///< by the numbers of the world
  FreeEnergies* energies_ = nullptr;
  const std::vector<int>& numbers_;
  std::vector<Time> entries_;  ///< when each particle entered
  std::vector<std::optional<EndEvent>> ends_;
  std::vector<std::uint64_t> contacts_;
};

// Has the particle ended for good? A cap on hits may have been raised since, and a pinned or
// surviving particle goes on.
bool gone(Fate fate) {
  return fate == Fate::escaped || fate == Fate::singular || fate == Fate::unbounded ||
         is_failure(fate);
}

RunEnd as_seen(const System& system, const ParticleProgress& progress, State state,
               const EnergyError& energy_error) {
  RunEnd end;
  end.progress = progress;
  end.t = state.time.value();
  end.vx = state.velocity.x;
  end.vy = state.velocity.y;
  geometry::Vector unwrapped = state.position;
  if (system.table->lattice) unwrapped = unwrapped + system.table->lattice->translation(state.cell);
  end.x = unwrapped.x;
  end.y = unwrapped.y;
  fold_into_cell(*system.table, state.position, state.cell);
  end.cell = state.cell;
  end.energy_error = energy_error;
  return end;
}

// Without forces: by how much the squared speed differs from what it was.
double speed_error(const Particle& particle, const State& state) {
  const geometry::Vector v = (1.0 / particle.speed) * state.velocity;
  return dot(v, v) - 1.0;
}

// The state at the end of a particle that is not in the world any more: a flight after the last
// event.
State moved_on(const Particle& particle, const ParticleProgress& progress) {
  State state = progress.state;
  const double duration = progress.end - state.time;
  if (!(duration > 0.0)) return state;
  const auto [position, velocity] = moved(state.position, state.velocity, particle.omega, duration);
  state.position = position;
  state.velocity = velocity;
  state.time = progress.end;
  return state;
}

}  // namespace

bool estimates_trust(const System& system) {
  return !system.dynamics.everywhere && !system.of_discs() &&
         (!system.dynamics.forces || system.dynamics.forces->empty());
}

SingleRunResult run_single(const System& system, Observer& observer,
                           const SingleRunOptions& options) {
  const Stopwatch watch;
  World world(*system.table, system.dynamics, options.decisions);
  std::vector<Particle> all = system.particles;
  if (!options.resume.empty()) refuse_injections(system, "a run that is continued");
  if (system.run.t_max >= no_last_time) refuse_injections(system, "a run without t_max");
  if (!options.resume.empty() && options.resume.size() != all.size())
    throw InputError("the stored run has another number of particles");
  if (system.run.collisions > 0) world.limit_hits(system.run.collisions);
  if (system.run.sample > 0.0) world.sample_every(system.run.sample);

  const Sampler sampler(system, options.interrupted);
  std::vector<int> numbers;
  if (options.resume.empty()) add_starts(world, sampler, options.trajectory);
  std::vector<Time> entries(all.size());
  for (const InjectedParticle& late : Injector(system).add(world, options.trajectory)) {
    all.push_back(late.particle);
    entries.push_back(late.state.time);
  }
  const std::size_t count = all.size();
  std::vector<ParticleProgress> progress(count);
  for (std::size_t p = 0; p < count; ++p) {
    if (!options.resume.empty()) {
      progress[p] = options.resume[p];
      const bool capped = system.run.collisions > 0 && progress[p].hits >= system.run.collisions;
      const bool pinned = progress[p].fate == Fate::pinned && system.run.t_max >= no_last_time;
      if (gone(progress[p].fate) || capped || pinned) continue;
      world.add(all[p], progress[p].state, progress[p].hits);
    }
    numbers.push_back(static_cast<int>(p));
  }

  Renumbering passed_on(observer, numbers, std::move(entries));
  std::optional<TrustRecorder> trust;
  if (estimates_trust(system)) {
    // What is written is the first particle's.
    const bool first = !numbers.empty() && numbers.front() == 0;
    trust.emplace(*system.table, system.run.trust_tolerance, first ? options.written : nullptr);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const int body = static_cast<int>(i);
      const Trust& before = progress[static_cast<std::size_t>(numbers[i])].trust;
      trust->follow(world.particle(body), world.state(body), world.hits(body),
                    options.resume.empty() ? nullptr : &before);
    }
    passed_on.estimate(&*trust);
  }
  SingleRunResult result;
  const ForceField* field = system.dynamics.forces.get();
  const bool integrated = system.dynamics.everywhere || (field != nullptr && !field->empty());
  // Energy is shared by particles that interact, by forces or by contacts.
  const bool shared = integrated ? field != nullptr && field->interacts() : system.of_discs();
  std::vector<Particle> particles;
  for (const int p : numbers) particles.push_back(all[static_cast<std::size_t>(p)]);
  const std::function<bool()> interrupted = [&] {
    result.interrupted = result.interrupted || (options.interrupted && options.interrupted());
    return result.interrupted;
  };
  // The energies of many that interact take seconds: worth nothing where that was interrupted.
  Interrupt summing(&interrupted);
  const auto energies_now = [&](const auto& state_of) {
    std::vector<Energy> energies;
    std::vector<State> states;
    for (std::size_t i = 0; i < numbers.size(); ++i) states.push_back(state_of(i));
    if (shared)
      return std::vector<Energy>(
          numbers.size(), energy_of(particles, states, system.dynamics, *system.table, &summing));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      energies.push_back(
          energy_of({&particles[i], 1}, {&states[i], 1}, system.dynamics, *system.table));
    return energies;
  };
  const auto state_now = [&](std::size_t i) { return world.state(static_cast<int>(i)); };
  const std::vector<Energy> at_start = energies_now(state_now);
  FreeEnergies free(all, shared);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const EnergyBalance& before = progress[static_cast<std::size_t>(numbers[i])].energy;
    if (integrated)
      world.set_energy_balance(static_cast<int>(i), before);
    else
      free.begin(numbers[i], before, state_now(i));
  }
  if (integrated)
    world.watch_energy();
  else
    passed_on.watch(&free);
  // Pinned particles are known at the start: without a last time nothing more is to come of them,
  // and their samples would have no end.
  const bool without_end = system.run.t_max >= no_last_time;
  if (without_end && options.resume.empty()) world.run_until(0.0, passed_on, interrupted);
  bool moving = false;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    moving = moving || !world.finished(static_cast<int>(i));
  if (moving || !without_end) world.run_until(system.run.t_max, passed_on, interrupted);

  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t p = static_cast<std::size_t>(numbers[i]);
    const int body = static_cast<int>(i);
    ParticleProgress& now = progress[p];
    now.state = world.state(body);
    now.hits = world.hits(body);
    now.contacts += passed_on.contacts_of(p);
    if (world.last_wall(body) >= 0) now.last_wall = world.last_wall(body);
    now.hole = world.hole(body);
    if (trust) now.trust = trust->trust(body);
    now.energy = integrated ? world.energy_balance(body) : free.of(numbers[i]);
    const std::optional<EndEvent>& end = passed_on.end_of(p);
    now.fate = end ? end->fate : Fate::survived;
    const bool until_stop = now.fate == Fate::survived || now.fate == Fate::pinned;
    // What is pinned without a last time has been followed to its end.
    const bool endless = without_end && now.fate == Fate::pinned;
    now.end = !until_stop                     ? end->time
              : result.interrupted || endless ? now.state.time
                                              : Time(system.run.t_max);
  }
  if (shared && !numbers.empty())
    for (ParticleProgress& one : progress)
      one.energy = progress[static_cast<std::size_t>(numbers.front())].energy;
  std::vector<State> last(count);
  for (std::size_t p = 0; p < count; ++p) last[p] = moved_on(all[p], progress[p]);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t p = static_cast<std::size_t>(numbers[i]);
    last[p] = world.state_at(static_cast<int>(i), progress[p].end);
  }
  // Particles that share their energy are all there until the first of them is gone.
  const bool everybody =
      numbers.size() == count &&
      std::none_of(progress.begin(), progress.end(), [](const ParticleProgress& one) {
        return gone(one.fate) || one.fate == Fate::capped;
      });
  const std::vector<Energy> at_end =
      energies_now([&](std::size_t i) { return last[static_cast<std::size_t>(numbers[i])]; });
  std::vector<EnergyError> errors;
  for (const ParticleProgress& one : progress)
    errors.push_back(one.energy.error_at_end(one.energy.change, 0.0));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t p = static_cast<std::size_t>(numbers[i]);
    const EnergyBalance& seen = progress[p].energy;
    if (shared ? everybody && !summing.stopped() : integrated) {
      const double before = options.resume.empty() ? 0.0 : options.resume[p].energy.change;
      errors[p] =
          seen.error_at_end(before + (at_end[i].total() - at_start[i].total()), at_end[i].kinetic);
    } else if (!shared) {
      const double error = speed_error(all[p], last[p]);
      errors[p] = {error, larger(errors[p].largest, std::fabs(error))};
    }
  }
  for (std::size_t p = 0; p < count; ++p) {
    result.particles.push_back(as_seen(system, progress[p], last[p], errors[p]));
    RunEnd& end = result.particles.back();
    if (!trust) end.progress.trust.open = false;  // an earlier part of the run may have flown
    end.trust = trust ? trust->at_end(all[p], progress[p].state, progress[p].trust, progress[p].end)
                      : end.progress.trust;
    result.collisions += progress[p].hits;
    result.contacts += progress[p].contacts;
  }
  result.contacts /= 2;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    result.particles[static_cast<std::size_t>(numbers[i])].report =
        world.report(static_cast<int>(i));
  result.decisions = world.decisions();
  result.steps = options.steps;
  result.steps += world.step_counts();
  result.seconds = watch.seconds();
  result.cpu_seconds = watch.cpu_seconds();
  if (options.estimate_state_error && options.resume.empty() && !result.interrupted) {
    double end = 0.0;
    for (const ParticleProgress& p : progress) end = std::max(end, p.end.value());
    result.state_error = state_error(system, options.trajectory, end, options.interrupted);
  }
  return result;
}

}  // namespace carom
