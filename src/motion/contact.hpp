// When two discs in free flight touch, and what their contact does to their velocities.
#pragma once

#include <cstdint>
#include <limits>

#include "carom/geometry/vector.hpp"

namespace carom::motion {

inline constexpr double no_contact = std::numeric_limits<double>::infinity();

/// A pair of free flights from the same instant on: d = x_1 - x_2 then, and both velocities.
struct PairFlight {
  geometry::Vector separation;
  geometry::Vector first, second;  ///< velocities
  double first_omega = 0.0, second_omega = 0.0;
};

/// The time until the distance falls to `reach`, the sum of the radii; no_contact if it never does,
/// or not before `until`. A pair that touches or, by rounding, overlaps has its contact now if it
/// approaches; if it moves apart, that it touches is no contact. Equal omega: closed form, until is
/// not asked. Unequal: isolated by enclosures of the distance, on intervals that do not depend on
/// `until`.
double time_to_contact(const PairFlight& pair, double reach, double until);

/// The closed form for both at the same omega; v = v_1 - v_2. A turn has one such time at most.
double time_to_contact(geometry::Vector separation, geometry::Vector v, double omega, double reach);
/// Isolation by enclosure, for any omega: also the witness of the closed form.
double enclosed_time_to_contact(const PairFlight& pair, double reach, double until);
/// The same contacts for unequal omega, without the strides that bounds exclude: see
/// docs/physics/hard-discs.md. `strides`: counts those that were looked at.
double guided_time_to_contact(const PairFlight& pair, double reach, double until,
                              std::int64_t* strides = nullptr);

/// Velocities after an elastic contact along the line of centres, and the size of the momentum that
/// was exchanged. Equal masses in a line exchange their velocities exactly. Afterwards separation .
/// (v_1 - v_2) is positive as it is computed, so that one contact is never followed by the same
/// again.
struct ElasticContact {
  geometry::Vector first, second;
  double transfer = 0.0;
};
ElasticContact elastic_contact(geometry::Vector separation, geometry::Vector first,
                               geometry::Vector second, double first_mass, double second_mass);

}  // namespace carom::motion
