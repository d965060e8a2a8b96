#include "carom/events/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "carom/base/error.hpp"
#include "carom/events/report.hpp"
#include "events/group_hit.hpp"
#include "events/table_with_supports.hpp"
#include "events/world_implementation.hpp"
#include "motion/free_motion.hpp"
#include "table/flat_arcs.hpp"

namespace carom {

using geometry::Cell;
using geometry::Vector;

namespace {

/// Tables from files were asked when they were built; this one may be made by hand.
const Table& with_bent_arcs(const Table& table) {
  for (const Wall& wall : table.walls)
    if (const std::string fault = flat_arc(wall); !fault.empty()) throw InputError(Place{}, fault, bent_enough);
  return table;
}

}  // namespace

World::Implementation::Implementation(const Table& the_table, const Dynamics& how, DecisionOptions options)
    : table(with_bent_arcs(the_table)),
      scales(the_table),
      dynamics(how),
      with_supports(table_with_supports(the_table, how)),
      wall_count(static_cast<int>(the_table.walls.size())),
      finder(with_supports.walls.empty() ? the_table : with_supports, options) {
  const std::vector<Wall>& walls = finder.table().walls;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& w = walls[i];
    corners.push_back(w.next == static_cast<int>(i) && geometry::is_closed(w.curve) ? 0
                      : w.corner > 0 ? w.corner
                                     : finder.exact().corner(w.previous, static_cast<int>(i)).order);
  }
  add_barriers();
  add_contacts();
}

/// What comes next for a particle, into its queue entry.
[[gnu::always_inline]] inline void World::Implementation::predict(int index, Body& b) {
  finder.next(b.flight, b.ahead, counts);
  enqueue(index, b);
}

/// The particle's entry, from what lies ahead of it.
[[gnu::always_inline]] inline void World::Implementation::enqueue(int index, const Body& b) {
  Time when = b.state.time + b.ahead.duration;
  EventKind kind = EventKind::hit;
  switch (b.ahead.kind) {
    case Ahead::Kind::wall: break;
    case Ahead::Kind::edge: kind = EventKind::cell_edge; break;
    case Ahead::Kind::joint:
    case Ahead::Kind::cusp: kind = EventKind::singular; break;
    case Ahead::Kind::none:
      when = b.state.time;
      if (b.particle.omega != 0.0 && b.state.wall < 0)
        kind = EventKind::pinned;
      else if (b.particle.omega == 0.0 && finder.table().extent == Extent::open_plane)
        kind = EventKind::unbounded;
      else
        kind = EventKind::lost;
      break;
  }
  if (by_range) {
    // Nothing but another particle may lie ahead.
    if (kind == EventKind::pinned || kind == EventKind::unbounded) when = never;
    if (b.check < when) {
      when = b.check;
      kind = EventKind::group;
    }
  }
  queue.update(index, when, static_cast<int>(kind));
}

void World::Implementation::fly(int index) { predict(index, bodies[static_cast<std::size_t>(index)]); }
void World::Implementation::fly_on(int index) { enqueue(index, bodies[static_cast<std::size_t>(index)]); }
void World::Implementation::apply_own(int index, Observer& observer) { apply(index, queue.key(index).time, observer); }

void World::Implementation::end(int index, Fate fate, Time time, Observer* observer, std::string_view why) {
  Body& b = bodies[static_cast<std::size_t>(index)];
  b.fate = fate;
  b.finished = true;
  queue.remove(index);
  if (fate == Fate::lost || fate == Fate::singular || fate == Fate::unresolved)
    b.report = report_of(b.particle, b.state, fate, why);
  if (observer) observer->end({index, fate, time, b.state, b.hole, b.hits});
}

