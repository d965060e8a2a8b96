// Everything that acts on particles besides walls and the magnetic field.
#pragma once

#include <vector>

#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"

namespace carom {

/// A disc outside which a potential is below its stated bound.
struct Support {
  geometry::Vector center;
  double radius = 0.0;
};

}  // namespace carom
