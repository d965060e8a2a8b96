// Until when schemes are compared, with which steps, and with what.
#pragma once

#include "analyses/compare/orbit.hpp"

namespace carom::analyses {

struct Setting {
  double t = 0.0;
  ErrorUnits units;
  double growth = 1.0;        ///< of a small distance from the start until t
  double rounded = 1.0;       ///< the same of roundings that are made all along, root mean square
  double longest_step = 0.0;  ///< t over a power of two; resolves the forces
  double longest_resolved = 0.0;  ///< of 2^k times the first step that does; 0: no forces
  Orbit reference;
  double reference_step = 0.0;  ///< 0: exact flights
  double reference_error = 0.0;
  bool in_34_digits = false;           ///< the reference
  double rounding_error = 0.0;         ///< of the reference scheme in doubles
  double reference_evaluations = 0.0;  ///< its own; 0: exact flights

  /// What rounding may have made of an orbit's error with this many evaluations of forces.
  double rounding(double evaluations) const;
  /// Errors below this are those of rounding and of the reference, whose error is that of its
  /// rounding; roundings add up like the square root of their number.
  double noise(double evaluations) const;
};

/// Scheme of the reference where forces act.
inline constexpr const char* reference_scheme = "mclachlan-ss17";

/// Evaluations of single or pair forces that one run may cost.
inline constexpr double most_evaluations = 4e6;

/// `wanted`: the time of the comparison, 0: chosen. Throws InputError where the start ends at once,
/// and where no step resolves the forces.
Setting setting_of(const Runs&, double wanted);

}  // namespace carom::analyses