[[gnu::always_inline]] inline void World::Implementation::reflect(int index, Body& b, Time now, Observer& observer,
                                                              const HitFinder::Landing& landing) {
  const Vector before = landing.velocity;
  const Vector normal = landing.at.normal;
  const double step = step_to_energy_shell(before, b.shell);
  Vector after;
  int reflections = 1;
  if (b.ahead.kind == Ahead::Kind::joint) {
    reflections = corners[static_cast<std::size_t>(landing.wall)];
    if (reflections == 0) return end(index, Fate::singular, now, &observer);
    const int previous = finder.table().walls[static_cast<std::size_t>(landing.wall)].previous;
    after = (1.0 + step) * reflected_at_corner(before, finder.normal_at_end(previous), normal, reflections);
  } else {
    after = geometry::reflected(before, normal, landing.at.factor, step);
  }
  Sign inward = finder.inward(landing.wall, *landing.curve, landing.at.u, after, normal, counts);
  if (inward == Sign::negative && reflections == 1) {
    // A grazing rounding: reflecting once more turns it back.
    after = geometry::reflected(after, normal, dot(normal, normal), 1.0, 0.0);
    inward = finder.inward(landing.wall, *landing.curve, landing.at.u, after, normal, counts);
  }
  if (inward != Sign::positive) return end(index, Fate::singular, now, &observer);

  b.state.wall = landing.wall;
  b.state.u = landing.at.u;
  b.state.position = landing.at.point;
  b.state.velocity = after;
  b.state.cell.first += landing.cell.first;
  b.state.cell.second += landing.cell.second;
  b.state.time.high = now.high;
  b.state.time.low = now.low;
  b.hits += static_cast<std::uint64_t>(reflections);
  b.last_wall = landing.wall;
  finder.begin_on_wall(b.flight, landing.wall, *landing.curve, landing.at.u, landing.at.point, after);
  event.particle = index;
  event.wall = landing.wall;
  event.u = landing.at.u;
  event.time.high = now.high;
  event.time.low = now.low;
  event.flight_time = b.ahead.duration;
  event.position = landing.at.point;
  event.cell.first = b.state.cell.first;
  event.cell.second = b.state.cell.second;
  event.before = before;
  event.after = after;
  event.reflections = reflections;
  if (b.hits >= limit) {
    observer.hit(event);
    return end(index, Fate::capped, now, &observer);
  }
  if (!surroundings.supports.empty() && integrated_at(b.state.position)) [[unlikely]] {
    observer.hit(event);
    return integrate(index, now, observer);  // an edge meets the wall there, and the flight would be beyond it
  }
  predict(index, b);  // first, while its numbers are at hand
  observer.hit(event);
}

[[gnu::always_inline]] inline void World::Implementation::apply(int index, Time now, Observer& observer) {
  Body& b = bodies[static_cast<std::size_t>(index)];
  if (b.group >= 0) return apply_group(index, observer);
  const int kind = queue.key(index).kind;
  if (kind != static_cast<int>(EventKind::hit)) switch (static_cast<EventKind>(kind)) {
    case EventKind::pinned: return end(index, Fate::pinned, now, &observer);
    case EventKind::unbounded: return end(index, Fate::unbounded, b.state.time, &observer);
    case EventKind::cell_edge:
      finder.cross(b.flight, b.ahead);
      return predict(index, b);
    case EventKind::hit:
    case EventKind::singular: break;
    case EventKind::group: return meet(index, observer);
    default: return end(index, Fate::lost, b.state.time, &observer);
  }
  if (b.ahead.kind == Ahead::Kind::cusp) return end(index, Fate::singular, now, &observer);
  HitFinder::Landing landing;
  finder.land(b.flight, b.ahead, landing, counts);
  if (is_support(landing.wall)) [[unlikely]] {
    const HitFinder::Landing there = landing;  // a copy, or the landing would live in memory
    return enter_support(index, there, observer);
  }
  if (b.ahead.kind == Ahead::Kind::joint) {
    for (const int h : finder.table().walls[static_cast<std::size_t>(landing.wall)].holes)
      if (finder.table().holes[static_cast<std::size_t>(h)].from == 0.0) landing.hole = h;
  }
  if (landing.hole >= 0) {
    b.hole = landing.hole;
    return end(index, Fate::escaped, now, &observer);
  }
  reflect(index, b, now, observer, landing);
}

State World::Implementation::state_at(const Body& b, Time t) const {
  if (b.group >= 0) {
    Group& group = *groups[static_cast<std::size_t>(b.group)];
    const auto& members = group.bodies();
    const auto member = std::find(members.begin(), members.end(), static_cast<int>(&b - bodies.data()));
    return group.state_at(static_cast<std::size_t>(member - members.begin()), t);
  }
  return flown(b.state, b.particle.omega, t);
}

/// Does the step under way fail? There are no states within it.
bool World::Implementation::fails_before(const Body& b, Time t) const {
  if (b.group < 0) return false;
  const Group& group = *groups[static_cast<std::size_t>(b.group)];
  return !group.next().fault.empty() && group.time() < t;
}

