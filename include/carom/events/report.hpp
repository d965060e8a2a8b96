// What is reported of a particle that could not go on.
#pragma once

#include <string>
#include <string_view>

#include "carom/motion/state.hpp"

namespace carom {

/// The text for a particle that ended as lost, unresolved or singular: the reason and its state in
/// decimals, then a tab and the bits of that state. If `reason` is empty, the fate is all that is
/// said.
std::string report_of(const Particle&, const State&, Fate, std::string_view reason);

/// The part of a report for people.
std::string_view shown(std::string_view report);
/// The part that a state can be set up again from: wall, u, x, y, vx, vy, omega as hexadecimal
/// numbers, cell, and time.
std::string_view bits_in(std::string_view report);

}  // namespace carom
