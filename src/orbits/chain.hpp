// Closed chains of flights from wall to wall, and the equations that make an orbit of one.
//
// Unknown are the places of all hits at once, and with a field half the angle alpha that each
// flight turns by. From A to B, with the chord c = B - A of length l and direction e, a flight
// leaves in the direction of e turned left by alpha and arrives in that of e turned right by alpha
// (omega > 0; else the other way round). The equations, with the curvature k of flights and the
// tangent t of the wall:
//   closing:     sin(alpha) - k l / 2 = 0         for each flight, with field only
//   reflection:  t . (arrival - departure) = 0    for each hit
// Neither has a pole where a flight is a half-turn, and an unstable orbit is no harder than a
// stable one, since no error is carried from hit to hit. Without field the second is the derivative
// of the chain's length by the place of the hit. docs/physics/periodic-orbits.md
#pragma once

#include <cstddef>
#include <vector>

#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"
#include "orbits/boundary.hpp"

namespace carom::orbits {

struct Link {
  int wall = 0;
  double u = 0.0;
  double half_turn = 0.0;  ///< of the flight to the next link, in (0, pi) with field
  geometry::Cell step;     ///< cells that this flight crosses
};
using Chain = std::vector<Link>;

/// A flight of a chain and what it leaves and arrives with.
struct ChainFlight {
  double chord = 0.0;
  geometry::Vector direction;           ///< of the chord
  geometry::Vector departure, arrival;  ///< unit
  double sine = 0.0, cosine = 1.0;      ///< of the half-turn
};

/// A chain with all that its links' places say.
struct ChainGeometry {
  std::vector<WallPoint> points;
  std::vector<ChainFlight> flights;
  double shortest = 0.0;  ///< chord
};
ChainGeometry geometry_of(const Boundary&, const Chain&);

/// Number of equations: one a hit, two with field.
std::size_t equations(const Boundary&, const Chain&);

/// The equations' left sides, reflections first.
std::vector<double> residual(const Boundary&, const ChainGeometry&);
/// What rounding may have added to one of them (1).
double residual_error(const Boundary&, const ChainGeometry&);

/// What they miss where walls are pieces in place of a curve that was written (2).
double error_of_pieces(const Boundary&, const ChainGeometry&);

/// Their derivatives, row after row, by the arc lengths of all hits, then by the half-turns.
std::vector<double> derivatives(const Boundary&, const ChainGeometry&);

/// The chain after a step of Newton's. False: a hit has left its wall.
bool move(const Boundary&, Chain&, const std::vector<double>& step, double factor);

/// Length of the orbit, and the area that it runs round (counter-clockwise positive).
double length_of(const Boundary&, const Chain&, const ChainGeometry&);
double area_of(const Boundary&, const Chain&, const ChainGeometry&);

// (1) With u the unit roundoff, D the largest coordinate and l the shortest chord: a wall's point
// errs by 12 u D (one of D, ten of the semi-axes, which are at most D, and one of the lattice's
// translation), so both ends turn a chord by at most 24 u D / l; the difference, root and quotients
// add 4 u, sine and cosine 2 u, the rotation 3 u, the tangent 5 u, and the product with it 3 u. Two
// directions meet at a hit: 48 u D / l + 34 u. The closing equation has k l <= 2 and errs by less.
//
// (2) Pieces are off their curve by `distance`, their normals by `normal` (table.curve_errors):
// both ends turn a chord by 2 distance / l, two of them meet at a hit, and its tangent turns both.

}  // namespace carom::orbits
