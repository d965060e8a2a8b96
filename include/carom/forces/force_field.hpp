// Everything that acts on particles besides walls and the magnetic field.
#pragma once

#include <limits>
#include <vector>

#include "carom/geometry/vector.hpp"
#include "carom/motion/state.hpp"

namespace carom {

/// A disc outside which a potential is below its stated bound.
struct Support {
  geometry::Vector center;
  double radius = 0.0;
};

class ForceField {
 public:
  bool empty() const { return true; }
  bool external() const { return false; }
  bool interacts() const { return false; }
  double add_external(const Particle&, geometry::Vector, geometry::Vector&) const { return 0.0; }
  double add_pair(const Particle&, const Particle&, geometry::Vector, geometry::Vector&) const { return 0.0; }
  bool everywhere() const { return true; }
  const std::vector<Support>& supports() const { return supports_; }
  double pair_range() const { return std::numeric_limits<double>::infinity(); }

 private:
  std::vector<Support> supports_;
};

}  // namespace carom
