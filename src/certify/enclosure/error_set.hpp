// Error bounds of a state: how far the true point and velocity may be from those that are computed
// with many bits.
#pragma once

#include <array>

#include "certify/enclosure/turning_box.hpp"

namespace carom::certify {

/// Errors of a state by direction: of the position along the wall it lies on, of the direction of
/// the velocity, and the two that the motion keeps small: of the position off the wall, and of the
/// speed. Positions in units of a length of the table, velocities in units of the speed.
enum Direction : std::size_t { along = 0, turning = 1, off = 2, speed = 3 };

/// A tangent map in these coordinates: Jacobian[i][j] says what of error j arrives in i.
using Jacobian = std::array<std::array<Interval, 4>, 4>;

class ErrorSet {
 public:
  /// The state moves by a map with that Jacobian, enclosed over the whole set; `times`: what of
  /// error j arrives in the flight time.
  void move(const Jacobian& jacobian, const std::array<Interval, 4>& times);
  /// Every coordinate of the state is changed by at most `size`, and the time by `of_time`.
  void round(const Bound& size, const Bound& of_time);

  /// An invariant says that the error in this direction (off or speed) is at most `size`.
  void constrain(Direction d, const Bound& size) {
    Bound& error = d == off ? off_ : speed_;
    if (size < error) error = size;
  }

  /// Largest error in a direction.
  const Bound& size(Direction d) const {
    return d == off ? off_ : d == speed ? speed_ : box_.size(d);
  }
  Bound of_position() const { return size(along) + off_; }
  Bound of_velocity() const { return size(turning) + speed_; }
  const Bound& of_time() const { return time_; }

 private:
  TurningBox box_;  ///< along, turning
  Bound off_, speed_;
  Bound time_;
};

}  // namespace carom::certify
