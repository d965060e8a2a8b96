// A flight under way, and what lies first ahead of it.
#pragma once

#include "base/angle.hpp"
#include "carom/geometry/filter.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom::events {

/// A flight under way, in the frame of the cell where it started.
struct Flight {
  int wall = -1;  ///< start: wall and u, or a free point
  double u = 0.0;
  geometry::Vector start;  ///< rounded image (exact for a free point)
  double start_error = 0.0;
  geometry::Vector velocity;
  double omega = 0.0;
  /// The squared speed of the energy shell, to which |v|^2 is equal within 64u: a constant, for
  /// rounding |v|^2 anew about a power of two would bias every flight the same way.
  double square_speed = 1.0;
  geometry::Cell cell;  ///< the cell it is in, relative to the one of its start
  int entry = -1;       ///< edge (piece) through which it came into `cell`
  // Set by PieceTable::begin and cross: the piece that the particle is on, as seen from `cell` (-1:
  // none), and, at a joint, the piece that ends there.
  int start_piece = -1;
  int start_previous = -1;
};

/// What lies first ahead.
struct Ahead {
  enum class Kind : unsigned char { none, wall, edge, joint, cusp } kind = Kind::none;
  int piece = -1;
  int root = 0;
  double kappa = 0.0;
  double duration = 0.0;  ///< time from the start of the flight
  double u = 0.0;         ///< on a Bézier curve: where
};

/// Duration of a flight to kappa.
[[gnu::always_inline]] inline double duration_at(double kappa, double omega) {
  if (omega == 0.0) return 1.0 / kappa;
  const double h = 0.5 * std::fabs(omega);
  return base::angle(kappa, h) * (1.0 / h);  // the quotient is ready before the angle is
}

/// The start of a flight as walls of one cell see it, with what bounds its errors.
struct Origin {
  geometry::Vector point;
  geometry::FlightScale scale;
};

/// A crossing with a curve that may be the first.
struct Crossing {
  geometry::Quadratic<double> quadratic;
  geometry::Root root;
  double error = -1.0;  ///< of its kappa; negative: not computed yet
  // Without field, kappa is unit / time, divided only where it is needed.
  double time = 0.0, unit = 1.0;
  double u = 0.0;  ///< of a Bézier curve
};

}  // namespace carom::events
