#include "carom/analysis/section.hpp"
#include "carom/events/world.hpp"

#include <algorithm>

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
  orbits_.assign(static_cast<std::size_t>(world.size()), {});
  for (int p = 0; plan_.boundary && p < world.size(); ++p) {
    const State& state = world.state(p);
    if (state.wall >= 0)
      add_hit(p, state.wall, state.u, state.time, unwrapped(state.position, state.cell), state.velocity);
  }
}

void SectionRecorder::hit(const HitEvent& event) {
  if (plan_.boundary)
    add_hit(event.particle, event.wall, event.u, event.time, unwrapped(event.position, event.cell), event.after);
}

void SectionRecorder::end(const EndEvent& event) {
  // What is pinned or has left all walls behind may still cross a surface.
  const bool flies_on = event.fate == Fate::pinned || event.fate == Fate::unbounded;
  if (plan_.boundary || !flies_on) orbits_[static_cast<std::size_t>(event.particle)].moving = false;
}

bool SectionRecorder::done() const {
  return std::all_of(orbits_.begin(), orbits_.end(), [this](const Orbit& o) { return full(o) || !o.moving; });
}

void SectionRecorder::crossing(int particle, Time time, const State& state, int direction) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(particle)];
  if (plan_.boundary || full(orbit) || (plan_.direction != 0 && direction != plan_.direction)) return;
  const Vector position = unwrapped(state.position, state.cell);
  const auto [s, v_parallel] = surface_coordinates(plan_.surface, position, state.velocity);
  points_.push_back({orbit_, orbit.count++, particle, -1, direction, time.value(), s, v_parallel, position.x,
                     position.y, state.velocity.x, state.velocity.y});
}

void SectionRecorder::add_hit(int particle, int wall, double u, Time time, Vector position, Vector velocity) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(particle)];
  if (full(orbit) || (plan_.wall >= 0 && wall != plan_.wall)) return;
  const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(wall)];
  points_.push_back({orbit_, orbit.count++, particle, wall, 0, time.value(), geometry::arc_length_at(frame, u),
                     dot(geometry::tangent_at(frame, u), velocity), position.x, position.y, velocity.x,
                     velocity.y});
}

}  // namespace carom
