// Periodic orbits of one free particle between walls, with or without a magnetic field.
// docs/physics/periodic-orbits.md derives what is computed.
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "carom/base/fields.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// One reflection of a periodic orbit and the flight after it.
struct OrbitHit {
  int wall = 0;
  double u = 0.0;             ///< parameter on the wall
  double s = 0.0;             ///< arc length along the wall
  double v_parallel = 0.0;    ///< in the direction of s
  geometry::Vector position;  ///< rounded, in the home cell
  geometry::Vector velocity;  ///< after the reflection
  double flight_time = 0.0;   ///< until the next hit
  geometry::Cell step;        ///< on a lattice: cells between this hit and the next
  int hole = -1;              ///< the hole (index into Table::holes) that the point lies in
};

template <>
struct Fields<OrbitHit> {
  using H = OrbitHit;
  static constexpr std::tuple list{
      field("wall", "1", "Index into the attribute `names` of the group", &H::wall),
      field("hole", "1", "Index of the hole in which it lies; -1: none", &H::hole),
      field("u", "1", "Parameter on the wall", &H::u),
      field("s", "length", "Length along the wall", &H::s),
      field("v_parallel", "length/time", "Velocity in the direction of s", &H::v_parallel),
      field_as<double>(
          "x", "length", "Position, in the home cell",
          [](auto& h) -> auto& { return h.position.x; }),
      field_as<double>(
          "y", "length", "Position, in the home cell",
          [](auto& h) -> auto& { return h.position.y; }),
      field_as<double>(
          "vx", "length/time", "Velocity after the hit",
          [](auto& h) -> auto& { return h.velocity.x; }),
      field_as<double>(
          "vy", "length/time", "Velocity after the hit",
          [](auto& h) -> auto& { return h.velocity.y; }),
      field("flight_time", "time", "Until the next hit", &H::flight_time),
      field_as<std::int64_t>(
          "step_first", "1", "Cells to the next hit, along the first vector",
          [](auto& h) -> auto& { return h.step.first; }),
      field_as<std::int64_t>(
          "step_second", "1", "Cells to the next hit, along the second vector",
          [](auto& h) -> auto& { return h.step.second; })};
};

/// By the eigenvalues of the tangent map of one period: on the unit circle, real and positive, real
/// and negative; both +1 or both -1 within the estimated error of the trace.
enum class Stability : unsigned char { elliptic, hyperbolic, inverse_hyperbolic, parabolic };
const char* name_of(Stability);

/// What a symmetry of the table leaves of an orbit that it maps onto itself: the orbit repeats
/// after 1/order of its period except for the symmetry.
struct SymmetryReduced {
  int order = 1;
  double period = 0.0;
  double trace = 0.0;       ///< of the tangent map of that part, turned back by the symmetry
  double multiplier = 0.0;  ///< the real eigenvalue of largest size; NaN if there is none
};

/// A closed orbit, run through once.
struct PeriodicOrbit {
  std::vector<OrbitHit> hits;
  double period = 0.0, length = 0.0;
  /// Closed integral of p dq = m (v length + omega area), with the signed area that the orbit runs
  /// round, counter-clockwise positive. NaN if it is closed only except for a lattice vector and a
  /// field acts: then it depends on the gauge.
  double action = 0.0;
  double trace = 0.0;                   ///< of the tangent map of one period, across the orbit
  std::complex<double> multipliers[2];  ///< its eigenvalues, the larger one first
  Stability stability = Stability::parabolic;
  /// Index sigma of the phase exp(-i pi sigma / 2) in Gutzwiller's trace formula, for waves that
  /// vanish at the walls; each of these has a part of 2 in it. None of a parabolic orbit.
  std::optional<int> maslov;
  /// Its neighbours are periodic, too (bouncing balls): one member of a family of one length. As
  /// far as doubles tell: the equations of the orbit lose rank.
  bool family = false;
  double position_error = 0.0, length_error = 0.0;  ///< bounds, to first order
  double trace_error = 0.0;                         ///< estimate
  geometry::Cell shift;  ///< on a lattice: cells between the start and the end of a period
  int copies = 1;  ///< different orbits that symmetry and reversal make of it, itself included
  SymmetryReduced reduced;
  std::vector<double> half_turns;  ///< half the angle that each flight turns by; 0 without field
};

template <>
struct Fields<PeriodicOrbit> {
  using O = PeriodicOrbit;
  static constexpr std::tuple list{
      field("period", "time", "Period", &O::period),
      field("length", "length", "Length", &O::length),
      field("action", "mass*length^2/time", "Closed integral of p dq", &O::action),
      field("trace", "1", "Trace of the tangent map", &O::trace),
      field("position_error", "length", "Bound of the error of the hits' positions",
            &O::position_error),
      field("length_error", "length", "Bound of the error of the length", &O::length_error),
      field("trace_error", "1", "Estimated error of the trace", &O::trace_error),
      field_as<double>(
          "reduced_period", "time", "Period of the part that symmetry repeats",
          [](auto& o) -> auto& { return o.reduced.period; }),
      field_as<double>(
          "reduced_trace", "1", "Trace of its tangent map, mapped back by the symmetry",
          [](auto& o) -> auto& { return o.reduced.trace; }),
      field_as<double>(
          "reduced_multiplier", "1", "Its real eigenvalue of largest size; NaN: none",
          [](auto& o) -> auto& { return o.reduced.multiplier; }),
      field_as<std::int32_t>(
          "reduced_order", "1", "Number of such parts",
          [](auto& o) -> auto& { return o.reduced.order; }),
      field("copies", "1", "Number of different orbits under symmetries and reversal", &O::copies),
      field("stability", "1", "Index into the attribute `stabilities` of the group", &O::stability),
      field("family", "1", "1: one member of a family", &O::family)};
};

/// The names of orbits, as 1213: a letter for each hit. The walls that they hit have the digits 1
/// to 9 and the letters a to z in the order of the table; where they are more, words are the names
/// of the walls with blanks between.
struct OrbitWords {
  std::vector<std::string> words;  ///< of each orbit
  std::vector<std::pair<std::string, std::string>>
      letters;  ///< with the wall of each; may be empty
};
OrbitWords words_of(const std::vector<PeriodicOrbit>&, const Table&);

}  // namespace carom
