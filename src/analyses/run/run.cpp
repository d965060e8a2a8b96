#include "carom/analyses/run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interrupt.hpp"
#include "carom/base/error.hpp"
#include "carom/base/stopwatch.hpp"
#include "carom/events/medium.hpp"
#include "carom/events/world.hpp"
#include "carom/starts/injection.hpp"
#include "carom/starts/sampler.hpp"
#include "engines/free_energies.hpp"
#include "motion/free_motion.hpp"
#include "table/bezier_wall.hpp"

namespace carom {

namespace {

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
    if (trust_ != nullptr) trust_->TrustRecorder::hit(event);  // directly: this is every hit
    const int particle = number(event.particle);
    if (energies_ != nullptr) energies_->hit(particle, event);
    // A copy would wait until every number of the event is written.
    if (particle == event.particle) return observer_.hit(event);
    HitEvent copy = event;
    copy.particle = particle;
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
  bool sampled(Time time) override {
    interrupted_ = !observer_.sampled(time);
    return !interrupted_;
  }
  void end(const EndEvent& event) override {
    if (trust_ != nullptr) trust_->end(event);
    EndEvent copy = event;
    copy.particle = number(event.particle);
    ends_[static_cast<std::size_t>(copy.particle)] = copy;
    observer_.end(copy);
  }
  /// The observer was interrupted over a sample.
  bool interrupted() const { return interrupted_; }
  const std::optional<EndEvent>& end_of(std::size_t particle) const { return ends_[particle]; }
  void estimate(TrustRecorder* trust) { trust_ = trust; }
  void watch(engines::FreeEnergies* energies) { energies_ = energies; }
  std::uint64_t contacts_of(std::size_t particle) const { return contacts_[particle]; }

