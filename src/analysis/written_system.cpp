#include "carom/analysis/written_system.hpp"

#include <variant>

#include "motion/point_on_conic.hpp"

namespace carom {

using geometry::Vector;

namespace {

TwofoldVector exactly(Vector v) { return {v.x, v.y}; }

struct AsStored {
  WrittenWall wall;

  void operator()(const geometry::Segment& s) {
    wall.straight = true;
    wall.from = exactly(s.from);
    wall.chord = exactly(s.to) - wall.from;
  }
  void operator()(const geometry::CircularArc& s) {
    arc(s.from, s.to, s.counterclockwise, s.offset, {1.0, 0.0}, 1.0);
    wall.circular = true;
  }
  void operator()(const geometry::EllipticArc& s) {
    arc(s.from, s.to, s.counterclockwise, s.offset, exactly(s.axis), s.ratio);
  }
  void operator()(const geometry::Circle& s) {
    full(s.centre, {s.radius, 0.0}, s.counterclockwise, {1.0, 0.0}, 1.0);
    wall.circular = true;
  }
  void operator()(const geometry::Ellipse& s) {
    full(s.centre, s.axis, s.counterclockwise, exactly(s.axis), s.ratio);
  }

 private:
  void axes(const TwofoldVector& p, const Twofold& k, bool counterclockwise) {
    wall.turn = counterclockwise ? 1.0 : -1.0;
    wall.along = k * p;
    wall.across = left(p);
    const TwofoldVector e = wall.from - wall.centre;
    const Twofold x = dot(wall.along, e), y = dot(wall.across, e);
    wall.square = x * x + y * y;
  }
  void arc(Vector from, Vector to, bool counterclockwise, double offset, const TwofoldVector& p, const Twofold& k) {
    wall.from = exactly(from);
    const TwofoldVector e = exactly(to) - wall.from, q = left(p);
    const Twofold half(0.5), back = -dot(e, q), on = k * k * dot(e, p);
    const TwofoldVector turned = back * p + on * q;
    wall.centre = (wall.from + half * e) + Twofold(offset) * turned;
    axes(p, k, counterclockwise);
  }
  void full(Vector centre, Vector axis, bool counterclockwise, const TwofoldVector& p, const Twofold& k) {
    wall.centre = exactly(centre);
    wall.from = wall.centre + exactly(axis);
    axes(p, k, counterclockwise);
  }
};

}  // namespace

TwofoldVector WrittenWall::point(double u) const {
  if (straight) return from + Twofold(u) * chord;
  const TwofoldVector a = from - centre, b = quarter_turn(a, along, across);
  return point_on_conic(centre, a, turn < 0 ? -b : b, u);
}

WrittenSystem as_stored(const Table& table, const Particle& particle) {
  WrittenSystem written;
  for (const Wall& wall : table.walls) {
    AsStored stored;
    std::visit(stored, wall.curve);
    written.walls.push_back(stored.wall);
  }
  if (table.lattice) {
    written.first = exactly(table.lattice->first);
    written.second = exactly(table.lattice->second);
  }
  written.omega = particle.omega;
  written.speed = particle.speed;
  return written;
}

}  // namespace carom
