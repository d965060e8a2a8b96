// Surfaces of section in phase space, and where a free flight crosses them.
#pragma once

#include <cstddef>
#include <vector>

#include "carom/geometry/vector.hpp"

namespace carom {

/// The zero set of a function g(position, velocity). A crossing is a change of its sign, where 0
/// counts as negative; its direction is +1 where g becomes positive. A state that starts on the
/// surface and leaves it to the positive side crosses at its start.
struct Surface {
  enum class Kind {
    line,        ///< through `from` and `to`: g > 0 on the left; lengths along it count from `from`
    segment,     ///< the part of it from `from` (which belongs to it) to `to` (which does not)
    circle,      ///< about `from` with `radius`: g > 0 outside; lengths count from angle 0
                 ///< counter-clockwise
    position_x,  ///< x = value: g = x - value; lengths are y
    position_y,  ///< y = value: g = y - value; lengths are x
    velocity_x,  ///< v_x = value: g = v_x - value
    velocity_y   ///< v_y = value
  } kind = Kind::line;
  geometry::Vector from, to;
  double radius = 0.0;
  double value = 0.0;
};

/// Is it a condition on the velocity?
bool of_velocity(const Surface&);
/// g, up to a positive factor.
double surface_function(const Surface&, geometry::Vector position, geometry::Vector velocity);

/// dg/dt, in the same unit.
double surface_rate(const Surface&, geometry::Vector position, geometry::Vector velocity,
                    geometry::Vector acceleration);

/// Is the point on the part of the line that a segment is? Always true for others.
bool on_surface_part(const Surface&, geometry::Vector position);

/// Where on the surface a state lies: length along it and the velocity along it. Both 0 for
/// conditions on the velocity.
struct SurfaceCoordinates {
  double s = 0.0, v_parallel = 0.0;
};
SurfaceCoordinates surface_coordinates(const Surface&, geometry::Vector position,
                                       geometry::Vector velocity);

/// A free flight from an event to the next: x'' = omega (v_y, -v_x).
struct FreeFlight {
  geometry::Vector position, velocity;
  double omega = 0.0;
  double duration = 0.0;
  geometry::Vector end;  ///< position at the end as the next flight will know it
};

/// A passage through the surface within one flight.
struct SurfaceCrossing {
  double time = 0.0;  ///< since the start of the flight
  int direction = 1;
  geometry::Vector position, velocity;
};

/// Every crossing of a flight in order of time, at most `most`. g is monotone between its extremes,
/// whose times are known in closed form, so that crossings are changes of sign between them and
/// none is missed or found twice; each is refined until its time is known to rounding. As both
/// flights that meet at an event take g from the same point there, none is lost or doubled at
/// events either. A sudden change of the velocity at a wall is no crossing. Whether a flight that
/// grazes the surface within rounding crosses it twice or not at all is decided in double
/// precision.
void crossings(const Surface&, const FreeFlight&, std::size_t most,
               std::vector<SurfaceCrossing>& found);

}  // namespace carom
