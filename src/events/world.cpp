#include "carom/events/world.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/interrupt.hpp"
#include "carom/base/error.hpp"
#include "carom/events/decision_range.hpp"
#include "events/bodies.hpp"
#include "events/disc/disc_contacts.hpp"
#include "events/flight/free_flights.hpp"
#include "events/samples.hpp"
#include "events/section_watch.hpp"
#include "events/step/force_regions.hpp"
#include "events/step/groups.hpp"
#include "events/step/integration.hpp"
#include "table/bezier_wall.hpp"
#include "table/flat_arcs.hpp"

namespace carom {

using namespace events;
using base::Interrupt;
using geometry::Vector;

namespace {

/// Tables from files were asked when they were built; this one may be made by hand.
const Table& without_misplaced(const Table& table) {
  const table::FlightSizes sizes = table::flight_sizes(table);
  for (const Wall& wall : table.walls)
    if (const table::Misplaced found = table::misplaced(wall, sizes); !found.fault.empty())
      throw InputError(Place{}, found.fault, found.expected);
  return table;
}

/// Steps and contacts know mirrors alone; contacts, segments and conics.
const Dynamics& without_other_walls(const Table& table, const Dynamics& dynamics) {
  if (!dynamics.everywhere && !has_discs(dynamics) &&
      (!dynamics.forces || dynamics.forces->empty()))
    return dynamics;
  refuse_all_but_mirrors(table, "forces, steps or hard discs");
  if (has_discs(dynamics) && table::bezier_wall(table) != nullptr)
    throw InputError(Place{}, "hard discs beside Bézier curves",
                     "walls of segments, circles and ellipses, or point particles");
  return dynamics;
}

/// What free flights meet beyond the user's walls, or in their place; without walls if there is no
/// such thing.
Table walls_of_flights(const Table& table, const Dynamics& dynamics) {
  if (!table.regions.empty()) return seen_from(table, -1);
  return has_discs(dynamics) ? table_of_discs(table, dynamics)
                             : table_with_supports(table, dynamics);
}

}  // namespace

/// The parts of a world. Each knows those above it alone.
class World::Implementation {
 public:
  Implementation(const Table& the_table, const Dynamics& how, DecisionOptions options)
      : table(without_misplaced(the_table)),
        scales(the_table),
        dynamics(without_other_walls(the_table, how)),
        own_walls(std::make_shared<const Table>(walls_of_flights(table, dynamics))),
        flights(PieceTable(walls(), options), inside(), regions, bodies,
                Media::of(table, options)) {
    if (has_discs(dynamics)) discs.emplace(table, dynamics, bodies, flights, watch, interrupt);
  }
  /// Of the same table and forces; what was prepared is shared.
  explicit Implementation(const Implementation& like)
      : table(like.table),
        scales(like.scales),
        dynamics(like.dynamics),
        own_walls(like.own_walls),
        flights(like.flights.pieces(), inside(), regions, bodies, like.flights.media()) {
    if (has_discs(dynamics)) discs.emplace(table, dynamics, bodies, flights, watch, interrupt);
  }

  const Table& walls() const { return own_walls->walls.empty() ? table : *own_walls; }
  const Table& inside() const {
    return has_discs(dynamics) || !table.regions.empty() ? walls() : table;
  }

  bool begin_run() {
    if (watch.active()) watch.begin_run();
    if (discs && !discs->begin_run()) return false;
    groups.predict_again();
    return true;
  }
  std::uint64_t run_until(double t_end, Observer& observer,
                          const std::function<bool()>& interrupted);
  void apply(int index, Time when, Observer& observer);

