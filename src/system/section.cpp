#include "carom/system/section.hpp"

#include <algorithm>

namespace carom {

using geometry::Vector;

std::vector<geometry::CurveFrame> frames_of(const Table& table) {
  std::vector<geometry::CurveFrame> frames;
  for (const Wall& wall : table.walls) frames.push_back(geometry::frame_of(wall.curve));
  return frames;
}

Vector SectionRecorder::unwrapped(const State& state) const {
  return table_->lattice ? state.position + table_->lattice->translation(state.cell)
                         : state.position;
}

void SectionRecorder::begin(std::uint64_t orbit, std::span<const State> starts) {
  orbit_ = orbit;
  points_.clear();
  orbits_.assign(starts.size(), {});
  for (std::size_t p = 0; p < starts.size(); ++p)
    if (starts[p].wall >= 0) hit(static_cast<int>(p), starts[p]);
}

void SectionRecorder::hit(int particle, const State& state) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(particle)];
  if (!plan_->boundary || full(orbit) || (plan_->wall >= 0 && state.wall != plan_->wall)) return;
  const geometry::CurveFrame& frame = (*frames_)[static_cast<std::size_t>(state.wall)];
  const Vector position = unwrapped(state), velocity = state.velocity;
  points_.push_back({orbit_, orbit.count++, particle, state.wall, 0, state.time.value(),
                     geometry::arc_length_at(frame, state.u),
                     dot(geometry::tangent_at(frame, state.u), velocity), position.x, position.y,
                     velocity.x, velocity.y});
}

void SectionRecorder::crossing(int particle, const State& state, int direction) {
  Orbit& orbit = orbits_[static_cast<std::size_t>(particle)];
  if (plan_->boundary || full(orbit) || (plan_->direction != 0 && direction != plan_->direction))
    return;
  const Vector position = unwrapped(state);
  const auto [s, v_parallel] = surface_coordinates(plan_->surface, position, state.velocity);
  points_.push_back({orbit_, orbit.count++, particle, -1, direction, state.time.value(), s,
                     v_parallel, position.x, position.y, state.velocity.x, state.velocity.y});
}

void SectionRecorder::end(int particle, Fate fate) {
  // A particle that is pinned or has left all walls behind may still cross a surface.
  const bool flies_on = fate == Fate::pinned || fate == Fate::unbounded;
  if (plan_->boundary || !flies_on) orbits_[static_cast<std::size_t>(particle)].moving = false;
}

bool SectionRecorder::done() const {
  return std::all_of(orbits_.begin(), orbits_.end(),
                     [this](const Orbit& o) { return full(o) || !o.moving; });
}

}  // namespace carom
