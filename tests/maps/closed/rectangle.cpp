#include <cmath>

#include "maps/closed/maps.hpp"

namespace carom::maps {
namespace {

// One coordinate between mirrors at 0 and `length`: the image of the straight motion x + v t.
template <class Real>
void fold(Real length, Real time, Real& x, Real& v) {
  Real image = std::fmod(x + v * time, 2 * length);
  if (image < 0) image += 2 * length;
  const bool mirrored = image > length;
  x = mirrored ? 2 * length - image : image;
  v = mirrored ? -v : v;
}

// Time of the n-th crossing (n = 0, 1, 2, ...) of a mirror's image.
template <class Real>
Real crossing(Real length, Real x, Real v, std::uint64_t n) {
  const Real distance = v > 0 ? length - x : x;
  return (distance + static_cast<Real>(n) * length) / std::abs(v);
}

}  // namespace

template <class Real>
Phase<Real> Rectangle<Real>::at(const Phase<Real>& start, Real time) const {
  Phase<Real> phase = start;
  fold(width_, time, phase.x, phase.vx);
  fold(height_, time, phase.y, phase.vy);
  return phase;
}

template <class Real>
std::vector<SideHit<Real>> Rectangle<Real>::hits(const Phase<Real>& start,
                                                 std::uint64_t count) const {
  std::vector<SideHit<Real>> list;
  list.reserve(count);
  std::uint64_t vertical = 0, horizontal = 0;  // sides met so far, by direction
  while (list.size() < count) {
    const bool x_moves = start.vx != 0, y_moves = start.vy != 0;
    if (!x_moves && !y_moves) break;
    const Real x_time = x_moves ? crossing(width_, start.x, start.vx, vertical) : 0;
    const Real y_time = y_moves ? crossing(height_, start.y, start.vy, horizontal) : 0;
    const bool takes_x = x_moves && (!y_moves || x_time <= y_time);
    // The sides alternate, so the one met follows from the count alone, and so do the signs of the
    // velocity; only the other coordinate needs the folding.
    SideHit<Real> hit{};
    if (takes_x) {
      const bool right = (start.vx > 0) == (vertical % 2 == 0);
      ++vertical;
      hit = {right ? Side::right : Side::left, x_time, at(start, x_time)};
      hit.phase.x = right ? width_ : 0;
    } else {
      const bool top = (start.vy > 0) == (horizontal % 2 == 0);
      ++horizontal;
      hit = {top ? Side::top : Side::bottom, y_time, at(start, y_time)};
      hit.phase.y = top ? height_ : 0;
    }
    hit.phase.vx = vertical % 2 == 0 ? start.vx : -start.vx;
    hit.phase.vy = horizontal % 2 == 0 ? start.vy : -start.vy;
    list.push_back(hit);
  }
  return list;
}

template class Rectangle<double>;
template class Rectangle<long double>;

}  // namespace carom::maps