  const Table& table;          ///< the user's
  const DecisionRange scales;  ///< of it
  const Dynamics dynamics;
  const std::shared_ptr<const Table> own_walls;
  Interrupt interrupt;           ///< of the run under way
  std::function<bool()> enough;  ///< ends a run, or is empty
  Bodies bodies;
  ForceRegions regions{table, walls(), dynamics};
  FreeFlights flights;
  SectionWatch watch{table, bodies};
  Groups groups{table, dynamics, regions, flights, bodies, interrupt};
  Integration integration{table, dynamics, regions, bodies, flights, groups, watch};
  std::optional<DiscContacts> discs;  ///< where all particles are hard discs
  Samples samples{bodies, groups, interrupt};
};

[[gnu::always_inline]] inline void World::Implementation::apply(int index, Time when,
                                                                Observer& observer) {
  if (discs) [[unlikely]]
    discs->apply(index, observer);
  else if (bodies[index].group != nullptr || !flights.apply(index, when, observer))
    integration.apply(index, when, observer);
  if (watch.active()) watch.after_event(index, when, observer);
}

std::uint64_t World::run_until(double t_end, Observer& observer,
                               const std::function<bool()>& interrupted) {
  Interrupt& interrupt = implementation_->interrupt;
  interrupt = Interrupt(&interrupted);
  const struct Over {
    Interrupt& interrupt;
    ~Over() { interrupt = Interrupt(); }
  } over{interrupt};
  return implementation_->run_until(t_end, observer, interrupted);
}

// A function of its own: where an exception has something to destroy in it, the compiler keeps the
// numbers of a flight in memory, which costs a fifth of a hit.
[[gnu::noinline]] std::uint64_t World::Implementation::run_until(
    double t_end, Observer& observer, const std::function<bool()>& interrupted) {
  std::uint64_t events = 0;
  if (!begin_run()) return events;
  const bool asks = static_cast<bool>(enough);
  const bool works = regions.any() || discs;  // an event may be interrupted
  const bool attended = asks || works || samples.any();
  const bool alone = !attended && !watch.active() && bodies.size() == 1;
  // Asking may cost more than a flight, and less than a step: once in 16 or 256 events.
  const std::uint64_t between_questions = works ? 15 : 255;
  do {
    while (!bodies.all_ended()) {
      if (attended && asks && enough()) return events;
      const int index = bodies.first();
      const Time when(bodies.when(index).high, bodies.when(index).low);
      if (!(when.high < t_end) && when > Time(t_end)) break;
      if (interrupted && (events & between_questions) == 0 && interrupted()) return events;
      if (attended) {
        if (interrupt.stopped()) return events;
        if (samples.any()) samples.emit(when, false, observer);
        if (interrupt.stopped()) return events;
      }
      if (alone) {  // as far as its hits are plain; none where the table has holes
        const std::uint64_t unasked = between_questions + 1 - (events & between_questions);
        const std::uint64_t hits = flights.apply_hits(index, t_end, unasked, observer);
        events += hits;
        if (hits > 0) continue;
      }
      apply(index, when, observer);
      ++events;
    }
    if (interrupt.stopped()) return events;
    if (samples.any()) samples.emit(t_end, true, observer);
    if (interrupt.stopped()) return events;
  } while (regions.any() && integration.end_failed_steps(t_end, observer));
  if (watch.active()) {
    watch.watch_flights(t_end, observer);
    integration.watch_steps(t_end, observer);
  }
  return events;
}

World::World(const Table& table, DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, Dynamics{}, options)) {}
World::World(const Table& table, const Dynamics& dynamics, DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, dynamics, options)) {}
World::World(std::unique_ptr<Implementation> made) : implementation_(std::move(made)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World World::empty_copy() const {
  return World(std::make_unique<Implementation>(*implementation_));
}

int World::add(const Particle& particle, const State& state, std::uint64_t hits, double speed) {
  Implementation& w = *implementation_;
  Body b;
  b.particle = particle;
  b.state = state;
  b.hits = hits;
  b.last_event = state.time;
  if (state.wall < 0 && !contains(state.position))
    throw std::invalid_argument("the point does not lie inside the table");
  const bool rests = state.velocity == Vector{};
  const bool forces = w.regions.any(), by_range = w.regions.by_range();
  // A particle that rests may be met by one that comes within its range.
  const bool integrated = forces && (w.regions.hold(state.position) || (by_range && rests));
  // Under forces, of discs and between thermal walls the speed is not a constant: this is that of
  // the start.
  if (forces || w.discs || w.flights.change_speeds())
    b.particle.speed = speed > 0.0 ? speed : std::sqrt(dot(state.velocity, state.velocity));
  if (w.discs) w.discs->check(b);
  if (!forces)
    if (const std::string fault = w.scales.fault(b.particle); !fault.empty())
      throw std::invalid_argument(fault);
  if (!integrated) {
    w.flights.enter(b);
    if (rests && !w.discs)
      throw std::invalid_argument("the velocity is zero and no force acts there");
    w.flights.check_speed(b);
    if (!w.discs || b.particle.speed > 0.0) w.flights.begin(b);
    if (by_range) b.check = state.time;
  }
  w.groups.energies().add(0.5 * b.particle.mass * dot(state.velocity, state.velocity));
  const int index = w.bodies.add(std::move(b));
  if (integrated)
    w.integration.add(index);
  else if (w.discs)
    w.discs->add(index);
  else
    w.flights.predict(index);
  return index;
}

void World::clear() {
  Implementation& w = *implementation_;
  w.bodies.clear();
  w.watch.clear();
  w.groups.clear();
  w.integration.clear();
  if (w.discs) w.discs->clear();
  w.samples.restart();
}

void World::stop_when(std::function<bool()> enough) { implementation_->enough = std::move(enough); }
void World::scatter_by(std::uint64_t seed, std::uint64_t trajectory, std::vector<int> numbers) {
  implementation_->flights.scatter_by(seed, trajectory, std::move(numbers));
}
void World::limit_hits(std::uint64_t hits) { implementation_->bodies.limit_hits(hits); }
void World::sample_at(std::vector<double> times) { implementation_->samples.at(std::move(times)); }
void World::sample_every(double interval) { implementation_->samples.every(interval); }
void World::watch(const Surface* surface, std::size_t most) {
  implementation_->watch.watch(surface, most);
}

int World::size() const { return implementation_->bodies.size(); }
bool World::finished(int p) const { return implementation_->bodies.at(p).finished; }
Fate World::fate(int p) const { return implementation_->bodies.at(p).fate; }
State World::state(int p) const {
  implementation_->bodies.at(p);
  return implementation_->bodies.state(p);
}
State World::state_at(int p, Time t) const {
  const Body& body = implementation_->bodies.at(p);
  // Pinned particles go round for ever, and those that no wall follows fly on; the others move no
  // more, wherever a flight would lead.
  const bool goes_on = body.fate == Fate::pinned || body.fate == Fate::unbounded;
  const bool over = body.finished && !goes_on && body.ended < t;
  return implementation_->groups.state_at(p, over ? body.ended : t);
}
const Particle& World::particle(int p) const { return implementation_->bodies.at(p).particle; }
std::uint64_t World::hits(int p) const { return implementation_->bodies.at(p).hits; }
int World::last_wall(int p) const { return implementation_->bodies.at(p).last_wall; }
int World::hole(int p) const { return implementation_->bodies.at(p).hole; }
const std::string& World::report(int p) const { return implementation_->bodies.at(p).report; }
const DecisionCounts& World::decisions() const { return implementation_->flights.counts(); }
const StepCounts& World::step_counts() const { return implementation_->groups.steps(); }
StepsUnderWay World::steps_under_way() const { return implementation_->groups.under_way(); }

void World::watch_energy() { implementation_->groups.watch_energy(); }
const EnergyBalance& World::energy_balance(int p) const {
  return implementation_->groups.energies().balance(p);
}
void World::set_energy_balance(int p, const EnergyBalance& before) {
  implementation_->groups.energies().set_balance(p, before);
}

bool World::contains(Vector point) const { return implementation_->flights.contains(point); }
const PieceTable& World::pieces() const { return implementation_->flights.pieces(); }

}  // namespace carom
