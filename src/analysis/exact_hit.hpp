// What one hit of the engine errs: its flight and reflection again, in twice the digits.
#pragma once

#include "carom/analysis/written_system.hpp"
#include "carom/events/event.hpp"
#include "carom/motion/state.hpp"
#include "carom/motion/tangent.hpp"

namespace carom {

struct SinCosTwofold {
  Twofold sin, cos;
};
/// For |x| up to 4, to 2^-70.
SinCosTwofold sincos(const Twofold& x);

/// By how much the exact flight and reflection from the state `before` (its rounded position) differ from the
/// state after the hit, at the same time.
Deviation error_of_hit(const WrittenSystem&, const State& before, const HitEvent& hit);

/// By how much a start as it was written differs from its state in doubles: on the speed, and on its wall.
Deviation error_of_start(const WrittenSystem&, const State& start, bool first_particle);

}  // namespace carom
