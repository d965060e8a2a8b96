// Walls that are thin or small beside the flights that come to them: docs/physics/exactness.md,
// Thin walls.
#pragma once

#include "carom/geometry/curve_frame.hpp"
#include "carom/table/table.hpp"

namespace carom::table {

/// The lengths that the rounding of flights is measured by.
struct FlightSizes {
  double longest = 0.0;   ///< l1 distance of two points of the table, within the lattice's cell
  double farthest = 0.0;  ///< largest coordinate

  /// Does the rounded discriminant of a flight to such a curve misplace the hit, by more than 2^-16
  /// of the curve's smaller semi-axis?
  bool is_thin(const geometry::CurveFrame& curve) const;
};
FlightSizes flight_sizes(const Table&);

/// Is a wall of the table thin?
bool has_thin_walls(const Table&);

}  // namespace carom::table
