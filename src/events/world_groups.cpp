// Integration and hand-over: groups of particles among the events of a world.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "carom/base/error.hpp"
#include "events/group_hit.hpp"
#include "events/surroundings.hpp"
#include "events/table_with_supports.hpp"
#include "events/world_implementation.hpp"
#include "motion/free_motion.hpp"

namespace carom {

using geometry::Cell;
using geometry::Vector;

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool acts(const Dynamics& d) { return d.forces && !d.forces->empty(); }
bool acts_everywhere(const Dynamics& d) {
  const bool far = acts(d) && d.forces->interacts() && !std::isfinite(d.forces->pair_range());
  return d.everywhere || far || (acts(d) && d.forces->everywhere());
}

}  // namespace

Table table_with_supports(const Table& table, const Dynamics& dynamics) {
  Table result;
  if (dynamics.forces && !dynamics.forces->disc_radii().empty()) return table_of_discs(table, dynamics);
  if (!acts(dynamics) || acts_everywhere(dynamics)) return result;
  result = table;
  result.crossing = !table.walls.empty();
  for (const Support& support : dynamics.forces->supports()) {
    Wall edge;
    edge.name = "support";
    edge.curve = geometry::Circle{support.center, support.radius, false};
    edge.next = edge.previous = static_cast<int>(result.walls.size());
    result.walls.push_back(edge);
  }
  return result;
}

void World::Implementation::add_barriers() {
  integrates = acts(dynamics) || dynamics.everywhere;
  if (!integrates) return;
  if (acts(dynamics) && dynamics.forces->interacts()) {
    by_range = !dynamics.everywhere && std::isfinite(dynamics.forces->pair_range());
    one_group = !by_range;
    if (by_range && !(dynamics.integrator.step > 0.0))
      throw InputError(Place{{}, 0, 0, "integrator.step"}, "particles that meet within a range need the length of a step",
                       "a time > 0");
  }
  surroundings.interrupt = &interrupt;
  surroundings.forces = acts(dynamics) ? dynamics.forces.get() : nullptr;
  surroundings.plan = dynamics.integrator;
  if (surroundings.forces) surroundings.maps = std::make_shared<ForceMaps>(*surroundings.forces);
  surroundings.counts = &steps;
  if (table.lattice) {
    surroundings.lattice = &*table.lattice;
    surroundings.centre = centre_of_cell(*table.lattice);
  }
  const std::vector<Wall>& walls = finder.table().walls;
  if (!walls.empty()) surroundings.longest_way = longest_way(table);
  std::vector<geometry::Curve> curves;
  for (std::size_t i = 0; i < walls.size(); ++i)  // what is inside a support is integrated
    curves.push_back(is_support(static_cast<int>(i)) ? geometry::reversed(walls[i].curve) : walls[i].curve);
  surroundings.barriers = barriers_of(curves, table);
  std::copy_if(surroundings.barriers.begin(), surroundings.barriers.end(), std::back_inserter(surroundings.supports),
               [&](const Barrier<double>& barrier) { return is_support(barrier.wall); });
  if (table.extent == Extent::bounded)
    surroundings.inside = [this](Vector x) {
      return on_some_wall(surroundings.barriers, wall_count, x) || contains(x);
    };
}

bool World::Implementation::integrated_at(Vector x) const {
  return acts_everywhere(dynamics) || in_some_support(surroundings.supports, x, nullptr);
}

void World::Implementation::form_group(std::vector<int> members) {
  std::vector<Particle> particles;
  for (const int i : members) particles.push_back(bodies[at(i)].particle);
  if (idle_groups.empty()) {
    idle_groups.push_back(static_cast<int>(groups.size()));
    groups.push_back(std::make_unique<Group>(surroundings));
  }
  const int number = idle_groups.back();
  idle_groups.pop_back();
  Group* group = groups[at(number)].get();
  group->assign(members, std::move(particles));
  for (std::size_t k = 0; k < members.size(); ++k) {
    Body& b = bodies[at(members[k])];
    group->phase().position[k] = b.state.position;
    group->phase().velocity[k] = b.state.velocity;
    group->cells()[k] = b.state.cell;
    b.group = number;
    // At a hit a particle stays where the wall is until its step ends.
    if (b.state.wall < 0) group->fold(k);
    // One entry a group: its first member's.
    queue.update(members[k], never, static_cast<int>(EventKind::group));
  }
  std::erase_if(waiting, [&](int i) { return bodies[at(i)].group == number; });
  group->set_time(bodies[at(members.front())].state.time);
  predict_group(members.front());
}

/// The body joins the integrated ones at its time.
void World::Implementation::wait(int index) {
  waiting.push_back(index);
  queue.update(index, bodies[at(index)].state.time, static_cast<int>(EventKind::group));
}