/// Ends every particle whose step under way failed where that step begins, also if it would end later than the run. True if
/// others go on from there.
bool World::Implementation::end_failed_steps(Time t_end, Observer& observer) {
  bool others = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].finished || !fails_before(bodies[i], t_end)) continue;
    const Group& group = *groups[static_cast<std::size_t>(bodies[i].group)];
    apply_group(group.bodies().front(), observer);
    others = others || !group.bodies().empty();
  }
  return others;
}

void World::Implementation::emit_samples(Time until, bool inclusive, Observer& observer) {
  for (;;) {
    double t = 0.0;
    if (!sample_times.empty()) {
      if (next_sample >= sample_times.size()) return;
      t = sample_times[next_sample];
    } else if (sample_interval > 0.0) {
      t = static_cast<double>(next_sample) * sample_interval;
    } else {
      return;
    }
    if (inclusive ? Time(t) > until : !(Time(t) < until)) return;
    bool any = false;
    seen.clear();  // all of an instant, or nothing
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i].finished && bodies[i].fate != Fate::pinned) continue;
      any = true;
      if (bodies[i].state.time > Time(t)) continue;  // it is still to come
      if (fails_before(bodies[i], t)) continue;
      seen.emplace_back(static_cast<int>(i), state_at(bodies[i], t));
      if (interrupt.after(100.0)) return;
    }
    for (const auto& [particle, state] : seen) observer.sample(particle, t, state);
    if (!any) return;  // nobody is left to be sampled
    observer.sampled(t);
    ++next_sample;
  }
}

World::World(const Table& table, DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, Dynamics{}, options)) {}
World::World(const Table& table, const Dynamics& dynamics, DecisionOptions options)
    : implementation_(std::make_unique<Implementation>(table, dynamics, options)) {}
World::~World() = default;
World::World(World&&) noexcept = default;

void World::Implementation::check_speed(const Body& b) const {
  // The bounds of the filter count on the energy shell, as reflections keep it (circle_error).
  const double shell = b.particle.speed * b.particle.speed;
  if (!(std::fabs(dot(b.state.velocity, b.state.velocity) - shell) <= 64.0 * geometry::unit_roundoff * shell))
    throw std::invalid_argument("the velocity's length is not the particle's speed");
}

/// Starts a flight from the body's state.
void World::Implementation::begin_free(Body& b) {
  b.shell = energy_shell(b.particle.speed);
  b.flight = Flight();
  b.flight.omega = b.particle.omega;
  b.flight.square_speed = b.particle.speed * b.particle.speed;
  if (b.state.wall >= 0) {
    const auto [point, normal, square, k] = finder.curve(b.state.wall).frame(b.state.u);
    // A state that went on from a hit keeps its point; any other starts at the image of u.
    if (finder.curve(b.state.wall).parameter(b.state.position) != b.state.u) b.state.position = point;
    DecisionCounts unused;
    if (finder.inward(b.state.wall, b.state.u, b.state.velocity, normal, unused) != Sign::positive)
      throw std::invalid_argument("the velocity does not point into the domain");
    finder.begin_on_wall(b.flight, b.state.wall, b.state.u, b.state.position, b.state.velocity);
  } else {
    b.flight.start = b.state.position;
    b.flight.velocity = b.state.velocity;
    finder.begin(b.flight);
  }
}

int World::add(const Particle& particle, const State& state, std::uint64_t hits) {
  Implementation& w = *implementation_;
  Body b;
  b.particle = particle;
  b.state = state;
  b.hits = hits;
  b.last_event = state.time;
  if (state.wall < 0 && !contains(state.position))
    throw std::invalid_argument("the point does not lie inside the table");
  const bool rests = state.velocity == Vector{};
  // Where particles meet within a range, one that rests may be met.
  const bool integrated = w.integrates && (w.integrated_at(state.position) || (w.by_range && rests));
  // Where forces act, the speed is not a constant: it is that of the start.
  if (w.integrates) b.particle.speed = std::sqrt(dot(state.velocity, state.velocity));
  if (w.contacts) w.check_disc(b);
  if (!w.integrates)
    if (const std::string fault = w.scales.fault(b.particle); !fault.empty()) throw std::invalid_argument(fault);
  if (!integrated) {
    if (rests && !w.contacts) throw std::invalid_argument("the velocity is zero and no force acts there");
    w.check_speed(b);
    if (!w.contacts || b.particle.speed > 0.0) w.begin_free(b);
    if (w.by_range) b.check = state.time;
  }
  w.balances.push_back({0.0, 0.0, 0.5 * b.particle.mass * dot(state.velocity, state.velocity)});
  w.changes.emplace_back();
  w.bodies.push_back(std::move(b));
  const int index = static_cast<int>(w.bodies.size()) - 1;
  w.queue.push({});
  if (integrated)
    w.wait(index);
  else if (w.contacts)
    w.add_disc(index);
  else
    w.fly(index);
  return index;
}

