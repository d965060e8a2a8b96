// A small set of errors in a plane, carried by tangent maps in a frame that turns along (Lohner's
// QR form), so that it grows as fast as neighbouring orbits part, and no faster.
#pragma once

#include "certify/number/ball.hpp"
#include "certify/number/interval.hpp"

namespace carom::certify {

class TurningBox {
 public:
  /// The errors (x, y) become J (x, y), enclosed over the whole set, and something of at most
  /// `fresh` is added.
  void move(const Interval (&J)[2][2], const Bound (&fresh)[2]);
  /// Both are changed by at most `size`.
  void round(const Bound& size);
  /// Largest error in x or y.
  const Bound& size(std::size_t i) const { return size_[i]; }

 private:
  void update_sizes();
  double frame_[2][2] = {{1, 0}, {0, 1}};  ///< its columns are the directions of the box
  Bound extent_[2];                        ///< of the set along them
  Bound size_[2];
};

}  // namespace carom::certify
