// Crossings of the surface that a world watches, in free flight and in integrated motion.
#include "events/world_implementation.hpp"
#include "motion/free_motion.hpp"

namespace carom {

using geometry::Vector;

void World::watch(const Surface* surface, std::size_t most) {
  implementation_->surface = surface;
  implementation_->most_crossings = most;
}

Vector World::Implementation::in_plane(Vector position, const geometry::Cell& cell) const {
  return table.lattice ? position + table.lattice->translation(cell) : position;
}

void World::Implementation::begin_watching() {
  for (Body& b : bodies) {
    if (!b.watched.begun) b.watched = {true, in_plane(b.state.position, b.state.cell), b.state.velocity, b.state.time};
  }
}

/// The free flight since the last report.
void World::Implementation::watch_flight(int index, Time until, const Vector* end, Observer& observer) {
  Body& b = bodies[static_cast<std::size_t>(index)];
  const double duration = until - b.watched.time;
  if (!(duration > 0.0)) return;
  FreeFlight flight{b.watched.position, b.watched.velocity, b.particle.omega, duration, {}};
  const auto [position, velocity] = moved(flight.position, flight.velocity, flight.omega, duration);
  flight.end = end ? *end : position;
  crossings(*surface, flight, most_crossings, found);
  for (const SurfaceCrossing& c : found) {
    State state;
    state.position = c.position;
    state.velocity = c.velocity;
    state.time = b.watched.time + c.time;
    observer.crossing(index, state.time, state, c.direction);
  }
  b.watched = {true, flight.end, velocity, until};
}

void World::Implementation::watch_event(int index, Time when, Observer& observer) {
  Body& b = bodies[static_cast<std::size_t>(index)];
  if (b.finished && b.fate != Fate::capped) {
    // Pinned and unbounded particles fly on.
    const bool ends_now = b.fate == Fate::escaped || b.fate == Fate::singular;
    if (ends_now) watch_flight(index, when, nullptr, observer);
    return;
  }
  const Vector here = in_plane(b.state.position, b.state.cell);
  watch_flight(index, b.state.time, &here, observer);
  if (b.watched.time == b.state.time) b.watched = {true, here, b.state.velocity, b.state.time};
}

/// The step of a group until a time within it.
void World::Implementation::watch_group(Group& group, Time until, Observer& observer) {
  // The end of a step is a multiple of its length; it may differ from start and duration by rounding.
  const double to = until == group.next_time() ? group.next().duration : until - group.time();
  for (std::size_t k = 0; k < group.bodies().size(); ++k) {
    const int index = group.bodies()[k];
    Body& b = bodies[static_cast<std::size_t>(index)];
    const double from = b.watched.begun ? b.watched.time - group.time() : 0.0;
    const Vector origin = in_plane({}, group.cells()[k]);
    group.crossings(*surface, k, from > 0.0 ? from : 0.0, to, origin, found);
    for (const SurfaceCrossing& c : found) {
      State state;
      state.position = c.position;
      state.velocity = c.velocity;
      state.time = group.time() + c.time;
      observer.crossing(index, state.time, state, c.direction);
    }
    b.watched.time = until;
    b.watched.begun = true;
  }
}

void World::Implementation::watch_until(Time t_end, Observer& observer) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& b = bodies[i];
    const bool flies_on = !b.finished || b.fate == Fate::pinned || b.fate == Fate::unbounded;
    if (flies_on && b.group < 0) watch_flight(static_cast<int>(i), t_end, nullptr, observer);
  }
  for (const auto& group : groups) {
    if (!group->bodies().empty() && group->time() < t_end) watch_group(*group, t_end, observer);
  }
}

}  // namespace carom