void World::clear() {
  Implementation& w = *implementation_;
  w.bodies.clear();
  w.balances.clear();
  w.changes.clear();
  w.steps = {};
  w.queue.clear();
  w.idle_groups.clear();
  for (std::size_t i = 0; i < w.groups.size(); ++i) w.idle_groups.push_back(static_cast<int>(i));
  w.waiting.clear();
  if (w.contacts) w.contacts->clear();
  w.clock = Time();
  w.next_sample = 0;
}

void World::stop_when(std::function<bool()> enough) { implementation_->enough = std::move(enough); }
void World::limit_hits(std::uint64_t hits) { implementation_->limit = hits; }
void World::sample_at(std::vector<double> times) {
  implementation_->sampling = !times.empty();
  implementation_->sample_times = std::move(times);
  implementation_->next_sample = 0;
}
void World::sample_every(double interval) {
  implementation_->sampling = interval > 0.0;
  implementation_->sample_interval = interval;
  implementation_->next_sample = 0;
}

std::uint64_t World::run_until(double t_end, Observer& observer, const std::function<bool()>& interrupted) {
  Implementation& w = *implementation_;
  std::uint64_t events = 0;
  w.interrupt = Interrupt(&interrupted);
  const struct Over {
    Interrupt& interrupt;
    ~Over() { interrupt = Interrupt(); }
  } over{w.interrupt};
  if (w.surface) w.begin_watching();
  if (w.unprepared && !w.prepare_contacts()) return events;
  if (w.unpredicted) w.predict_again();
  const bool asks = static_cast<bool>(w.enough);
  // Asking may cost more than a flight, and less than a step.
  const std::uint64_t between_questions = w.integrates || w.contacts ? 16 : 256;
  do {
    while (!w.queue.empty()) {
      if (asks && w.enough()) return events;
      const int index = w.queue.top();
      const Time when(w.queue.key(index).time.high, w.queue.key(index).time.low);
      if (!(when.high < t_end) && when > Time(t_end)) break;
      if (w.interrupt.stopped()) return events;
      if (interrupted && events % between_questions == 0 && interrupted()) return events;
      if (w.sampling) w.emit_samples(when, false, observer);
      if (w.interrupt.stopped()) return events;
      if (w.contacts) [[unlikely]]
        w.apply_disc(index, observer);
      else
        w.apply(index, when, observer);
      if (w.surface) w.watch_event(index, when, observer);
      ++events;
    }
    if (w.interrupt.stopped()) return events;
    if (w.sampling) w.emit_samples(t_end, true, observer);
    if (w.interrupt.stopped()) return events;
  } while (w.integrates && w.end_failed_steps(t_end, observer));
  if (w.surface) w.watch_until(t_end, observer);
  return events;
}

int World::size() const { return static_cast<int>(implementation_->bodies.size()); }
namespace {
const Body& body(const std::vector<Body>& bodies, int particle) {
  return bodies.at(static_cast<std::size_t>(particle));
}
}  // namespace
bool World::finished(int p) const { return body(implementation_->bodies, p).finished; }
Fate World::fate(int p) const { return body(implementation_->bodies, p).fate; }
const State& World::state(int p) const { return body(implementation_->bodies, p).state; }
State World::state_at(int p, Time t) const {
  return implementation_->state_at(body(implementation_->bodies, p), t);
}
const Particle& World::particle(int p) const { return body(implementation_->bodies, p).particle; }
std::uint64_t World::hits(int p) const { return body(implementation_->bodies, p).hits; }
int World::last_wall(int p) const { return body(implementation_->bodies, p).last_wall; }
int World::hole(int p) const { return body(implementation_->bodies, p).hole; }
const DecisionCounts& World::decisions() const { return implementation_->counts; }
const std::string& World::report(int p) const { return body(implementation_->bodies, p).report; }

bool World::Implementation::contains(Vector point) {
  if (finder.surely_inside(point)) return true;
  if (!locator) locator = std::make_unique<Locator>(contacts ? finder.table() : table);
  return locator->contains(point);
}
bool World::contains(Vector point) const { return implementation_->contains(point); }

}  // namespace carom
