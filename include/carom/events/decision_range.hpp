// The scales at which flights are decided in doubles.
#pragma once

#include <span>
#include <string>

#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// Why the bounds on rounding do not hold for one of these particles in that table, as they know no underflow and no
/// overflow: "" if they do. docs/physics/exactness.md, The range, derives the limits.
std::string beyond_decisions(const Table&, std::span<const Particle>);

}  // namespace carom
