// How long a step may be where forces act, known before it is taken: docs/physics/resolution.md.
//
// Where the force is bounded by F over all complex displacements of size rho from a place, the motion that starts there
// with speed v is analytic for complex times |t| <= T, if v T + F T^2/(2 m) <= rho (times exp(omega T) in a field).
// What a scheme's few stages see of such a motion is all there is to it; a narrower force would make T shorter.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "carom/forces/force_field.hpp"
#include "forces/force_bound.hpp"

namespace carom {

namespace resolution {

/// A step is resolved if the motion is analytic for complex times up to half of it about both of its ends.
inline constexpr double steps_a_radius = 2.0;
/// Where pieces of a force meet, a step may change the velocity by this share of itself through the difference.
inline constexpr double kick_share = 0.25;

/// What a magnetic field multiplies displacements with.
double growth(double omega, double time);
/// Does the motion stay within rho?
inline bool stays(double speed, double acceleration, double time, double growth, double rho) {
  return growth * time * (speed + 0.5 * acceleration * time) <= rho;
}

}  // namespace resolution

/// Bounds of the external force on one kind of particle, on a grid for each power of two, computed where they are
/// asked for. The answers depend on the arguments alone.
class ForceMap {
 public:
  /// Refers to `forces`.
  ForceMap(const ForceField& forces, const Particle& kind) : forces_(forces), kind_(kind) {}
  const Particle& kind() const { return kind_; }

  /// Is the motion from x analytic for complex times up to `time`? `way`: about as far as it leads, a hint.
  bool resolves(geometry::Vector x, double speed, double way, double time);
  /// Bounds of the acceleration within displacements of rho or a little more, a power of two.
  ForceBound about(geometry::Vector x, double rho);

 private:
  struct Entry {
    std::uint64_t key = 0;  ///< 0: empty
    ForceBound bound;
  };
  ForceBound compute(int exponent, double i, double j) const;
  ForceBound at(geometry::Vector x, int exponent);
  void grow();

  const ForceField& forces_;
  Particle kind_;
  std::vector<Entry> entries_;  ///< a power of two of them, at most half of which are in use
  std::size_t used_ = 0;
};

/// One map a kind of particle.
class ForceMaps {
 public:
  explicit ForceMaps(const ForceField& forces) : forces_(forces) {}
  ForceMap& of(const Particle& kind);

 private:
  const ForceField& forces_;
  std::vector<std::unique_ptr<ForceMap>> maps_;
};

}  // namespace carom
