#include "trust/written_system.hpp"

#include <variant>

#include "carom/base/error.hpp"

namespace carom::trust {

using certify::WallOf;
using geometry::Vector;

namespace {

TwofoldVector as_twofold(Vector v) { return {v.x, v.y}; }

// docs of geometry/curve.hpp: how the centre of an arc follows from its ends.
struct AsStored {
  WallOf<Twofold> operator()(const geometry::Segment& s) const {
    return certify::segment_wall(as_twofold(s.from), as_twofold(s.to));
  }
  WallOf<Twofold> operator()(const geometry::Circle& s) const {
    return certify::circle_wall(as_twofold(s.centre), Twofold(s.radius), s.counterclockwise);
  }
  WallOf<Twofold> operator()(const geometry::Ellipse& s) const {
    return certify::ellipse_wall(as_twofold(s.centre), as_twofold(s.axis), Twofold(s.ratio),
                                 s.counterclockwise);
  }
  WallOf<Twofold> operator()(const geometry::CircularArc& s) const {
    const TwofoldVector from = as_twofold(s.from), chord = as_twofold(s.to) - from;
    const TwofoldVector to_centre = Twofold(0.5) * chord + Twofold(s.offset) * left(chord);
    return certify::arc_wall(from, as_twofold(s.to), from + to_centre, dot(to_centre, to_centre),
                             s.counterclockwise);
  }
  WallOf<Twofold> operator()(const geometry::Bezier&) const {
    throw InternalError("the error of an orbit was requested beside a Bézier curve");
  }
  WallOf<Twofold> operator()(const geometry::EllipticArc& s) const {
    const TwofoldVector from = as_twofold(s.from), chord = as_twofold(s.to) - from,
                        p = as_twofold(s.axis), q = left(p);
    const Twofold k(s.ratio);
    const TwofoldVector turned = -dot(chord, q) * p + (k * k * dot(chord, p)) * q;
    const TwofoldVector to_centre = Twofold(0.5) * chord + Twofold(s.offset) * turned;
    const Twofold x = k * dot(p, to_centre), y = dot(q, to_centre);
    const TwofoldVector semi_axis = (sqrt(x * x + y * y) / (k * dot(p, p))) * p;
    return certify::elliptic_arc_wall(from, as_twofold(s.to), from + to_centre, semi_axis, k,
                                      s.counterclockwise);
  }
};

}  // namespace

WrittenSystem as_stored(const Table& table, const Particle& particle) {
  WrittenSystem written;
  for (const Wall& wall : table.walls)
    written.table.walls.push_back(std::visit(AsStored{}, wall.curve));
  if (table.lattice)
    written.table.lattice = {as_twofold(table.lattice->first), as_twofold(table.lattice->second)};
  written.omega = particle.omega;
  written.speed = particle.speed;
  return written;
}

}  // namespace carom::trust
