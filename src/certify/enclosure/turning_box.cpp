#include "certify/enclosure/turning_box.hpp"

#include "certify/enclosure/state_enclosure.hpp"

namespace carom::certify {

void TurningBox::move(const Interval (&J)[2][2], const Bound (&fresh)[2]) {
  Interval image[2][2];
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      image[i][j] = J[i][0] * Interval(frame_[0][j]) + J[i][1] * Interval(frame_[1][j]);
  // The first one becomes the first axis of the new frame, which is (almost) a rotation; the second
  // where it is much longer. (Were it always the longer one, the axes of a stable orbit would
  // change places again and again, and each change wraps the set: 0.3 bits a hit in an ellipse
  // instead of none.)
  Bound length[2];
  for (int j = 0; j < 2; ++j)
    length[j] = (size_of(image[0][j]) + size_of(image[1][j])) * extent_[j];
  const int longer = length[0] * Bound(64.0) < length[1] ? 1 : 0;
  double c = image[0][longer].middle(), s = image[1][longer].middle();
  const double norm = std::sqrt(c * c + s * s);
  if (norm > 0.0 && std::isfinite(norm)) {
    c /= norm;
    s /= norm;
  } else {
    c = 1.0;
    s = 0.0;
  }
  // Its inverse is the transposed matrix over the determinant.
  const Interval determinant = square(Interval(c)) + square(Interval(s));
  const Interval cosine = Interval(c) / determinant, sine = Interval(s) / determinant;
  const Interval inverse[2][2] = {{cosine, sine}, {-sine, cosine}};
  Bound next[2];
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const Interval entry = inverse[i][0] * image[0][j] + inverse[i][1] * image[1][j];
      next[i] = next[i] + size_of(entry) * extent_[j] + size_of(inverse[i][j]) * fresh[j];
    }
  }
  for (int i = 0; i < 2; ++i) extent_[i] = next[i];
  frame_[0][0] = c;
  frame_[0][1] = -s;
  frame_[1][0] = s;
  frame_[1][1] = c;
  update_sizes();
}

void TurningBox::round(const Bound& size) {
  // A change by (a, b) is one by at most |a| + |b| along each axis of an almost orthogonal frame.
  for (Bound& extent : extent_) extent = extent + Bound(2.01) * size;
  update_sizes();
}

void TurningBox::update_sizes() {
  for (std::size_t i = 0; i < 2; ++i)
    size_[i] = Bound(frame_[i][0]) * extent_[0] + Bound(frame_[i][1]) * extent_[1];
}

}  // namespace carom::certify
