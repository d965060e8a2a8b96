#include "events/section_watch.hpp"

#include "events/step/group.hpp"
#include "motion/free_motion.hpp"

namespace carom::events {

using geometry::Vector;

void SectionWatch::watch(const Surface* surface, std::size_t most) {
  surface_ = surface;
  most_ = most;
}

Vector SectionWatch::in_plane(Vector position, const geometry::Cell& cell) const {
  return table_.lattice ? position + table_.lattice->translation(cell) : position;
}

SectionWatch::Seen& SectionWatch::seen(int index) {
  if (static_cast<int>(seen_.size()) <= index)
    seen_.resize(static_cast<std::size_t>(bodies_.size()));
  return seen_[static_cast<std::size_t>(index)];
}

void SectionWatch::begin_run() {
  for (int i = 0; i < bodies_.size(); ++i) {
    const State s = bodies_.state(i);
    if (!seen(i).begun)
      seen(i) = {true, in_plane(s.position, s.cell), s.velocity, s.time, bodies_[i].particle.omega};
  }
}

/// Reports the crossings that were found since `start`.
void SectionWatch::tell(int index, Time start, Observer& observer) const {
  for (const SurfaceCrossing& c : found_) {
    State state;
    state.position = c.position;
    state.velocity = c.velocity;
    state.time = start + c.time;
    observer.crossing(index, state.time, state, c.direction);
  }
}

/// The free flight since the last report. `end`: where it ends, if that is known.
void SectionWatch::watch_flight(int index, Time until, const Vector* end, Observer& observer) {
  Seen& from = seen(index);
  const double duration = until - from.time;
  if (!(duration > 0.0)) return;
  FreeFlight flight{from.position, from.velocity, from.omega, duration, {}};
  const auto [position, velocity] =
      motion::moved(flight.position, flight.velocity, flight.omega, duration);
  flight.end = end ? *end : position;
  crossings(*surface_, flight, most_, found_);
  tell(index, from.time, observer);
  from = {true, flight.end, velocity, until, from.omega};
}

void SectionWatch::after_event(int index, Time when, Observer& observer) {
  const Body& b = bodies_[index];
  if (b.finished && b.fate != Fate::capped) {
    // Pinned and unbounded particles fly on.
    const bool ends_now = b.fate == Fate::escaped || b.fate == Fate::singular;
    if (ends_now) watch_flight(index, when, nullptr, observer);
    return;
  }
  const State s = bodies_.state(index);
  const Vector here = in_plane(s.position, s.cell);
  watch_flight(index, s.time, &here, observer);
  Seen& now = seen(index);
  if (now.time == s.time) now = {true, here, s.velocity, s.time, b.particle.omega};
}

void SectionWatch::watch_step(Group& group, Time until, Observer& observer) {
  // The end of a step is a multiple of its length; it may differ from start and duration by
  // rounding.
  const double to = until == group.next_time() ? group.next().duration : until - group.time();
  for (std::size_t k = 0; k < group.bodies().size(); ++k) {
    const int index = group.bodies()[k];
    const double from = seen(index).begun ? seen(index).time - group.time() : 0.0;
    const Vector origin = in_plane({}, group.state(k).cell);
    group.crossings(*surface_, k, from > 0.0 ? from : 0.0, to, origin, found_);
    tell(index, group.time(), observer);
    seen(index).time = until;
    seen(index).begun = true;
  }
}

void SectionWatch::watch_flights(Time until, Observer& observer) {
  for (int i = 0; i < bodies_.size(); ++i) {
    const Body& b = bodies_[i];
    const bool flies_on = !b.finished || b.fate == Fate::pinned || b.fate == Fate::unbounded;
    if (flies_on && b.group == nullptr) watch_flight(i, until, nullptr, observer);
  }
}

}  // namespace carom::events
