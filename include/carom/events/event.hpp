// What happens at a time.
#pragma once

#include <cstdint>

#include "carom/base/time.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/motion/state.hpp"

namespace carom {

/// Kinds of event, in the order in which simultaneous ones are applied.
enum class EventKind : unsigned char {
  hit,
  escape,
  cell_edge,
  contact,
  neighbours,
  pinned,
  unbounded,
  singular,
  lost,
  group,
  stop
};

/// A reflection, as analyses see it. `before` and `after` are the velocities around it.
struct HitEvent {
  int particle = 0;
  int wall = 0;
  double u = 0.0;  ///< parameter on the wall
  Time time;
  double flight_time = 0.0;   ///< since the event before
  geometry::Vector position;  ///< rounded, in the cell `cell`
  geometry::Cell cell;
  geometry::Vector before, after;
  int reflections = 1;  ///< n at a corner of angle pi/n, else 1
};

/// Two hard discs touch. Positions are rounded, each in its cell.
struct ContactEvent {
  int first = 0, second = 0;  ///< first < second
  Time time;
  geometry::Vector first_position, second_position;
  geometry::Cell first_cell, second_cell;
  geometry::Vector
      separation;  ///< from the second's centre to the first's, of the copies that touch
  geometry::Vector first_before, first_after;
  geometry::Vector second_before, second_after;
  double transfer = 0.0;  ///< momentum exchanged along the line of centres, >= 0
};

/// The end of one particle's trajectory.
struct EndEvent {
  int particle = 0;
  Fate fate = Fate::survived;
  Time time;      ///< t_max for survivors; the last hit for `unbounded`
  State state;    ///< after the last event
  int hole = -1;  ///< for `escaped`
  std::uint64_t hits = 0;
};

}  // namespace carom
