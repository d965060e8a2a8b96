#include "kick.hpp"

#include <algorithm>
#include <cmath>

#include "carom/base/random.hpp"
#include "carom/geometry/parameter.hpp"

namespace carom {

namespace {

using geometry::Vector;

// x brought back into [low, high] as by mirrors at both ends.
double folded(double x, double low, double high) {
  for (int i = 0; i < 64 && !(low <= x && x <= high); ++i) x = x < low ? 2.0 * low - x : 2.0 * high - x;
  return std::clamp(x, low, high);
}

Vector unit(Vector v) {
  v = (1.0 / std::sqrt(dot(v, v))) * v;
  return (1.5 - 0.5 * dot(v, v)) * v;  // one Newton step: |v| = 1 to rounding
}

}  // namespace

Kick::Kick(const Table& table) {
  for (const Wall& wall : table.walls) {
    Side side;
    side.frame = geometry::frame_of(wall.curve);
    side.length = geometry::length(side.frame);
    double from = 0.0;
    const auto close = [&](double to) {
      if (from < to)
        side.pieces.push_back({from, to, geometry::arc_length_at(side.frame, from),
                               to < side.frame.end ? geometry::arc_length_at(side.frame, to) : side.length});
    };
    for (const int hole : wall.holes) {
      close(table.holes[static_cast<std::size_t>(hole)].from);
      from = table.holes[static_cast<std::size_t>(hole)].to;
    }
    close(side.frame.end);
    sides_.push_back(std::move(side));
  }
}

State Kick::operator()(const State& state, double speed, double delta, RandomStream& random) const {
  const Side& side = sides_[static_cast<std::size_t>(state.wall)];
  const double along = delta * random.symmetric(), turn = delta * random.symmetric();
  const auto piece = std::find_if(side.pieces.begin(), side.pieces.end(),
                                  [&](const Piece& p) { return p.from <= state.u && state.u < p.to; });
  if (piece == side.pieces.end()) return state;
  const double s =
      folded(geometry::arc_length_at(side.frame, state.u) + along * side.length, piece->start, piece->end);
  const double u = geometry::parameter_at_length(side.frame, s);
  if (!(std::max(piece->from, geometry::first_parameter) <= u && u < piece->to && u <= side.frame.last))
    return state;
  const Vector old_tangent = right(geometry::normal_at(side.frame, state.u));
  const double sine = folded(dot(state.velocity, old_tangent) / speed + turn, -1.0, 1.0);
  if (!(std::fabs(sine) < 1.0)) return state;

  State kicked = state;
  kicked.u = u;
  kicked.position = geometry::point_at(side.frame, u);
  const Vector inward = geometry::normal_at(side.frame, u);
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  kicked.velocity = speed * unit(sine * right(inward) + cosine * inward);
  return kicked;
}

}  // namespace carom
