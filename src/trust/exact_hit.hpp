// The true orbit beside the computed one: flights and reflections in twice the digits.
#pragma once

#include <optional>

#include "carom/events/event.hpp"
#include "carom/motion/state.hpp"
#include "carom/trust/trust.hpp"
#include "trust/written_system.hpp"

namespace carom {

/// For |x| up to 4, to 2^-70. Beside Twofold, for there the formulas of certify/ look for it.
void sin_cos(Twofold& sin, Twofold& cos, const Twofold& x);

}  // namespace carom

namespace carom::trust {

/// The error after a hit from the one before it: the true orbit flies to the same wall and is
/// reflected there. Nothing if it does not meet that wall near the engine's hit.
std::optional<OrbitError> error_after(const WrittenSystem&, const State& before,
                                      const OrbitError& error, const HitEvent& hit);

/// By how much a start as it was written differs from its state in doubles: on the speed, and on
/// its wall.
OrbitError error_of_start(const WrittenSystem&, const State& start, bool first_particle);

}  // namespace carom::trust
