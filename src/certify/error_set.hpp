// What is not known of a state: how far the true state may be from the one that is computed with many
// bits. Carried by the tangent map in a frame of two directions that turns along (Lohner's QR form), so
// that it grows as fast as neighbouring orbits part, and no faster.
#pragma once

#include <array>

#include "certify/ball.hpp"
#include "certify/interval.hpp"
#include "certify/wall.hpp"

namespace carom::certify {

/// Errors of a state by direction: of the position along the wall it lies on, of the direction of the
/// velocity, and the two that the motion keeps small: of the position off the wall, and of the speed.
/// Positions in units of a length of the table, velocities in units of the speed.
enum Direction : std::size_t { along = 0, turning = 1, off = 2, speed = 3 };

/// A tangent map in these coordinates: Jacobian[i][j] says what of error j arrives in i.
using Jacobian = std::array<std::array<Interval, 4>, 4>;

class ErrorSet {
 public:
  /// The state moves by a map with that Jacobian, enclosed over the whole set; `times`: what of error j
  /// arrives in the flight time.
  void move(const Jacobian& jacobian, const std::array<Interval, 4>& times);
  /// Every coordinate of the state is changed by at most `size`, and the time by `of_time`.
  void round(const Bound& size, const Bound& of_time);

  /// An invariant says that the error in this direction (off or speed) is at most `size`.
  void constrain(Direction d, const Bound& size) {
    if (size < size_[d]) size_[d] = size;
  }

  /// Largest error in a direction.
  const Bound& size(Direction d) const { return size_[d]; }
  Bound of_position() const { return size_[along] + size_[off]; }
  Bound of_velocity() const { return size_[turning] + size_[speed]; }
  const Bound& of_time() const { return time_; }

 private:
  void update_sizes();
  double frame_[2][2] = {{1, 0}, {0, 1}};  ///< columns: directions in the plane of (along, turning)
  Bound extent_[2];                        ///< of the set along them
  Bound size_[4];
  Bound time_;
};

}  // namespace carom::certify
