// How a group of particles is moved where forces act: one step of a numerical scheme.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "carom/geometry/vector.hpp"

namespace carom {

/// Positions and velocities of a group of particles, over any arithmetic.
template <class Real>
struct Phase {
  std::vector<geometry::BasicVector<Real>> position, velocity;
};

/// The acceleration of each particle of a group (force / mass), without the magnetic part. Adaptive
/// schemes ask for more: the energy and the longest step that the forces allow.
template <class Real>
class ForceLaw {
 public:
  virtual ~ForceLaw() = default;
  /// Sets every entry of `acceleration`. Both spans have one entry a particle.
  virtual void accelerations(std::span<const geometry::BasicVector<Real>> position,
                             std::span<geometry::BasicVector<Real>> acceleration) const = 0;

  /// The masses where the exact motion keeps sum m v^2/2 + potential_energy(); empty where it keeps
  /// no energy, or none that is known.
  virtual std::span<const Real> masses() const { return {}; }
  /// The potential energy of the group. Its gradient is minus the forces.
  virtual Real potential_energy(std::span<const geometry::BasicVector<Real>> /*position*/) const {
    return Real(0);
  }
  /// By how much potential_energy() may jump where tails are cut off.
  virtual Real energy_jumps() const { return Real(0); }

  /// The longest step from there, of at most `asked` > 0, in which a scheme cannot miss a force; 0
  /// where there is none. A function of its arguments alone.
  virtual Real longest_step(const Phase<Real>& /*from*/, const Real& asked) const { return asked; }
};

/// One step of a scheme. The path of a group is a function of its start alone: step(from, t) for
/// 0 <= t <= h is the scheme's own continuous path, and a step that is cut short at a wall repeats
/// it.
template <class Real>
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Moves `from` by a time of at most `at_most` > 0 into `to` (never the same object) and returns
  /// the time it moved: `at_most` itself for fixed schemes; less where an adaptive one needs a
  /// smaller step.
  virtual Real step(const Phase<Real>& from, Real at_most, Phase<Real>& to) = 0;
  /// The accelerations at positions that the next step begins with, which need not be evaluated
  /// again then; nothing if the scheme does not begin with them.
  virtual std::span<const geometry::BasicVector<Real>> at_start(
      std::span<const geometry::BasicVector<Real>> /*position*/) {
    return {};
  }
  /// Those at these positions if it remembers them, or nothing.
  virtual std::span<const geometry::BasicVector<Real>> remembered(
      std::span<const geometry::BasicVector<Real>> /*position*/) const {
    return {};
  }
  /// Forgets the forces that it remembers, which changes nothing but the cost.
  virtual void forget() {}
  /// Why the last step could not be taken ("": it could). Its phase is then no number.
  virtual std::string_view failure() const { return {}; }
};

}  // namespace carom
