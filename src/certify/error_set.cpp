#include "certify/error_set.hpp"

namespace carom::certify {
namespace {

Bound size_of(const Interval& x) {
  const double size = x.size();
  return std::isfinite(size) ? Bound(size) : Bound(HUGE_VAL);
}

}  // namespace

void ErrorSet::move(const Jacobian& J, const std::array<Interval, 4>& times) {
  for (std::size_t j = 0; j < 4; ++j) time_ = time_ + size_of(times[j]) * size_[j];
  Bound fresh[4];  // what arrives besides the images of the two directions of the frame
  for (std::size_t i = 0; i < 4; ++i) {
    fresh[i] = size_of(J[i][off]) * size_[off] + size_of(J[i][speed]) * size_[speed];
    if (i == off || i == speed)
      fresh[i] = fresh[i] + size_of(J[i][along]) * size_[along] + size_of(J[i][turning]) * size_[turning];
  }
  size_[off] = fresh[off];
  size_[speed] = fresh[speed];
  Interval image[2][2];
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      image[i][j] = J[static_cast<std::size_t>(i)][0] * Interval(frame_[0][j]) +
                    J[static_cast<std::size_t>(i)][1] * Interval(frame_[1][j]);
  // The first one becomes the first axis of the new frame, which is (almost) a rotation; the second where it is
  // much longer. (Were it always the longer one, the axes of a stable orbit would change places again and again,
  // and each change wraps the set: 0.3 bits a hit in an ellipse instead of none.)
  Bound length[2];
  for (int j = 0; j < 2; ++j) length[j] = (size_of(image[0][j]) + size_of(image[1][j])) * extent_[j];
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
  const Interval inverse[2][2] = {{Interval(c) / determinant, Interval(s) / determinant},
                                  {-(Interval(s) / determinant), Interval(c) / determinant}};
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

void ErrorSet::round(const Bound& size, const Bound& of_time) {
  // A change by (a, b) is one by at most |a| + |b| along each axis of an almost orthogonal frame.
  for (Bound& extent : extent_) extent = extent + Bound(2.01) * size;
  size_[off] = size_[off] + size;
  size_[speed] = size_[speed] + size;
  time_ = time_ + of_time;
  update_sizes();
}

void ErrorSet::update_sizes() {
  for (std::size_t i = 0; i < 2; ++i)
    size_[i] = Bound(frame_[i][0]) * extent_[0] + Bound(frame_[i][1]) * extent_[1];
}

}  // namespace carom::certify
