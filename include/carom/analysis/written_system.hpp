// What a run is compared with when its errors are estimated: the system as it was written, in twice the
// digits of a double.
#pragma once

#include <optional>
#include <vector>

#include "carom/base/twofold.hpp"
#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {

using TwofoldVector = geometry::BasicVector<Twofold>;

/// A wall without its ends. A conic is (along . e)^2 + (across . e)^2 = square with e = P - centre.
struct WrittenWall {
  bool straight = false, circular = false;
  double turn = 1.0;                    ///< conics: +1 counter-clockwise, -1 clockwise
  TwofoldVector from;                   ///< start
  TwofoldVector chord;                  ///< segment: from start to end
  TwofoldVector centre;
  TwofoldVector along{1.0, 0.0}, across{0.0, 1.0};
  Twofold square;

  /// The exact point with parameter u.
  TwofoldVector point(double u) const;
};

/// Numbers that doubles have rounded.
struct WrittenSystem {
  std::vector<WrittenWall> walls;       ///< in the order of the table's
  TwofoldVector first, second;          ///< of the lattice
  Twofold omega, speed{1.0};
  /// Where the first particle starts, if not where its state says.
  std::optional<TwofoldVector> position, velocity;
};

/// A system that is its doubles.
WrittenSystem as_stored(const Table&, const Particle&);

}  // namespace carom
