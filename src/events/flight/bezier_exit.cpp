// Flights against Bézier curves.
#include "carom/geometry/bezier_flight.hpp"

#include "base/index.hpp"
#include "events/flight/crossing.hpp"
#include "events/flight/piece_table.hpp"

namespace carom::events {

using namespace geometry;

Sign PieceTable::bezier_exit(const Flight& f, int piece, const Origin& seen, double inflation,
                             Crossing& c) const {
  const PreparedCurve& w = *data[base::at(piece)].shape;
  const bool starts = piece == f.start_piece, ends = piece == f.start_previous;
  if (starts && ends) return Sign::undecided;  // at the joint of a curve with itself
  FlightScale scale = seen.scale;
  scale.inflation = inflation;
  const BezierForm& curve = *w.parametrisation.bezier;
  const double on = starts ? f.u : ends ? 1.0 : -1.0;
  const CurveExit exit =
      f.omega == 0.0 ? geometry::first_exit(curve, seen.point, f.velocity, scale, on)
                     : geometry::first_exit(curve, seen.point, f.velocity, f.omega, scale, on);
  if (exit.leaves != Sign::positive) return exit.leaves;
  // Bounds are allowed to change where a root is looked for, not the number that is found.
  if (inflation != 1.0) return bezier_exit(f, piece, seen, 1.0, c);
  c.u = exit.u;
  if (f.omega != 0.0) {
    c.root.kappa = exit.place;
    c.error = exit.error;
    return Sign::positive;
  }
  // kappa = |v|^2 / place; |v|^2 and the quotient are rounded.
  c.time = exit.place;
  c.unit = dot(f.velocity, f.velocity);
  c.root.kappa = c.unit / c.time;
  c.error = c.root.kappa * (exit.error / (exit.place - exit.error) + 5.1 * unit_roundoff);
  return Sign::positive;
}

}  // namespace carom::events
