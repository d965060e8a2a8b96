// What an attempt could not tell, in words and with its enclosures.
#include <cmath>

#include "certify/attempt.hpp"

namespace carom::certify {
namespace {

// The middle to twenty decimals, and how far off the number may be.
std::string enclosure(const Ball& x) {
  const double error = x.radius().log2();
  const std::string middle = x.midpoint().decimals(20);
  return error < -1e17
             ? middle
             : middle + " (error below 2^" + std::to_string(static_cast<long>(std::ceil(error))) + ")";
}

}  // namespace

std::string Attempt::name(const Copy& copy) const {
  if (copy.wall < 0) return "nothing";
  std::string text = "'" + system_.table->walls[static_cast<std::size_t>(copy.wall)].name + "'";
  if (arena_.scene.lattice)
    text += " of cell " + std::to_string(now_.cell.first + copy.cell.first) + ", " +
            std::to_string(now_.cell.second + copy.cell.second);
  return text;
}

std::string Attempt::description(const Doubt& doubt) {
  if (doubt.kind == Doubt::choice) return described(doubt);
  const Precision precision(bits_);
  Now before = now_.copy();  // what is in doubt is seen at the wall
  move_to(doubt.first);
  std::string text = described(doubt);
  now_ = std::move(before);
  return text;
}

std::string Attempt::described(const Doubt& doubt) const {
  const Precision precision(bits_);
  const BallState s = now_.state->state(bits_);
  const BallVector &P = s.position, &v = s.velocity;
  const std::string event = "event " + std::to_string(now_.hits + 1) + ": ";
  const auto wall = [this](const Copy& copy) -> const WallOf<Ball>& {
    return arena_.wall(copy.wall);
  };
  if (doubt.kind == Doubt::last_time)
    return event + "whether " + name({doubt.first.wall, {}}) + " is met before the last time, " +
           enclosure(now_.state->time()) + " or " + enclosure(*t_max_);
  if (doubt.kind == Doubt::hole) {
    std::string text = event + "on which side of an end of '" +
                       system_.table->holes[static_cast<std::size_t>(doubt.hole_index)].name + "' " +
                       name({doubt.first.wall, {}}) + " is met, at x = " + enclosure(P.x) +
                       ", y = " + enclosure(P.y);
    for (const HoleOf<Ball>& hole : arena_.scene.holes)
      if (hole.hole == doubt.hole_index && wall(doubt.first).form == Form::segment) {
        const Ball length = sqrt(dot(wall(doubt.first).chord, wall(doubt.first).chord));
        text += ": arc length " +
                enclosure(dot(P - wall(doubt.first).from, wall(doubt.first).chord) / length) + ", ends " +
                enclosure(hole.low / length) + " and " + enclosure(hole.high / length);
      }
    return text;
  }
  if (doubt.first.wall < 0) return event + "which walls are near, for the position and velocity are not known well enough";
  const auto time_to = [&](const Copy& copy) {
    const bool standing = copy.wall == now_.standing && copy.cell == geometry::Cell{};
    if (!arena_.scene.motion.turns)
      return enclosure(meets(wall(copy), seen(copy, P), v, arena_.scene.motion, standing).time);
    return enclosure(flight_to<Ball, Ball>(wall(copy), seen(copy, P), v, arena_.scene.motion, standing).time);
  };
  if (doubt.second.wall >= 0)
    return event + "which comes first, " + name(doubt.first) + " or " + name(doubt.second) +
           ", after the times " + time_to(doubt.first) + " and " + time_to(doubt.second);
  std::string text = event + "whether the flight meets " + name(doubt.first);
  if (arena_.scene.motion.turns) return text;
  const WallOf<Ball>& w = wall(doubt.first);
  const BallVector at = seen(doubt.first, P);
  const Ball per_speed = Ball(1) / sqrt(arena_.scene.motion.speed2);
  if (w.form != Form::ellipse && !w.closed)
    text += ", passing its ends at the distances " + enclosure(cross(v, w.from - at) * per_speed) + " and " +
            enclosure(cross(v, w.to - at) * per_speed);
  if (w.form == Form::circle)
    text += ", its centre at the distance " + enclosure(cross(v, w.centre - at) * per_speed) +
            " with the radius " + enclosure(sqrt(w.radius2));
  return text;
}

}  // namespace carom::certify