/// A particle that was waiting starts, or a free one looks whether another is near.
void World::Implementation::meet(int index, Observer& observer) {
  if (std::find(waiting.begin(), waiting.end(), index) != waiting.end()) return start_integrating(index, observer);
  const Time now = queue.key(index).time;
  look_around(index, now, observer);
}

void World::Implementation::start_integrating(int index, Observer& observer) {
  const Time now = bodies[at(index)].state.time;
  std::vector<int> members;
  if (one_group) {
    const auto first = std::find_if(bodies.begin(), bodies.end(), [](const Body& b) { return b.group >= 0; });
    if (first != bodies.end()) {
      Group& group = *groups[at(first->group)];
      // The step under way was cut to end now; without those who left the table in it, it is another one.
      while (!group.bodies().empty() && group.time() < now) apply_group(group.bodies().front(), observer);
      members = group.bodies();
      while (!group.bodies().empty()) take_out(group, group.bodies().size() - 1);
    }
    for (const int i : waiting)
      if (bodies[at(i)].state.time == now) members.push_back(i);
    std::sort(members.begin(), members.end());
    form_group(members);
  } else {
    integrate(index, now, observer);
  }
}

/// A particle is integrated from now on, with all that are near.
void World::Implementation::integrate(int index, const Time& now, Observer& observer) {
  double free_for = 0.0;
  const std::vector<int> members = company(index, now, free_for, observer);
  if (!members.empty()) join(members, now);
}

void World::Implementation::predict_group(int leader) {
  Group& group = *groups[at(bodies[at(leader)].group)];
  Time until = never;
  // Whoever is still to come may be near.
  if (one_group || by_range)
    for (const Body& b : bodies)
      if (!b.finished && b.group < 0 && b.state.time > group.time()) until = std::min(until, b.state.time);
  look_at_start(group);
  group.predict(until);
  // What was computed before an interrupt came is worth nothing.
  if (interrupt.stopped()) {
    unpredicted = true;
    group.drop_prediction();
  }
  queue.update(leader, group.next_time(), static_cast<int>(EventKind::group));
}

/// After a run that was interrupted within a prediction.
void World::Implementation::predict_again() {
  unpredicted = false;
  for (std::size_t i = 0; i < bodies.size() && !interrupt.stopped(); ++i)
    if (bodies[i].group >= 0 && groups[at(bodies[i].group)]->bodies().front() == static_cast<int>(i))
      predict_group(static_cast<int>(i));
  unpredicted = interrupt.stopped();
}

void World::Implementation::copy_states(const Group& group) {
  for (std::size_t k = 0; k < group.bodies().size(); ++k) {
    State& s = bodies[at(group.bodies()[k])].state;
    s.wall = -1;
    s.position = group.phase().position[k];
    s.velocity = group.phase().velocity[k];
    s.cell = group.cells()[k];
    s.time = group.time();
  }
}

void World::Implementation::apply_group(int leader, Observer& observer) {
  Group& group = *groups[at(bodies[at(leader)].group)];
  const Group::Next next = group.next();
  if (next.outside >= 0) {
    lose(group, at(next.outside), next.fault, observer);
    if (!group.bodies().empty()) predict_group(group.bodies().front());
    return;
  }
  if (!next.fault.empty()) {
    while (!group.bodies().empty()) lose(group, 0, next.fault, observer);
    return;
  }
  if (surface) watch_group(group, group.next_time(), observer);
  group.advance();
  look_at_end(group);
  if (next.member < 0)
    for (std::size_t k = 0; k < group.bodies().size(); ++k) group.fold(k);
  copy_states(group);
  if (next.member >= 0) {
    const std::size_t member = at(next.member);
    if (is_support(next.barrier->wall)) {
      if (leave_support(group, *next.barrier, observer)) return;
      group.pass(*next.barrier);
    } else {
      hit_in_group(group, member, *next.barrier, observer);
      if (group.bodies().empty()) return;
    }
  }
  if (next.member < 0 && group.between_steps()) {
    if (by_range && regroup(group, observer)) return;
    if (leave_between_supports(group, observer)) return;
  }
  predict_group(group.bodies().front());
}

/// Where the step under way begins.
void World::Implementation::lose(Group& group, std::size_t member, std::string_view why, Observer& observer) {
  const int body = group.bodies()[member];
  end(body, Fate::unresolved, group.time(), &observer, why);
  take_out(group, member);
}

