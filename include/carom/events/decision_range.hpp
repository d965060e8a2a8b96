// The scales at which flights are decided in doubles.
#pragma once

#include <span>
#include <string>

#include "carom/motion/state.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// A table's lengths, and whether the bounds on rounding hold for a particle in it, as they know no
/// underflow and no overflow. docs/physics/exactness.md, The range, derives the limits.
class DecisionRange {
 public:
  explicit DecisionRange(const Table&);
  /// Why they do not hold; "" if they do.
  std::string fault(const Particle&) const;

 private:
  void reach(geometry::Vector x);
  double shortest_, largest_ = 0.0;  ///< wall, radius, semi-axis or edge of a cell; coordinate
  bool ellipses_ = false;
};

/// The first fault of these particles in that table and its regions, or "".
std::string beyond_decisions(const Table&, std::span<const Particle>);

}  // namespace carom
