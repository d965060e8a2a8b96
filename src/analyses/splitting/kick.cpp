#include "analyses/splitting/kick.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/random.hpp"

namespace carom::analyses {

namespace {

using geometry::Vector;

// x brought back into [low, high] as by mirrors at both ends.
double folded(double x, double low, double high) {
  for (int i = 0; i < 64 && !(low <= x && x <= high); ++i)
    x = x < low ? 2.0 * low - x : 2.0 * high - x;
  return std::clamp(x, low, high);
}

Vector unit(Vector v) {
  v = (1.0 / std::sqrt(dot(v, v))) * v;
  return (1.5 - 0.5 * dot(v, v)) * v;  // one Newton step: |v| = 1 to rounding
}

}  // namespace

Kick::Kick(const Table& table) {
  for (const Wall& wall : table.walls) frames_.push_back(geometry::frame_of(wall.curve));
}

State Kick::operator()(const State& state, double speed, double delta, RandomStream& random) const {
  const Vector inward = geometry::normal_at(frames_[static_cast<std::size_t>(state.wall)], state.u);
  const Vector along = right(inward);
  const double sine =
      folded(dot(state.velocity, along) / speed + delta * random.symmetric(), -1.0, 1.0);
  if (!(std::fabs(sine) < 1.0)) return state;
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  State kicked = state;
  kicked.velocity = speed * unit(sine * along + cosine * inward);
  return kicked;
}

}  // namespace carom::analyses
