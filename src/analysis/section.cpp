#include "carom/analysis/section.hpp"

#include <algorithm>
#include <limits>

#include "motion/free_motion.hpp"

namespace carom {

using geometry::Vector;

SectionRecorder::SectionRecorder(const Table& table, const SectionPlan& plan) : table_(table), plan_(plan) {
  for (const Wall& wall : table.walls) frames_.push_back(geometry::frame_of(wall.curve));
}

Vector SectionRecorder::unwrapped(Vector position, const geometry::Cell& cell) const {
  return table_.lattice ? position + table_.lattice->translation(cell) : position;
}

void SectionRecorder::begin(std::uint64_t orbit, const World& world) {
  orbit_ = orbit;
  points_.clear();
  orbits_.clear();
  for (int p = 0; p < world.size(); ++p) {
    const State& state = world.state(p);
    const Vector position = unwrapped(state.position, state.cell);
    orbits_.push_back({world.particle(p), position, state.velocity, state.time});
    if (plan_.boundary && state.wall >= 0) add_hit(p, state.wall, state.u, state.time, position, state.velocity);
  }
}

void SectionRecorder::hit(const HitEvent& event) {
  const Vector position = unwrapped(event.position, event.cell);
  if (plan_.boundary) {
    add_hit(event.particle, event.wall, event.u, event.time, position, event.after);
    return;
  }
  fly(event.particle, event.time - orbits_[static_cast<std::size_t>(event.particle)].time, &position);
  Orbit& orbit = orbits_[static_cast<std::size_t>(event.particle)];
  orbit.position = position;
  orbit.velocity = event.after;
  orbit.time = event.time;
}

void SectionRecorder::end(const EndEvent& event) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(event.particle)];
  switch (event.fate) {
    case Fate::survived:
    case Fate::pinned:
    case Fate::unbounded: return;  // it flies on
    case Fate::escaped:
    case Fate::singular:
      if (!plan_.boundary) fly(event.particle, event.time - orbit.time, nullptr);
      break;
    case Fate::capped:
    case Fate::lost: break;
  }
  orbit.moving = false;
}

void SectionRecorder::close(Time time) {
  for (std::size_t p = 0; p < orbits_.size(); ++p) {
    if (!plan_.boundary && orbits_[p].moving) fly(static_cast<int>(p), time - orbits_[p].time, nullptr);
    orbits_[p].moving = false;
  }
}

bool SectionRecorder::done() const {
  return std::all_of(orbits_.begin(), orbits_.end(), [this](const Orbit& o) { return full(o) || !o.moving; });
}

void SectionRecorder::crossing(int particle, Time time, const State& state, int direction) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(particle)];
  add(particle, orbit, time.value(), direction, unwrapped(state.position, state.cell), state.velocity);
}

void SectionRecorder::add_hit(int particle, int wall, double u, Time time, Vector position, Vector velocity) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(particle)];
  if (full(orbit) || (plan_.wall >= 0 && wall != plan_.wall)) return;
  const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(wall)];
  points_.push_back({orbit_, orbit.count++, particle, wall, 0, time.value(), geometry::arc_length_at(frame, u),
                     dot(geometry::tangent_at(frame, u), velocity), position.x, position.y, velocity.x,
                     velocity.y});
}

void SectionRecorder::add(int particle, Orbit& orbit, double time, int direction, Vector position,
                          Vector velocity) {
  if (full(orbit) || (plan_.direction != 0 && direction != plan_.direction)) return;
  const auto [s, v_parallel] = surface_coordinates(plan_.surface, position, velocity);
  points_.push_back({orbit_, orbit.count++, particle, -1, direction, time, s, v_parallel, position.x, position.y,
                     velocity.x, velocity.y});
}

// The flight from the last event of a particle; `end`: where it is known to end.
void SectionRecorder::fly(int particle, double duration, const Vector* end) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(particle)];
  if (full(orbit) || !(duration >= 0.0)) return;
  FreeFlight flight{orbit.position, orbit.velocity, orbit.particle.omega, duration, {}};
  flight.end = end ? *end : moved(flight.position, flight.velocity, flight.omega, duration).first;
  // One direction takes at least every other crossing.
  const std::size_t most = plan_.points == 0 ? std::numeric_limits<std::size_t>::max()
                                             : 2 * static_cast<std::size_t>(plan_.points - orbit.count) + 2;
  crossings(plan_.surface, flight, most, found_);
  for (const SurfaceCrossing& c : found_)
    add(particle, orbit, (orbit.time + c.time).value(), c.direction, c.position, c.velocity);
}

}  // namespace carom
