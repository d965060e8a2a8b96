#include "trust/error_edges.hpp"

#include <cmath>

namespace carom::trust {

using events::Ahead;
using events::PieceTable;
using geometry::Vector;

namespace {

// v turned by a small angle; its length stays on the energy shell.
Vector turned(Vector v, double angle) {
  const double scale = 1.0 / std::sqrt(1.0 + angle * angle);
  return {scale * (v.x - angle * v.y), scale * (v.y + angle * v.x)};
}

}  // namespace

bool ErrorEdges::begin(const Particle& particle, const State& start, const Deviation& d,
                       events::Flight& flight) {
  flight.omega = particle.omega;
  flight.square_speed = particle.speed * particle.speed;
  const Vector v = start.velocity;
  if (start.wall < 0) {
    flight.start = start.position + d.position;
    flight.velocity = turned(v, dot(left(v), d.velocity) / dot(v, v));
    finder_.pieces().begin(flight);
    return true;
  }
  // The displaced orbit left the wall a little earlier or later.
  const geometry::PreparedCurve& wall = finder_.pieces().curve(start.wall);
  const Vector normal = wall.frame(start.u).normal;
  const Vector unit = (1.0 / std::sqrt(dot(normal, normal))) * normal;
  const AtWall at = at_wall(unit, v, particle.omega);
  const double u = wall.parameter(start.position + dot(at.arc, d) * right(unit));
  if (!wall.closed && !(u > geometry::first_parameter && u < wall.last())) return false;
  const auto [point, normal_there, square, k] = wall.frame(u);
  const Vector velocity = turned(v, dot(at.angle, d));
  if (finder_.pieces().inward(start.wall, u, velocity, normal_there, counts_) != Sign::positive)
    return false;
  finder_.pieces().begin_on_wall(flight, start.wall, u, point, velocity);
  return true;
}

bool ErrorEdges::land(const Particle& particle, const State& start, const Deviation& d,
                      double latest, PieceTable::Landing& landing) {
  events::Flight flight;
  if (!begin(particle, start, d, flight)) return false;
  Ahead ahead;
  // In a corridor of a lattice it might fly for ever.
  for (finder_.next(flight, ahead, counts_);
       ahead.kind == Ahead::Kind::edge && ahead.duration <= latest;
       finder_.next(flight, ahead, counts_))
    finder_.pieces().cross(flight, ahead);
  if (ahead.kind != Ahead::Kind::wall || !(ahead.duration <= latest)) return false;
  finder_.pieces().land(flight, ahead, landing, counts_);
  return true;
}

bool ErrorEdges::same_arrival(const Particle& particle, const State& start, const Deviation& d,
                              const Arrival& arrival, double farthest, double latest) {
  PieceTable::Landing landing;
  if (!land(particle, start, d, latest, landing)) return false;
  const geometry::Cell cell{start.cell.first + landing.cell.first,
                            start.cell.second + landing.cell.second};
  const Vector away = landing.at.point - arrival.position;
  return landing.wall == arrival.wall && cell == arrival.cell && landing.hole < 0 &&
         dot(away, away) <= farthest * farthest;
}

bool ErrorEdges::surely_same_arrival(const Particle& particle, const HitEvent& hit,
                                     double error) const {
  constexpr double far = 1024;   // errors from a joint, so that a neighbour is not beyond it
  constexpr double steep = 512;  // at most this many times as long is the way along the wall
  const PieceTable& pieces = finder_.pieces();
  if (particle.omega != 0.0 || !pieces.convex || !table_.holes.empty()) return false;
  const Vector turn = hit.after - hit.before;
  if (!(steep * steep * dot(turn, turn) > 4.0 * dot(hit.after, hit.after))) return false;
  const geometry::PreparedCurve& wall = pieces.curve(hit.wall);
  const auto is_far = [&](Vector joint) {
    const Vector way = hit.position - joint;
    return dot(way, way) > far * far * error * error;
  };
  return wall.closed || (is_far(wall.from) && is_far(wall.to));
}

bool ErrorEdges::same_hole(const Particle& particle, const State& start, const Deviation& d,
                           int hole, double latest) {
  PieceTable::Landing landing;
  if (!land(particle, start, d, latest, landing) || landing.hole < 0) return false;
  const std::vector<Hole>& holes = finder_.pieces().table.holes;  // parts of one have its name
  return holes[static_cast<std::size_t>(landing.hole)].name ==
         holes[static_cast<std::size_t>(hole)].name;
}

}  // namespace carom::trust