 private:
  int number(int particle) const { return numbers_[static_cast<std::size_t>(particle)]; }
  Observer& observer_;
  TrustRecorder* trust_ = nullptr;  ///< by the numbers of the world
  engines::FreeEnergies* energies_ = nullptr;
  bool interrupted_ = false;
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

// Where a particle has left the table by: rounding may put it beside the wall. On a wall along an
// axis the coordinate that all its points share is known.
geometry::Vector at_exit(const Table& table, const ParticleProgress& progress,
                         geometry::Vector position) {
  if (progress.fate != Fate::escaped || progress.hole < 0) return position;
  const Hole& hole = table.holes[static_cast<std::size_t>(progress.hole)];
  const Wall& wall = table.walls[static_cast<std::size_t>(hole.wall)];
  const auto* segment = std::get_if<geometry::Segment>(&wall.curve);
  if (!segment) return position;
  if (segment->from.x == segment->to.x) position.x = segment->from.x;
  if (segment->from.y == segment->to.y) position.y = segment->from.y;
  return position;
}

RunEnd as_seen(const System& system, const ParticleProgress& progress, State state,
               const EnergyError& energy_error) {
  RunEnd end;
  end.progress = progress;
  end.t = state.time.value();
  end.vx = state.velocity.x;
  end.vy = state.velocity.y;
  geometry::Vector unwrapped = at_exit(*system.table, progress, state.position);
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
// event. `particle`: as it flies there.
State moved_on(const Particle& particle, const ParticleProgress& progress) {
  State state = progress.state;
  const double duration = progress.end - state.time;
  if (!(duration > 0.0)) return state;
  const auto [position, velocity] =
      motion::moved(state.position, state.velocity, particle.omega, duration);
  state.position = position;
  state.velocity = velocity;
  state.time = progress.end;
  return state;
}

/// One run, from its start or from where a stored one ended.
class SingleRun {
 public:
  SingleRun(const System& system, Observer& observer, const SingleRunOptions& options)
      : system_(system),
        options_(options),
        world_(*system.table, system.dynamics, options.decisions),
        integrated_(system.is_integrated()),
        // Energy is shared by particles that interact, by forces or by contacts.
        shared_(integrated_ ? system.dynamics.forces && system.dynamics.forces->interacts()
                            : system.of_discs()),
        goes_on_(!options.resume.empty()),
        without_end_(system.run.t_max >= no_last_time) {
    if (goes_on_) refuse_injections(system, "a run that is continued");
    if (without_end_) refuse_injections(system, "a run without t_max");
    if (goes_on_ && options.resume.size() != system.particles.size())
      throw InputError("the stored run has another number of particles");
    add_particles(observer);
    if (estimates_trust(system)) follow_trust();
    begin_energies();
  }
  SingleRun(const SingleRun&) = delete;
  SingleRun& operator=(const SingleRun&) = delete;

  SingleRunResult run() {
    fly();
    for (std::size_t body = 0; body < numbers_.size(); ++body) note_end(body);
    if (shared_ && !numbers_.empty())
      for (ParticleProgress& one : progress_) one.energy = progress_[number(0)].energy;
    return result();
  }

 private:
  std::uint64_t trajectory() const { return options_.trajectory; }
  /// The number in the system of a particle of the world.
  std::size_t number(std::size_t body) const { return static_cast<std::size_t>(numbers_[body]); }
  State state(std::size_t body) const { return world_.state(static_cast<int>(body)); }

  /// Starts and particles that enter later, or those of the stored run that go on.
  void add_particles(Observer& observer) {
    if (system_.run.collisions > 0) world_.limit_hits(system_.run.collisions);
    if (system_.run.sample > 0.0) world_.sample_every(system_.run.sample);
    if (!goes_on_) add_starts(world_, sampler_, trajectory());
    if (!goes_on_ && options_.started) options_.started(world_);
    std::vector<Time> entries(all_.size());
    for (const InjectedParticle& late : Injector(system_).add(world_, trajectory())) {
      all_.push_back(late.particle);
      entries.push_back(late.state.time);
    }
    progress_.resize(all_.size());
    for (std::size_t p = 0; p < all_.size(); ++p) {
      if (goes_on_) {
        const ParticleProgress& before = progress_[p] = options_.resume[p];
        const bool capped = system_.run.collisions > 0 && before.hits >= system_.run.collisions;
        if (gone(before.fate) || capped || (before.fate == Fate::pinned && without_end_)) continue;
        world_.add(all_[p], before.state, before.hits, before.speed);
      }
      numbers_.push_back(static_cast<int>(p));
      particles_.push_back(all_[p]);
    }
    world_.scatter_by(system_.run.seed, trajectory(), numbers_);
    passed_on_.emplace(observer, numbers_, std::move(entries));
  }

  void follow_trust() {
    // What is written is the first particle's.
    const bool first = !numbers_.empty() && numbers_.front() == 0;
    trust_.emplace(*system_.table, system_.run.trust_tolerance, first ? options_.written : nullptr);
    for (std::size_t body = 0; body < numbers_.size(); ++body)
      trust_->follow(world_.particle(static_cast<int>(body)), state(body),
                     world_.hits(static_cast<int>(body)),
                     goes_on_ ? &progress_[number(body)].trust : nullptr);
    passed_on_->estimate(&*trust_);
  }

  void begin_energies() {
    const std::vector<State> starts = starts_of_all();
    starts_known_ = !starts.empty();
    at_start_ = energies_of(
        [&](std::size_t body) { return starts.empty() ? state(body) : starts[number(body)]; });
    free_.emplace(*system_.table, all_, shared_);
    for (std::size_t body = 0; body < numbers_.size(); ++body) {
      const EnergyBalance& before = progress_[number(body)].energy;
      if (integrated_)
        world_.set_energy_balance(static_cast<int>(body), before);
      else
        free_->begin(numbers_[body], before, state(body));
    }
    if (integrated_)
      world_.watch_energy();
    else if (!is_thermal(*system_.table))  // which keep no energy
      passed_on_->watch(&*free_);
  }
  /// Where the stored run began; none where that is not needed.
  std::vector<State> starts_of_all() {
    std::vector<State> starts;
    if (!goes_on_ || !(integrated_ || shared_)) return starts;
    World drawn(*system_.table, system_.dynamics, options_.decisions);
    try {
      add_starts(drawn, sampler_, options_.trajectory);
    } catch (const SamplingStopped&) {  // the run ends where it began, and is as before
      was_interrupted_ = true;
      return starts;
    }
    for (int p = 0; p < drawn.size(); ++p) starts.push_back(drawn.state(p));
    return starts;
  }
  /// Of each particle of the world, or of all together.
  std::vector<Energy> energies_of(const auto& state_of) {
    const Dynamics& dynamics = system_.dynamics;
    const std::size_t count = numbers_.size();
    std::vector<State> states;
    for (std::size_t body = 0; body < count; ++body) states.push_back(state_of(body));
    if (shared_)
      return std::vector<Energy>(
          count, energy_of(particles_, states, dynamics, *system_.table, &summing_));
    std::vector<Energy> energies;
    for (std::size_t body = 0; body < count; ++body)
      energies.push_back(
          energy_of({&particles_[body], 1}, {&states[body], 1}, dynamics, *system_.table));
    return energies;
  }

  void fly() {
    // Pinned particles are known at the start: without a last time nothing more is to come of them,
    // and their samples would have no end.
    if (without_end_ && !goes_on_) world_.run_until(0.0, *passed_on_, interrupted_);
    if (goes_on_ && integrated_) take_up_steps();
    bool moving = false;
    for (std::size_t body = 0; body < numbers_.size(); ++body)
      moving = moving || !world_.finished(static_cast<int>(body));
    if (moving || !without_end_) world_.run_until(system_.run.t_max, *passed_on_, interrupted_);
    was_interrupted_ = was_interrupted_ || passed_on_->interrupted();
  }

  /// The steps under way are computed again: what that takes was counted before.
  void take_up_steps() {
    Time latest(0.0);
    for (std::size_t body = 0; body < numbers_.size(); ++body)
      latest = std::max(latest, state(body).time);
    double until = latest.value();  // not before the trailing double of the time
    if (Time(until) < latest) until = std::nextafter(until, std::numeric_limits<double>::max());
    world_.run_until(until, *passed_on_, interrupted_);
    const StepsUnderWay now = world_.steps_under_way();
    counted_before_ = world_.step_counts().force_evaluations - now.evaluations;
    taken_up_ = now.predicted;
  }
  /// As if the run had never stopped.
  void count_steps(SingleRunResult& result) {
    result.steps = options_.steps;
    result.evaluations = options_.evaluations;
    if (!taken_up_) return;
    const StepsUnderWay now = world_.steps_under_way();
    if (goes_on_) result.steps.force_evaluations = options_.evaluations.count;
    result.steps += world_.step_counts();
    if (options_.evaluations.predicted) result.steps.force_evaluations -= counted_before_;
    result.evaluations = {result.steps.force_evaluations - now.evaluations, now.predicted};
  }

  void note_end(std::size_t body) {
    const int b = static_cast<int>(body);
    const std::size_t p = number(body);
    ParticleProgress& now = progress_[p];
    now.state = world_.state(b);
    now.speed = world_.particle(b).speed;
    now.hits = world_.hits(b);
    now.contacts += passed_on_->contacts_of(p);
    if (world_.last_wall(b) >= 0) now.last_wall = world_.last_wall(b);
    now.hole = world_.hole(b);
    if (trust_) now.trust = trust_->trust(b);
    now.energy = integrated_ ? world_.energy_balance(b) : free_->of(numbers_[body]);
    const std::optional<EndEvent>& end = passed_on_->end_of(p);
    now.fate = end ? end->fate : Fate::survived;
    const bool until_stop = now.fate == Fate::survived || now.fate == Fate::pinned;
    // What is pinned without a last time has been followed to its end.
    const bool endless = without_end_ && now.fate == Fate::pinned;
    now.end = !until_stop                   ? end->time
              : was_interrupted_ || endless ? now.state.time
                                            : Time(system_.run.t_max);
  }

  /// The states of all particles at their ends.
  std::vector<State> last_states() const {
    std::vector<State> last(all_.size());
    for (std::size_t p = 0; p < all_.size(); ++p) {
      const int region = region_of(*system_.table, progress_[p].state.wall);
      last[p] = moved_on(in_region(*system_.table, all_[p], region), progress_[p]);
    }
    for (std::size_t body = 0; body < numbers_.size(); ++body)
      last[number(body)] = world_.state_at(static_cast<int>(body), progress_[number(body)].end);
    return last;
  }

  std::vector<EnergyError> energy_errors(const std::vector<State>& last) {
    // Particles that share their energy are all there until the first of them is gone.
    const bool all_are_there =
        numbers_.size() == all_.size() &&
        std::none_of(progress_.begin(), progress_.end(), [](const ParticleProgress& one) {
          return gone(one.fate) || one.fate == Fate::capped;
        });
    const std::vector<Energy> at_end =
        energies_of([&](std::size_t body) { return last[number(body)]; });
    std::vector<EnergyError> errors;
    for (const ParticleProgress& one : progress_)
      errors.push_back(one.energy.error_at_end(one.energy.change, 0.0));
    for (std::size_t body = 0; body < numbers_.size(); ++body) {
      const std::size_t p = number(body);
      if (shared_ ? all_are_there && !summing_.stopped() : integrated_) {
        const bool from_here = goes_on_ && !starts_known_;  // at_start_ is of this part alone
        const double before = from_here ? options_.resume[p].energy.change : 0.0;
        const double change = at_end[body].total() - at_start_[body].total();
        errors[p] = progress_[p].energy.error_at_end(before + change, at_end[body].kinetic);
      } else if (!shared_) {
        const double error = speed_error(world_.particle(static_cast<int>(body)), last[p]);
        errors[p] = {error, larger(errors[p].largest, std::fabs(error))};
      }
    }
    return errors;
  }

  SingleRunResult result() {
    const std::vector<State> last = last_states();
    const std::vector<EnergyError> errors = energy_errors(last);
    SingleRunResult result;
    for (std::size_t p = 0; p < all_.size(); ++p) {
      result.particles.push_back(as_seen(system_, progress_[p], last[p], errors[p]));
      RunEnd& end = result.particles.back();
      if (!trust_) end.progress.trust.open = false;  // an earlier part of the run may have flown
      end.trust =
          trust_ ? trust_->at_end(all_[p], progress_[p].state, progress_[p].trust, progress_[p].end)
                 : end.progress.trust;
      result.collisions += progress_[p].hits;
      result.contacts += progress_[p].contacts;
    }
    result.contacts /= 2;
    for (std::size_t body = 0; body < numbers_.size(); ++body)
      result.particles[number(body)].report = world_.report(static_cast<int>(body));
    result.interrupted = was_interrupted_;
    result.decisions = world_.decisions();
    count_steps(result);
    result.seconds = options_.seconds + watch_.seconds();
    result.cpu_seconds = options_.cpu_seconds + watch_.cpu_seconds();
    if (options_.estimate_state_error && system_.has_forces()) estimate_state_error(result, last);
    return result;
  }

  /// The run is repeated from its start, also one that goes on.
  void estimate_state_error(SingleRunResult& result, const std::vector<State>& last) {
    const auto any_unresolved = [&] {
      return std::any_of(progress_.begin(), progress_.end(),
                         [](const ParticleProgress& one) { return one.fate == Fate::unresolved; });
    };
    double end = 0.0;
    for (const ParticleProgress& p : progress_) end = std::max(end, p.end.value());
    try {
      if (!interrupted_())
        result.state_error =
            state_error(system_, options_.trajectory, end, options_.interrupted, last);
    } catch (const SamplingStopped&) {  // the run itself has its result
    }
    if (!result.state_error)
      result.no_state_error = any_unresolved() ? "a step did not resolve the forces"
                              : interrupted_() ? "interrupted"
                                               : "no time has passed";
  }

  const System& system_;
  const SingleRunOptions& options_;
  const Stopwatch watch_;
  World world_;
  const bool integrated_, shared_, goes_on_, without_end_;
  const Sampler sampler_{system_, options_.interrupted};
  bool was_interrupted_ = false;
  bool starts_known_ = false;         ///< of a run that goes on, where they are needed
  std::uint64_t counted_before_ = 0;  ///< evaluations
  bool taken_up_ = true;              ///< false: interrupted before the run went on
  const std::function<bool()> interrupted_ = [this] {
    was_interrupted_ = was_interrupted_ || (options_.interrupted && options_.interrupted());
    return was_interrupted_;
  };
  /// The energies of many that interact take seconds: worth nothing where that was interrupted.
  base::Interrupt summing_{&interrupted_};
  std::vector<Particle> all_ = system_.particles;  ///< those that enter later, too
  std::vector<ParticleProgress> progress_;         ///< of each of all
  // Particles that ended in an earlier part of the run are not in the world.
  std::vector<int> numbers_;
  std::vector<Particle> particles_;
  std::optional<Renumbering> passed_on_;
  std::optional<TrustRecorder> trust_;
  std::optional<engines::FreeEnergies> free_;
  std::vector<Energy> at_start_;
};

}  // namespace

EnergyError energy_error_of(const SingleRunResult& result) {
  EnergyError all;
  for (const RunEnd& particle : result.particles) all += particle.energy_error;
  return all;
}

bool estimates_trust(const System& system) {
  return !system.is_integrated() && !system.of_discs() && !scatters(*system.table) &&
         system.table->regions.empty() && table::bezier_wall(*system.table) == nullptr;
}

SingleRunResult run_single(const System& system, Observer& observer,
                           const SingleRunOptions& options) {
  return SingleRun(system, observer, options).run();
}

}  // namespace carom
