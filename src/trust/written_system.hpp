// What a run is compared with when its errors are estimated: the system as it was written, in twice
// the digits of a double.
#pragma once

#include <optional>

#include "carom/base/twofold.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"
#include "certify/wall/ball_table.hpp"

namespace carom::trust {

using TwofoldVector = geometry::BasicVector<Twofold>;

/// Numbers that doubles have rounded.
struct WrittenSystem {
  certify::TableOf<Twofold> table;  ///< walls in the order of the Table's
  Twofold omega, speed{1.0};
  /// Where the first particle starts, if not where its state says.
  std::optional<TwofoldVector> position, velocity;
};

/// A system that is its doubles.
WrittenSystem as_stored(const Table&, const Particle&);

}  // namespace carom::trust