/// A particle of a group is at a wall: it leaves through a hole or is reflected.
void World::Implementation::hit_in_group(Group& group, std::size_t member, const Barrier<double>& barrier,
                                         Observer& observer) {
  const int index = group.bodies()[member];
  Body& b = bodies[at(index)];
  const GroupHit hit = hit_of(finder, table, group, member, barrier, counts);
  b.state = hit.state;
  b.last_wall = barrier.wall;
  if (hit.hole >= 0) {
    b.hole = hit.hole;
    end(index, Fate::escaped, group.time(), &observer);
    take_out(group, member);
    return;
  }
  ++b.hits;
  group.phase().position[member] = hit.state.position;
  group.phase().velocity[member] = hit.state.velocity;
  group.cells()[member] = hit.state.cell;
  event.particle = index;
  event.wall = barrier.wall;
  event.u = hit.state.u;
  event.time = group.time();
  event.flight_time = group.time() - b.last_event;
  event.position = hit.state.position;
  event.cell = hit.state.cell;
  event.before = hit.before;
  event.after = hit.state.velocity;
  event.reflections = 1;
  b.last_event = group.time();
  if (!hit.inward) {
    end(index, Fate::singular, group.time(), &observer);
    take_out(group, member);
    return;
  }
  observer.hit(event);
  if (b.hits >= limit) {
    end(index, Fate::capped, group.time(), &observer);
    take_out(group, member);
  }
}

/// A particle comes to the edge of a support from inside. True if it flies freely from here on.
bool World::Implementation::leave_support(Group& group, const Barrier<double>& barrier, Observer& observer) {
  const Vector x = group.phase().position.front();
  Body& b = bodies[at(group.bodies().front())];
  const geometry::PreparedCurve& curve = finder.curve(barrier.wall);
  Cell cell = group.cells().front();
  cell.first += barrier.cell.first;
  cell.second += barrier.cell.second;
  const Vector own = table.lattice ? x - table.lattice->translation(barrier.cell) : x;
  const geometry::PreparedCurve::Frame frame = curve.settle(own);
  const Vector settled = table.lattice ? frame.point + table.lattice->translation(barrier.cell) : frame.point;
  // Where a wall meets the edge it comes first: beyond it, or on it, there is no flight.
  if (group.supported(settled, &barrier) || meets_some_wall(surroundings.barriers, wall_count, x, settled)) return false;
  const double u = curve.parameter(frame.point);
  const Vector velocity = group.phase().velocity.front();
  if (finder.inward(barrier.wall, u, velocity, frame.normal, counts) != Sign::positive) return false;
  const int index = group.bodies().front();
  b.state = {-1, 0.0, frame.point, velocity, cell, group.time()};
  b.particle.speed = std::sqrt(dot(velocity, velocity));
  b.shell = energy_shell(b.particle.speed);
  b.flight.omega = b.particle.omega;
  b.flight.square_speed = b.particle.speed * b.particle.speed;
  finder.begin_on_wall(b.flight, barrier.wall, u, frame.point, velocity);
  take_out(group, 0);
  fly(index);
  if (by_range) look_around(index, b.state.time, observer);
  return true;
}

/// A lone particle that ends a step outside of all supports has crossed an edge where it could not leave: along it to
/// rounding, or where it meets another edge or a wall. True if it flies freely from here on.
bool World::Implementation::leave_between_supports(Group& group, Observer& observer) {
  if (group.bodies().size() > 1 || surroundings.supports.empty()) return false;
  const int index = group.bodies().front();
  const Vector x = bodies[at(index)].state.position;
  if (bodies[at(index)].state.velocity == Vector{} || integrated_at(x) || !contains(x)) return false;
  take_out(group, 0);
  set_free(index);
  if (by_range) look_around(index, bodies[at(index)].state.time, observer);
  return true;
}

/// From its state on, which is inside the table and under no force.
void World::Implementation::set_free(int index) {
  Body& b = bodies[at(index)];
  b.particle.speed = std::sqrt(dot(b.state.velocity, b.state.velocity));
  begin_free(b);
  fly(index);
}

/// A free flight comes to the edge of a support.
void World::Implementation::enter_support(int index, const HitFinder::Landing& landing, Observer& observer) {
  Body& b = bodies[at(index)];
  const Time now = queue.key(index).time;
  b.state.position = landing.at.point;
  b.state.velocity = landing.velocity;
  b.state.cell.first += landing.cell.first;
  b.state.cell.second += landing.cell.second;
  b.state.time = now;
  b.state.wall = -1;
  integrate(index, now, observer);
}

void World::Implementation::take_out_of_group(int index) {
  Group& group = *groups[at(bodies[at(index)].group)];
  const auto& members = group.bodies();
  const auto member = std::find(members.begin(), members.end(), index) - members.begin();
  take_out(group, static_cast<std::size_t>(member));
}

/// Takes a member out of its group; the next one leads it if it was the first.
void World::Implementation::take_out(Group& group, std::size_t member) {
  Body& b = bodies[at(group.bodies()[member])];
  if (group.bodies().size() == 1) idle_groups.push_back(b.group);
  b.group = -1;
  group.remove(member);
}

}  // namespace carom
