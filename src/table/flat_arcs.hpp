// Walls that are too flat, too thin or too small for hits in doubles: docs/physics/exactness.md,
// Flat arcs and Thin walls.
#pragma once

#include <string>

#include "carom/table/table.hpp"
#include "table/thin_walls.hpp"

namespace carom::table {

/// Why hits would lie beside a wall, and what is expected there; no fault if they do not.
struct Misplaced {
  std::string fault;
  const char* expected = "";
};
Misplaced misplaced(const Wall&, const FlightSizes&);

}  // namespace carom::table
